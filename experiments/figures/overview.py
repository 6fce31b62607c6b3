"""The thesis' scheme beside its cures, one scene a column: penetration, through, energy error. Marks,
not bars: a bar on a logarithmic axis has a length that means nothing."""

import matplotlib.pyplot as plt

import style
from data import pick, unique

NOTHING = 0.0042   # where a zero stands on a logarithmic axis
ROUNDOFF = 1e-12   # relative: energy errors below are roundoff


def draw(data, figures):
    sweeps = data.sweeps()
    figure, panels = plt.subplots(2, len(sweeps), figsize=(11.2, 4.4), squeeze=False, sharey=True)
    for (above, below), sweep in zip(panels.T, sweeps):
        rows = data.table(sweep, "summary")
        magnitudes(above, rows, "max_penetration.max", "0")
        above.set_title(sweep)
        above.set_xlabel("deepest drawn overlap / m")
        if any(row["passed.mean"] for row in rows):
            fractions(below, rows)
            below.set_xlabel("fraction that went through")
        else:
            magnitudes(below, rows, "energy_error.max", "~ 0")
            below.set_xlabel("energy error, relative")
    figures.save(figure, "overview", "The thesis' own stepping and its cures on four scenes: the worst "
                 "of all repeats, and the fraction that went through; of the ball that bounces, the "
                 "error of energy (of the others it is roundoff). Exactly, all are zero; what is zero "
                 "stands at the left end of its axis. Where balls went through and no overlap was "
                 "drawn, no frame shows it.")


def rows_of(panel, rows, metric):
    methods = unique(row["method"] for row in rows)
    panel.set_yticks(range(len(methods)), methods)
    panel.set_ylim(len(methods) - 0.5, -0.5)
    panel.grid(axis="y", visible=False)
    return [(i, pick(rows, method=method)[0][metric], style.look(method, methods) |
             {"linestyle": "none", "markersize": 6}) for i, method in enumerate(methods)]


def magnitudes(panel, rows, metric, zero):
    """A logarithmic axis from 0.01 to 1, left of which stands what is nothing."""
    panel.set_xscale("log")
    panel.set_xlim(3e-3, 1.0)
    panel.set_xticks([NOTHING, 0.01, 0.1, 1.0], [zero, "0.01", "0.1", "1"])
    panel.minorticks_off()
    for i, value, look in rows_of(panel, rows, metric):
        none = value is None or abs(value) < ROUNDOFF
        x = NOTHING if none else max(abs(value), 0.01)
        panel.plot([x], [i], **look)
        panel.annotate("" if none else f"{value:.2g}", (x, i), textcoords="offset points",
                       xytext=(6, 0), va="center", fontsize=8)


def fractions(panel, rows):
    panel.set_xlim(-0.06, 1.06)
    for i, value, look in rows_of(panel, rows, "passed.mean"):
        panel.plot([0, value], [i, i], color=look["color"], linewidth=3, alpha=0.5,
                   solid_capstyle="butt")
        panel.plot([value], [i], **look)
        panel.annotate(f"{value:.2g}" if value else "", (value, i), textcoords="offset points",
                       xytext=(7 if value < 0.8 else -7, 0), va="center", fontsize=8,
                       ha="left" if value < 0.8 else "right",
                       bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6} if value else None)
