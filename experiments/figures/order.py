"""Error against step: one method located in three ways, then every integrator in each way."""

import math

import matplotlib.pyplot as plt

import style
from data import unique

ROUNDOFF = 1e-13  # below, slopes are noise


def draw(data, figures):
    three_ways(data, figures)
    all_integrators(data, figures)


def root_mean_square(rows):
    """(h, error) of one method, ascending in h, over steps of nearly the same length; without those
    at which a run failed."""
    result = []
    for n in sorted({row["n"] for row in rows}, reverse=True):
        alike = [row for row in rows if row["n"] == n]
        errors = [row["position_error"] for row in alike]
        if all(error is not None for error in errors):
            h = math.exp(sum(math.log(row["h"]) for row in alike) / len(alike))
            result.append((h, math.sqrt(sum(e * e for e in errors) / len(errors))))
    return result


def slope(line):
    """Of the least-squares line through what is small and above roundoff; else of the two finest."""
    kept = [(math.log(h), math.log(e)) for h, e in line if ROUNDOFF < e < 0.03]
    if len(kept) < 3:
        kept = [(math.log(h), math.log(e)) for h, e in line[:2] if e > ROUNDOFF]
    if len(kept) < 2:
        return None
    x = sum(p[0] for p in kept) / len(kept)
    y = sum(p[1] for p in kept) / len(kept)
    return (sum((p[0] - x) * (p[1] - y) for p in kept) /
            sum((p[0] - x) ** 2 for p in kept))


def three_ways(data, figures):
    rows = data.table("rk4", "runs")
    figure, panel = plt.subplots(figsize=(6.2, 4.6))
    methods = unique(row["method"] for row in rows)
    for method, order in zip(methods, (1, 2, 4)):
        line = root_mean_square([row for row in rows if row["method"] == method])
        found = slope(line)
        label = f"{method}: slope {found:.2f}" if found else method
        look = style.look(method, methods) | {"label": label}
        panel.plot([p[0] for p in line], [p[1] for p in line], **look)
        guide(panel, line, order)
    finish(panel)
    panel.legend(loc="lower right")
    figures.save(figure, "order_rk4", data.entry("caption:rk4"))


def guide(panel, line, order):
    """A dotted line of the expected slope, a little above."""
    if not line:
        return
    (h0, _), (h1, e1) = line[0], line[-1]
    panel.plot([h0, h1], [2.0 * e1 * (h0 / h1) ** order, 2.0 * e1], color="#999999", linewidth=0.9,
               linestyle=":")


def all_integrators(data, figures):
    ways = [("unlocated", "not located"), ("linear", "located linearly"),
            ("dense", "on the dense output")]
    tables = {sweep: data.table(sweep, "runs") for sweep, _ in ways}
    methods = unique(row["method"] for row in tables["dense"])
    lines = {sweep: {method: root_mean_square([r for r in rows if r["method"] == method])
                     for method in methods} for sweep, rows in tables.items()}
    slopes = {method: [slope(lines[sweep][method]) for sweep, _ in ways] for method in methods}
    figure, panels = plt.subplots(1, 3, figsize=(13.2, 5.6), sharex=True, sharey=True)
    for panel, (sweep, title) in zip(panels, ways):
        for method in methods:
            line = lines[sweep][method]
            panel.plot([p[0] for p in line], [p[1] for p in line], **style.look(method, methods) | {"linewidth": 1.2})
        finish(panel)
        panel.set_title(title)
    panels[0].set_ylim(1e-15, 1e2)
    for panel in panels[1:]:
        panel.set_ylabel("")
    names = [f"{method}: " + ", ".join(f"{x:.1f}" if x else "–" for x in slopes[method])
             for method in methods]
    panels[2].legend(panels[2].get_lines(), names, loc="center left", bbox_to_anchor=(1.02, 0.5),
                     fontsize=9.5, title="slopes: not located,\nlinearly, on the dense output")
    figures.save(figure, "order_all",
                 "The same for every integrator with a fixed step; a colour is an order of the "
                 "method. The legend tells the slopes of the three panels; a dash: below "
                 "roundoff.")


def finish(panel):
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_xlabel("step h / s")
    panel.set_ylabel("error of position, root mean square / m")
