"""How deep, how long, and how often right through: against speed, frame time and thickness."""

import matplotlib.pyplot as plt

import style
from data import pick, points, unique


def draw(data, figures):
    for sweep in data.sweeps():
        draw_sweep(data, figures, sweep)


def draw_sweep(data, figures, sweep):
    rows = data.table(sweep, "summary")
    x = data.axes(sweep)[0]
    methods = unique(row["method"] for row in rows)
    figure, (through, depth, time) = plt.subplots(1, 3, figsize=(10.6, 3.4))
    for method in methods:
        look = style.look(method, methods)
        of_method = pick(rows, method=method)
        through.plot(*points(of_method, x, "tunnelled.mean"), **look)
        for panel, metric in ((depth, "max_penetration"), (time, "overlap_time")):
            panel.plot(*points(of_method, x, f"{metric}.median"), **look)
            low = points(of_method, x, f"{metric}.q1")
            high = points(of_method, x, f"{metric}.q3")
            panel.fill_between(low[0], low[1], high[1], color=look["color"], alpha=0.15,
                               linewidth=0)
    predicted = pick(rows, method=methods[0])
    through.plot(*points(predicted, x, "predicted.mean"), **style.PREDICTION,
                 label="predicted: max(0, 1 − (w+2r)/(v h))")
    for panel, title, label in ((through, "Went through", "fraction of runs that tunnelled"),
                                (depth, "How deep", "deepest penetration / m"),
                                (time, "How long", "time spent overlapping / s")):
        panel.set_title(title)
        panel.set_xscale(data.column(sweep, x)["scale"])
        panel.set_xlabel(data.label(sweep, x))
        panel.set_ylabel(label)
        panel.set_ylim(bottom=0)
    through.set_ylim(-0.03, 1.03)
    style.legend_below(figure, [through], columns=4)
    figures.save(figure, sweep, data.entry(f"caption:{sweep}"))
