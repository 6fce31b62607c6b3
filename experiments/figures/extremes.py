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
    if value != 0 and not 0.01 <= abs(value) <= 1000:
        power = math.floor(math.log10(abs(value)) + 1e-9)
        times = f"{value / 10.0 ** power:.3g}"
        return f"$10^{{{power}}}$" if times == "1" else f"${times}\\cdot10^{{{power}}}$"
    return f"{value:g}" if float(f"{value:g}") == value else f"<{value:g}"


def grid(figures, rows, methods, families, name, caption):
    figure = plt.figure(figsize=(1.4 * len(methods), 1.75 * len(families) + 0.6))
    for part, family in zip(figure.subfigures(len(families), 1), families):
        some = pick(rows, family=family)[0]
        part.suptitle(f"{family}: across {some['x_name']}, up {some['y_name']}", x=0.01,
                      ha="left", fontsize=10, fontweight="bold")
        line = part.subplots(1, len(methods))
        for panel, method in zip(line, methods):
            heat(panel, pick(rows, family=family, method=method), most=3)
            panel.set_title(method.replace(", ", ",\n"), fontsize=8.5, fontweight="normal")
        for panel in line[1:]:
            panel.set_yticklabels([])
    finish(figure, figures, name, caption, below=-0.03)


def heat(panel, rows, most=7):
    """Cells, with at most so many labels an axis."""
    xs = sorted(unique(r["x"] for r in rows))
    ys = sorted(unique(r["y"] for r in rows))
    image = [[math.nan] * len(xs) for _ in ys]
    for row in rows:
        code = VERDICTS.index(row["verdict"])
        i, j = ys.index(row["y"]), xs.index(row["x"])
        image[i][j] = code
        panel.text(j, i, SIGNS[code], ha="center", va="center", fontsize=7 if len(xs) < 12 else 5,
                   color="white" if code >= 3 else "black")
    panel.imshow(image, cmap=ListedColormap(SHADES), vmin=-0.5, vmax=4.5, origin="lower",
                 aspect="auto", interpolation="nearest")
    panel.grid(False)
    across, up = -(-len(xs) // most), -(-len(ys) // 5)
    panel.set_xticks(range(0, len(xs), across), [label(x) for x in xs[::across]], fontsize=8)
    panel.set_yticks(range(0, len(ys), up), [label(y) for y in ys[::up]], fontsize=8)


def lines(figures, rows, methods, families):
    height = 0.17 * len(methods) + 0.75
    figure, panels = plt.subplots((len(families) + 1) // 2, 2, squeeze=False,
                                  figsize=(9.6, height * ((len(families) + 1) // 2) + 0.6))
    for panel, family in zip(panels.flat, families):
        of_family = pick(rows, family=family)
        for row in of_family:
            row["y"] = float(len(methods) - 1 - methods.index(row["method"]))
        heat(panel, of_family)
        panel.set_yticks(range(len(methods)), methods[::-1], fontsize=8)
        panel.set_title(family, fontsize=10)
        panel.set_xlabel(of_family[0]["x_name"], fontsize=8.5)
    for panel in list(panels.flat)[len(families):]:
        panel.axis("off")
    finish(figure, figures, "map-one", "The stability map, one axis at a time.")


def finish(figure, figures, name, caption, below=-0.04):
    patches = [Patch(facecolor=shade, edgecolor="#666666",
                     label=f"{verdict} ({sign})" if sign else verdict)
               for shade, verdict, sign in zip(SHADES, VERDICTS, SIGNS)]
    figure.legend(handles=patches, loc="lower center", ncol=5, bbox_to_anchor=(0.5, below))
    figures.save(figure, name, caption)
