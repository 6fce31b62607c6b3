"""Error against counted work and against measured time, a panel per kind of error; failures are
drawn as failures, above the frame."""

import math
import os

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

import methods
import style
from data import unique

PANELS = [("position_error", "front_position", "position at the end / m"),
          ("event_time_error", "front_event_time", "worst time of an impact / s"),
          ("penetration", "front_penetration", "deepest penetration / m"),
          ("energy_error", "front_energy", "largest energy error, relative")]
FLOOR = 1e-17  # an error of 0 is drawn here
ASTRAY = 1e3    # m, s: an error beyond is no answer


def draw(data, figures):
    times = data.rows("timings") if os.path.exists(os.path.join(data.folder, "timings.csv")) else []
    for reference in data.rows("references"):
        scene = str(reference["scene"])
        rows = data.rows(f"{scene}_methods")
        by_work(figures, scene, rows, reference)
        by_time(figures, scene, rows, [t for t in times if t["scene"] == scene])


def by_work(figures, scene, rows, reference):
    telling = [panel for panel in PANELS
               if any((row[panel[0]] or 0.0) > FLOOR for row in rows)]
    silent = [label.split(" / ")[0].split(",")[0] for error, _, label in PANELS
              if error not in [panel[0] for panel in telling]]
    across = 2 if len(telling) == 4 else len(telling)
    down = -(-len(telling) // across)
    figure, panels = plt.subplots(down, across, figsize=(0.8 + (4.4 if across < 3 else 3.4) * across,
                                                        0.8 + 2.9 * down),
                                  sharex=True, squeeze=False)
    for panel, (error, front, label) in zip(panels.flat, telling):
        scatter(panel, rows, "work", error)
        best = sorted((r["work"], max(r[error], FLOOR)) for r in rows if r[front] == 1)
        panel.step([w for w, _ in best], [e for _, e in best], where="post", color="black",
                   linewidth=0.9, linestyle=":")
        if error == "position_error" and reference["position_uncertainty"]:
            panel.axhline(reference["position_uncertainty"], color="#888888", linewidth=0.8)
        panel.set_title(label.split(" / ")[0].split(",")[0])
        panel.set_ylabel(label)
        label_zero(panel, [row[error] for row in rows])
    for panel in panels[-1]:
        panel.set_xlabel("counted work: right-hand sides, overlap\ntests, gap evaluations, contact solves")
    legend(figure, rows)
    figures.save(figure, f"{scene}-work", f"{scene}: {reference['compared']}. Reference: "
                 f"{reference['reference']}. Dotted: nothing cheaper is better. Marks on the upper "
                 "edge: refused, stopped, too long (crosses), an impact missed, or an error beyond the "
                 "axis." + (f" Zero for every method, and not drawn: {', '.join(silent)}." if silent
                            else ""))


def label_zero(panel, errors):
    """What is drawn at FLOOR is 0: the axis says so."""
    errors = [error for error in errors if error is not None]
    if not any(error <= FLOOR for error in errors):
        return
    panel.axhline(FLOOR, color="#888888", linewidth=0.8, linestyle=":")
    panel.set_ylim(bottom=FLOOR / 3)
    ticks = [tick for tick in panel.get_yticks() if 10 * FLOOR <= tick <= panel.get_ylim()[1]]
    panel.set_yticks([FLOOR] + ticks, ["0"] + [f"$10^{{{math.log10(t):.0f}}}$" for t in ticks])
    panel.minorticks_off()


def by_time(figures, scene, rows, times):
    if not times:
        return
    seconds = {t["method"]: t for t in times}
    timed = [dict(r, seconds=seconds[r["method"]]["seconds"], slowest=seconds[r["method"]]["slowest"])
             for r in rows if r["method"] in seconds]
    figure, panel = plt.subplots(figsize=(6.4, 3.9))
    scatter(panel, timed, "seconds", "position_error")
    for row in timed:
        if row["position_error"] is not None:
            panel.plot([row["seconds"], row["slowest"]], [max(row["position_error"], FLOOR)] * 2,
                       color="#999999", linewidth=0.7, zorder=1)
    panel.set_xlabel("least seconds of several rounds, in turn; the line ends at the slowest")
    panel.set_ylabel("position at the end / m")
    legend(figure, timed)
    figures.save(figure, f"timing-{scene}", f"{scene}: the same against measured time, which differs "
                 "from run to run.")


def look(row):
    """Colour of the scheme, mark of the integrator."""
    scheme = style.scheme_of(row["method"]) or row["scheme"]
    return style.look(f"{scheme}, {row['integrator']}") | {"linestyle": "none", "alpha": 0.9,
                                                           "label": None}


def legend(figure, rows):
    schemes = [name for name in methods.SCHEMES
               if any((style.scheme_of(r["method"]) or r["scheme"]) == name for r in rows)]
    handles = [Line2D([], [], color=style.look(name)["color"], linewidth=4, label=name)
               for name in schemes]
    handles += [Line2D([], [], color="black", marker=style.look(name)["marker"], linestyle="none",
                       markerfacecolor="white", label=name)
                for name in unique(r["integrator"] for r in rows)]
    style.legend_of(figure, handles, columns=5)


def scatter(panel, rows, x, error):
    panel.set_xscale("log")
    panel.set_yscale("log")
    edge = {"transform": panel.get_xaxis_transform(), "clip_on": False}
    for row in rows:
        if row["status"] != "completed":
            panel.plot([max(row[x] or 1, 1)], [0.985], "x", color="#BB3333", **edge)
        elif not row[x]:
            continue
        elif row[error] is None or row[error] > ASTRAY:  # no impact, no error of its time
            panel.plot([row[x]], [0.985], **look(row), **edge)
        else:
            panel.plot([row[x]], [max(row[error], FLOOR)], **look(row))
