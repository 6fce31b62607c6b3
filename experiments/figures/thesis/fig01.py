"""Two spheres: apart, touching, overlapping, with the library's answers."""

import matplotlib.pyplot as plt

from thesis import drawing


def draw(data, figures):
    pairs = data.rows("pairs")
    figure, panels = plt.subplots(1, len(pairs), figsize=(10.2, 3.7), sharey=True)
    for panel, row in zip(panels, pairs):
        drawing.ball(panel, 0.0, 0.0, row["ra"], drawing.FIRST)
        drawing.ball(panel, row["bx"], row["by"], row["rb"], drawing.SECOND)
        panel.plot([0, row["bx"]], [0, row["by"]], color="black", linewidth=0.9,
                   linestyle=(0, (4, 2)), zorder=4)
        panel.plot([row["px"]], [row["py"]], "x", color="black", markersize=8,
                   markeredgewidth=1.6, zorder=6)
        panel.text(-0.12, 0.12, "A", fontsize=12, fontweight="bold", ha="right", zorder=6)
        panel.text(row["bx"] + 0.12, row["by"] + 0.08, "B", fontsize=12, fontweight="bold",
                   zorder=6)
        answer = "overlap" if row["overlapping"] else "no overlap"
        panel.set_title(f"{row['case']}: {answer}")
        panel.text(0.97, 0.04, f"distance {row['distance']:.2f} m\nrA + rB {row['ra'] + row['rb']:.2f} m"
                   f"\ngap {row['gap']:+.2f} m", transform=panel.transAxes, ha="right", va="bottom")
        panel.set_xlim(-1.2, 2.8)
        panel.set_ylim(-1.5, 1.9)
        panel.set_aspect("equal")
        panel.set_xlabel("x / m")
    panels[0].set_ylabel("y / m")
    figures.save(figure, "fig01", data.entry("caption"))
