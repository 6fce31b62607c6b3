"""The thesis' scheme beside its cures, one scene each: penetration and energy error."""

import matplotlib.pyplot as plt

import style
from data import pick, unique


def draw(data, figures):
    sweeps = data.sweeps()
    figure, panels = plt.subplots(3, len(sweeps), figsize=(10.4, 6.2), squeeze=False)
    for column, sweep in enumerate(sweeps):
        rows = data.table(sweep, "summary")
        for panel, name, scale, floor in (
                (panels[0][column], "max_penetration.max", "log", 1e-6),
                (panels[1][column], "passed.mean", "linear", 0.0),
                (panels[2][column], "energy_error.max", "log", 1e-16)):
            bars(panel, rows, name, scale, floor, column == 0)
        panels[0][column].set_title(sweep)
        panels[0][column].set_xlabel("deepest penetration / m")
        panels[1][column].set_xlabel("fraction that went through")
        panels[2][column].set_xlabel("energy error, relative")
    figures.save(figure, "overview", "The thesis' own stepping and its cures on three scenes: the worst "
                 "of all repeats, and the fraction that went through. Exactly, all are zero; a bar "
                 "that is missing is zero or below the scale.")


def bars(panel, rows, name, scale, floor, labelled):
    methods = unique(row["method"] for row in rows)
    for i, method in enumerate(methods):
        value = pick(rows, method=method)[0][name]
        if value is None:
            continue
        look = style.look(method, methods)
        shown = max(abs(value), floor)
        panel.barh(i, shown, height=0.62, color=look["color"], edgecolor="white", linewidth=0)
        panel.annotate(f"{value:.2g}" if value else "0", (shown, i), textcoords="offset points",
                       xytext=(3, 0), va="center", fontsize=8)
    panel.set_yticks(range(len(methods)), methods if labelled else [""] * len(methods))
    if scale == "log":
        panel.set_xscale("log")
        panel.set_xlim(floor, 30.0)
    else:
        panel.set_xlim(0.0, 1.18)
    panel.invert_yaxis()
    panel.grid(axis="y", visible=False)
