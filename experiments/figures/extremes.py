"""The stability map: a row of panels per family of scenes, a column per method."""

import math

import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from data import pick, unique

VERDICTS = ["right", "degraded", "wrong but reported", "wrong in silence", "hung"]
SHADES = ["#f2f2f2", "#b9d3ee", "#e8c468", "#c23b4b", "#111111"]
SIGNS = ["", "~", "?", "x", "!"]


def draw(data, figures):
    rows = data.rows("map")
    for row in rows:
        row["y"] = 0.0 if row["y"] is None else row["y"]
    methods = unique(str(r["method"]) for r in rows)
    families = unique(str(r["family"]) for r in rows)
    wide = [f for f in families if len(unique(r["y"] for r in pick(rows, family=f))) > 1]
    grid(figures, rows, methods, wide, "map-two",
         "The stability map, axes two at a time: a row of panels per family, a column per method. "
         "The sign in a cell tells its verdict without colour.")
    lines(figures, rows, methods, [f for f in families if f not in wide])


def label(value):
    if value == 0:
        return "0"
    power = math.log10(abs(value))
    return f"$10^{{{round(power)}}}$" if abs(power - round(power)) < 1e-9 else f"{value:.3g}"


def grid(figures, rows, methods, families, name, caption):
    figure, panels = plt.subplots(len(families), len(methods), squeeze=False,
                                  figsize=(1.75 * len(methods), 1.75 * len(families) + 0.6))
    for line, family in zip(panels, families):
        for panel, method in zip(line, methods):
            heat(panel, pick(rows, family=family, method=method))
            if family == families[0]:
                panel.set_title(method.replace(", ", ",\n"), fontsize=8)
        some = pick(rows, family=family)[0]
        line[0].set_ylabel(some["y_name"], fontsize=7)
        line[0].set_xlabel(some["x_name"], fontsize=7)
        for panel in line[1:]:
            panel.set_yticklabels([])
    finish(figure, figures, name, caption)


def heat(panel, rows):
    xs = sorted(unique(r["x"] for r in rows))
    ys = sorted(unique(r["y"] for r in rows))
    image = [[math.nan] * len(xs) for _ in ys]
    for row in rows:
        code = VERDICTS.index(row["verdict"])
        i, j = ys.index(row["y"]), xs.index(row["x"])
        image[i][j] = code
        panel.text(j, i, SIGNS[code], ha="center", va="center", fontsize=6,
                   color="white" if code >= 3 else "black")
    panel.imshow(image, cmap=ListedColormap(SHADES), vmin=-0.5, vmax=4.5, origin="lower",
                 aspect="auto", interpolation="nearest")
    panel.grid(False)
    every = max(1, len(xs) // 4)
    panel.set_xticks(range(0, len(xs), every), [label(x) for x in xs[::every]], fontsize=6)
    panel.set_yticks(range(len(ys)), [label(y) for y in ys], fontsize=6)


def lines(figures, rows, methods, families):
    height = 0.17 * len(methods) + 0.75
    figure, panels = plt.subplots((len(families) + 1) // 2, 2, squeeze=False,
                                  figsize=(9.6, height * ((len(families) + 1) // 2) + 0.6))
    for panel, family in zip(panels.flat, families):
        of_family = pick(rows, family=family)
        for row in of_family:
            row["y"] = float(len(methods) - 1 - methods.index(row["method"]))
        heat(panel, of_family)
        panel.set_yticks(range(len(methods)), methods[::-1], fontsize=7)
        panel.set_title(family, fontsize=8)
        panel.set_xlabel(of_family[0]["x_name"], fontsize=7)
    for panel in list(panels.flat)[len(families):]:
        panel.axis("off")
    finish(figure, figures, "map-one", "The stability map, one axis at a time.")


def finish(figure, figures, name, caption):
    patches = [Patch(facecolor=shade, edgecolor="#666666",
                     label=f"{verdict} ({sign})" if sign else verdict)
               for shade, verdict, sign in zip(SHADES, VERDICTS, SIGNS)]
    figure.legend(handles=patches, loc="lower center", ncol=5, bbox_to_anchor=(0.5, -0.04))
    figures.save(figure, name, caption)
