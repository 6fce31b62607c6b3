"""Any sweep: one panel per metric against an axis, a line per method, medians with quartiles."""

import sys

import matplotlib.pyplot as plt

import style
from data import points, unique


YES_OR_NO = ("tunnelled", "passed", "turned", "out")  # 0 or 1 in a run: drawn as the fraction of runs


MOST_POINTS = 100_000  # of a sweep: more are no picture, and do not fit into memory as a table


def draw(data, figures):
    for sweep in data.sweeps():
        points_of = data.length(sweep, "summary")
        if points_of > MOST_POINTS:
            print(f"no figure of {sweep}: it would have {points_of} points; up to {MOST_POINTS} are "
                  "drawn", file=sys.stderr)
            continue
        draw_sweep(data, figures, sweep)


def draw_sweep(data, figures, sweep):
    axes = data.axes(sweep)
    x = data.entry(f"x:{sweep}") or (axes[0] if axes else None)
    metrics = [str(row["column"]) for row in data.columns
               if row["sweep"] == sweep and row["role"] in ("metric", "derived")]
    wanted = data.entry(f"y:{sweep}")
    metrics = [wanted] if wanted else metrics
    rows = data.table(sweep, "summary")
    if x is None or not rows or not all(isinstance(row[x], float) for row in rows):
        return
    still = {metric: unique(row[f"{metric}.mean"] for row in rows) for metric in metrics}
    constant = [metric for metric in metrics if len(still[metric]) == 1 and len(metrics) > 1]
    metrics = [metric for metric in metrics if metric not in constant] or metrics[:1]
    others = [axis for axis in axes if axis != x]
    lines = unique((row["method"], *(row[axis] for axis in others)) for row in rows)
    columns = min(3, len(metrics))
    lines_of_panels = -(-len(metrics) // columns)
    figure, panels = plt.subplots(lines_of_panels, columns, squeeze=False,
                                  figsize=(1.0 + 3.4 * columns, 0.8 + 2.7 * lines_of_panels))
    panels = list(panels.flat)
    names = [line_name(line, others) for line in lines]
    alone = len(lines) == len(unique(line[0] for line in lines))
    looks = [style.look(name, names) if alone else style.by_place(i, name)
             for i, name in enumerate(names)]
    for line, look in zip(lines, looks):
        look["marker"] = data.entry(f"mark:{sweep}:{line[0]}") or look["marker"]
    logarithmic = data.entry(f"log:{sweep}") is not None
    for panel, metric in zip(panels, metrics):
        for line, look in zip(lines, looks):
            of_line = [row for row in rows
                       if (row["method"], *(row[axis] for axis in others)) == line]
            draw_line(panel, of_line, x, metric, look)
        panel.set_xscale(data.column(sweep, x)["scale"])
        panel.set_xlabel(data.label(sweep, x))
        if logarithmic and metric not in YES_OR_NO and is_positive(rows, metric):
            panel.set_yscale("log")
        panel.set_ylabel(("fraction of runs: " if metric in YES_OR_NO else "") +
                         data.label(sweep, metric))
    for panel in panels[len(metrics):]:
        panel.set_visible(False)
    style.legend_below(figure, panels[:1])
    told = ", ".join(f"{metric} {still[metric][0]}" for metric in constant)
    figures.save(figure, sweep, (data.entry(f"caption:{sweep}") or
                 f"Against {x}: medians over the repeats; shaded: from the lower to the upper "
                 "quartile.") + (f" The same for all, and not drawn: {told}." if told else ""))


def is_positive(rows, metric):
    """Whether a metric has anything to show on a logarithmic scale."""
    return any((row[f"{metric}.median"] or 0) > 0 for row in rows)


def line_name(line, others):
    """The method, and where it stands on the other axes."""
    return ", ".join([str(line[0])] + [f"{axis} {value:g}" if isinstance(value, float)
                                       else f"{axis} {value}"
                                       for axis, value in zip(others, line[1:])])


def draw_line(panel, rows, x, metric, look):
    if metric in YES_OR_NO:
        panel.plot(*points(rows, x, f"{metric}.mean"), **look)
        return
    panel.plot(*points(rows, x, f"{metric}.median"), **look)
    low = points(rows, x, f"{metric}.q1")
    high = points(rows, x, f"{metric}.q3")
    panel.fill_between(low[0], low[1], high[1], color=look["color"], alpha=0.15, linewidth=0)
