"""The thesis' scheme beside its cures, one scene each: penetration and energy error."""

import matplotlib.pyplot as plt

import style
from data import pick, unique


def draw(data, figures):
    sweeps = data.sweeps()
    figure, panels = plt.subplots(2, len(sweeps), figsize=(10.4, 4.6), squeeze=False)
    for column, sweep in enumerate(sweeps):
        rows = data.table(sweep, "runs")
        methods = unique(row["method"] for row in rows)
        for panel, metric, floor in ((panels[0][column], "max_penetration", 1e-9),
                                     (panels[1][column], "energy_error", 1e-16)):
            for i, method in enumerate(methods):
                value = pick(rows, method=method)[0][metric]
                if value is None:
                    continue
                look = style.look(method, methods)
                panel.barh(i, max(abs(value), floor), left=0, height=0.62, color=look["color"],
                           alpha=0.85)
                panel.annotate(f"{value:.2g}" if value else "0", (max(abs(value), floor), i),
                               textcoords="offset points", xytext=(3, 0), va="center", fontsize=8)
            panel.set_yticks(range(len(methods)), methods if column == 0 else [""] * len(methods))
            panel.set_xscale("log")
            panel.set_xlim(floor / 2, max(panel.get_xlim()[1] * 30, 1.0))
            panel.invert_yaxis()
            panel.grid(axis="y", visible=False)
        panels[0][column].set_title(sweep)
        panels[0][column].set_xlabel("deepest penetration / m")
        panels[1][column].set_xlabel("|energy error|, relative")
    figures.save(figure, "overview", "The thesis' own stepping and its cures on three scenes. Bars "
                 "at the left edge are zero or below the scale; the numbers are exact.")
