"""How well joints hold over time, and the energy of a bar on a hinge against the step."""

import math

import matplotlib.pyplot as plt

import style
from data import pick, points, unique

MECHANISMS = (("bar", "A bar on a hinge"), ("balls", "Two balls on rods"),
              ("crank", "Crank, rod and piston"))
PROMISED = 1e-12  # of the size
ROUNDOFF = 1e-11  # J; below, slopes are noise


def draw(data, figures):
    drift(data, figures)
    energy(data, figures)


def drift(data, figures):
    figure, panels = plt.subplots(1, len(MECHANISMS), figsize=(11.0, 3.8), sharey=True)
    for panel, (sweep, title) in zip(panels, MECHANISMS):
        rows = data.table(sweep, "runs")
        methods = unique(row["method"] for row in rows)
        for method in methods:
            panel.plot(*points(pick(rows, method=method), "time", "joint_drift"),
                       **style.look(method, methods))
        panel.axhline(PROMISED, **style.PREDICTION)
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_ylim(1e-17, 1e-11)
        panel.set_xlabel(data.label(sweep, "time"))
        panel.set_title(title)
    panels[0].set_ylabel("largest residual so far / size")
    style.legend_below(figure, panels[:1])
    figures.save(figure, "joints_drift", data.entry("caption:bar"))


def energy(data, figures):
    rows = [row for row in data.table("energy", "runs") if row["status"] == "completed"]
    methods = unique(row["method"] for row in rows)
    figure, panel = plt.subplots(figsize=(7.4, 4.6))
    for method in methods:
        steps, errors = points(pick(rows, method=method), "h", "error")
        found = slope(steps, errors)
        label = f"{method}: slope {found:.1f}" if found else method
        panel.plot(steps, errors, **style.look(method, methods) | {"label": label})
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_xlabel(data.label("energy", "h"))
    panel.set_ylabel("|energy after 2 s − at the start| / J")
    panel.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    figures.save(figure, "joints_energy", data.entry("caption:energy"))


def slope(steps, errors):
    """Between the two finest steps whose error is above roundoff."""
    kept = [(h, abs(e)) for h, e in sorted(zip(steps, errors)) if abs(e) > ROUNDOFF]
    if len(kept) < 2:
        return None
    (h0, e0), (h1, e1) = kept[:2]
    return math.log(e1 / e0) / math.log(h1 / h0)
