"""A bat swung at a resting ball: passes through, overlaps."""

import matplotlib.pyplot as plt

import style
from data import pick, points, unique


def draw(data, figures):
    rows = data.table("bat", "summary")
    methods = unique(row["method"] for row in rows)
    figure, (through, depth, time) = plt.subplots(1, 3, figsize=(10.6, 3.4))
    for method in methods:
        look = style.look(method, methods)
        of_method = pick(rows, method=method)
        through.plot(*points(of_method, "frequency", "passed.mean"), **look)
        for panel, metric in ((depth, "max_penetration"), (time, "overlap_time")):
            panel.plot(*points(of_method, "frequency", f"{metric}.median"), **look)
            low = points(of_method, "frequency", f"{metric}.q1")
            high = points(of_method, "frequency", f"{metric}.q3")
            panel.fill_between(low[0], low[1], high[1], color=look["color"], alpha=0.15,
                               linewidth=0)
    for panel, title, label in ((through, "Passed through the ball", "fraction of runs"),
                                (depth, "How deep", "deepest penetration / m"),
                                (time, "How long", "time spent overlapping / s")):
        panel.set_title(title)
        panel.set_xscale("log", base=2)
        panel.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
        panel.set_xlabel(data.label("bat", "frequency"))
        panel.set_ylabel(label)
        panel.set_ylim(bottom=0)
    through.set_ylim(-0.03, 1.03)
    style.legend_below(figure, [through], columns=4)
    figures.save(figure, "bat", data.entry("caption:bat"))
