"""The ball penetrates into the wall: measured positions 1, 2 and 3."""

import matplotlib.pyplot as plt

from thesis import drawing


def draw(data, figures):
    positions = data.rows("positions")
    radius = data.value("radius")
    figure, panel = plt.subplots(figsize=(7.2, 4.4))
    left = positions[0]["x"] - 2.2 * radius
    right = positions[-1]["x"] + 3.4 * radius
    drawing.wall(panel, left, right, 1.7 * radius)
    panel.annotate("", (positions[-1]["x"], positions[-1]["y"]),
                   (positions[0]["x"], positions[0]["y"]),
                   arrowprops={"arrowstyle": "->", "linewidth": 1.0, "shrinkA": 4, "shrinkB": 4},
                   zorder=6)
    for row, line, fill in zip(positions, ("-", "--", "-"),
                               (drawing.FIRST, "white", drawing.SECOND)):
        drawing.ball(panel, row["x"], row["y"], radius, fill, line)
        panel.text(row["x"] + 0.14 * radius, row["y"] + 0.1 * radius, f"{row['position']:.0f}",
                   ha="left", va="bottom", fontsize=13, fontweight="bold", zorder=7)
    last = positions[-1]
    x = last["x"] + 1.35 * radius
    panel.annotate("", (x, 0), (x, last["y"] - radius), arrowprops={"arrowstyle": "<->"})
    panel.text(x + 0.12 * radius, 0.5 * (last["y"] - radius), f"{-1000 * last['gap']:.1f} mm deep",
               va="center", bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5})
    text = "\n".join(f"{row['position']:.0f}: t = {row['t']:.6f} s, gap "
                     + (f"{1000 * row['gap']:+8.1f} mm" if abs(row["gap"]) > 1e-6
                        else f"{row['gap']:8.1e} m ") for row in positions)
    panel.text(0.985, 0.97, text, transform=panel.transAxes, ha="right", va="top", fontsize=9,
               family="DejaVu Sans Mono")
    panel.set_xlim(left, right)
    panel.set_ylim(-1.7 * radius, positions[0]["y"] + 1.9 * radius)
    panel.set_aspect("equal")
    panel.set_xlabel("x / m")
    panel.set_ylabel("y / m")
    figures.save(figure, "fig13", data.entry("caption"))
