"""The swept box of the geometric approach, around positions 1 and 3."""

import matplotlib.pyplot as plt

from data import pick
from thesis import drawing


def draw(data, figures):
    positions = data.rows("positions")
    boxes = data.rows("boxes")
    radius = data.value("radius")
    figure, panel = plt.subplots(figsize=(7.2, 4.6))
    left = min(row["x"] for row in boxes) - 1.2 * radius
    right = max(row["x"] for row in boxes) + 3.0 * radius
    drawing.wall(panel, left, right, 1.7 * radius)
    for row, line, fill in zip(positions, ("-", ":", "-"),
                               (drawing.FIRST, "white", drawing.SECOND)):
        drawing.ball(panel, row["x"], row["y"], radius, fill, line)
        panel.text(row["x"] + 0.14 * radius, row["y"] + 0.1 * radius, f"{row['position']:.0f}",
                   fontsize=13, fontweight="bold", zorder=7)
    for name, line, label in (("displacement", "-", f"along the displacement, "
                               f"{data.value('volume'):.3f} m³"),
                              ("own axes", "--", f"the body's own axes, "
                               f"{data.value('own_volume'):.3f} m³")):
        corners = [(row["x"], row["y"]) for row in pick(boxes, box=name)]
        drawing.outline(panel, corners, line=line, zorder=5, label=label)
    panel.legend(loc="upper right")
    panel.set_xlim(left, right)
    panel.set_ylim(-1.7 * radius, max(row["y"] for row in boxes) + 1.6 * radius)
    panel.set_aspect("equal")
    panel.set_xlabel("x / m")
    panel.set_ylabel("y / m")
    figures.save(figure, "fig14", data.entry("caption"))
