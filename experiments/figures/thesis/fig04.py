"""An oriented bounding box fitted to a mesh: centre, axes, radii; and what misalignment costs."""

import matplotlib.pyplot as plt

from thesis import drawing


def draw(data, figures):
    figure, (plane, tilt) = plt.subplots(1, 2, figsize=(9.8, 4.0),
                                         gridspec_kw={"width_ratios": [1.3, 1]})
    for row in data.rows("edges"):
        plane.plot([row["x0"], row["x1"]], [row["y0"], row["y1"]], color="#7788aa", linewidth=0.6,
                   zorder=2)
    drawing.outline(plane, [(row["x"], row["y"]) for row in data.rows("corners")], zorder=3)
    centre = (data.value("centre_x"), data.value("centre_y"))
    plane.plot(*centre, "ko", markersize=5, zorder=6)
    for row in data.rows("axes")[:2]:
        tip = (centre[0] + row["radius"] * row["x"], centre[1] + row["radius"] * row["y"])
        plane.annotate("", tip, centre, zorder=5,
                       arrowprops={"arrowstyle": "-|>", "linewidth": 1.6, "color": "black",
                                   "shrinkA": 0, "shrinkB": 0})
        place = (centre[0] + 0.55 * row["radius"] * row["x"] - 0.1 * row["y"],
                 centre[1] + 0.55 * row["radius"] * row["y"] + 0.1 * row["x"])
        plane.text(*place, f"a{row['axis']:.0f} = {row['radius']:.2f} m", ha="center", va="center",
                   fontsize=9, zorder=7,
                   bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0})
    plane.set_aspect("equal")
    plane.margins(0.08)
    plane.set_xlabel("x / m")
    plane.set_ylabel("y / m")
    plane.set_title("Centre, axes, radii")
    rows = data.rows("tilts")
    tilt.plot([row["angle"] for row in rows], [row["volume"] for row in rows], color="black")
    tilt.set_xticks(range(0, 91, 15))
    tilt.set_ylim(bottom=0)
    tilt.set_xlabel("angle of the mesh in its file / °")
    tilt.set_ylabel("volume of the box, aligned = 1")
    tilt.set_title("Fitted to a mesh that is not aligned")
    figures.save(figure, "fig04", data.entry("caption"))
