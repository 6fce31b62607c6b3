"""What fig. 15 lets through: against the speed, and against speed and threshold."""

import matplotlib.pyplot as plt
from matplotlib.colors import LinearSegmentedColormap

import style
from data import pick, points, unique


def draw(data, figures):
    against_speed(data, figures)
    map_of_thresholds(data, figures)


def against_speed(data, figures):
    rows = data.table("speed", "summary")
    methods = unique(row["method"] for row in rows)
    figure, panel = plt.subplots(figsize=(9.6, 4.0))
    for method in methods:
        x, y = points(pick(rows, method=method), "speed", "tunnelled.mean")
        panel.plot(x, y, **style.look(method) | {"markevery": 20})
    x, y = points(pick(rows, method=methods[0]), "speed", "predicted.mean")
    panel.plot(x, y, **style.PREDICTION, label="predicted: (d − r)/(v h), n odd")
    panel.set_xlabel(data.label("speed", "speed"))
    panel.set_ylabel("fraction that went through")
    panel.set_xlim(1, 40)
    panel.set_ylim(-0.02, 1.02)
    style.legend_below(figure, [panel], columns=4)
    figures.save(figure, "substeps", data.entry("caption:speed"))


def map_of_thresholds(data, figures):
    rows = data.table("threshold", "summary")
    speeds = sorted(unique(row["speed"] for row in rows))
    thresholds = sorted(unique(row["threshold"] for row in rows))
    cells = {(row["speed"], row["threshold"]): row["tunnelled.mean"] for row in rows}
    image = [[cells[speed, threshold] for speed in speeds] for threshold in thresholds]
    figure, panel = plt.subplots(figsize=(9.6, 4.0))
    shades = LinearSegmentedColormap.from_list("shades", ["#ffffff", "#EE6677", "#222255"])
    drawn = panel.imshow(image, origin="lower", aspect="auto", cmap=shades, vmin=0, vmax=1,
                         extent=(*edges(speeds), *(100 * e for e in edges(thresholds))))
    panel.grid(False)
    panel.axhline(3.0, color="black", linewidth=0.9, linestyle=":")
    panel.axhline(6.0, color="#228833", linewidth=1.4, linestyle="--")
    panel.set_xlabel(data.label("threshold", "speed"))
    panel.set_ylabel("threshold / cm")
    figure.colorbar(drawn, label="fraction that went through", pad=0.01)
    figures.save(figure, "thresholds", data.entry("caption:threshold"))


def edges(values):
    """Of the cells around evenly spaced values."""
    half = 0.5 * (values[-1] - values[0]) / (len(values) - 1)
    return values[0] - half, values[-1] + half
