"""How often a reflection turns a body back inwards."""

import matplotlib.pyplot as plt

import style
from data import pick, points, unique


def draw(data, figures):
    figure, panels = plt.subplots(1, 2, figsize=(8.8, 3.6), sharey=False)
    for panel, sweep, x, label in (
            (panels[0], "jitter", "jitter", "predicted: E[max(0, 1 − (1+c) h₂/h₁)]"),
            (panels[1], "stalls", "stall", "predicted: p(1−p)(F−1)/(1−p+pF), F = 4")):
        rows = data.table(sweep, "summary")
        methods = unique(row["method"] for row in rows)
        for method in methods:
            look = style.look(method, methods)
            of_method = pick(rows, method=method)
            panel.plot(*points(of_method, x, "turned.mean"), **look)
        panel.plot(*points(pick(rows, method=methods[0]), x, "predicted.mean"),
                   **style.PREDICTION, label=label)
        panel.set_xlabel(data.label(sweep, x))
        panel.set_ylabel("fraction turned back inwards")
        panel.set_ylim(bottom=-0.01)
    panels[0].set_title("A frame time that varies by ±j")
    panels[1].set_title("Stalls of four frames")
    style.legend_below(figure, panels, columns=4)
    figures.save(figure, "jiggle", "Runs in which the first bounce was followed by a reflection of a "
                 "ball that was moving apart from the floor already, over stratified start heights. "
                 "Dotted: the predictions.")
