"""Any sweep: one panel per metric against an axis, a line per method, medians with quartiles."""

import matplotlib.pyplot as plt

import style
from data import points, unique


def draw(data, figures):
    for sweep in data.sweeps():
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
    others = [axis for axis in axes if axis != x]
    lines = unique((row["method"], *(row[axis] for axis in others)) for row in rows)
    columns = min(3, len(metrics))
    lines_of_panels = -(-len(metrics) // columns)
    figure, panels = plt.subplots(lines_of_panels, columns, squeeze=False,
                                  figsize=(1.0 + 3.4 * columns, 0.8 + 2.7 * lines_of_panels))
    panels = list(panels.flat)
    for panel, metric in zip(panels, metrics):
        for i, line in enumerate(lines):
            of_line = [row for row in rows
                       if (row["method"], *(row[axis] for axis in others)) == line]
            name = ", ".join([str(line[0])] + [f"{axis} {value:g}" if isinstance(value, float)
                                               else f"{axis} {value}"
                                               for axis, value in zip(others, line[1:])])
            properties = style.look(name, [name if j == i else j for j in range(len(lines))])
            panel.plot(*points(of_line, x, f"{metric}.median"), **properties)
            low = points(of_line, x, f"{metric}.q1")
            high = points(of_line, x, f"{metric}.q3")
            panel.fill_between(low[0], low[1], high[1], color=properties["color"], alpha=0.15,
                               linewidth=0)
        panel.set_xscale(data.column(sweep, x)["scale"])
        panel.set_xlabel(data.label(sweep, x))
        panel.set_ylabel(data.label(sweep, metric))
    for panel in panels[len(metrics):]:
        panel.set_visible(False)
    style.legend_below(figure, panels[:1])
    figures.save(figure, sweep, data.entry(f"caption:{sweep}") or
                 "Medians over the repeats; shaded: from the lower to the upper quartile.")
