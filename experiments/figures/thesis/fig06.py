"""The separating axis that `sat` returns, with both projected intervals, and all 15 axes."""

import matplotlib.pyplot as plt

from data import pick
from thesis import drawing


def draw(data, figures):
    corners = data.rows("corners")
    axis = (data.value("axis_x"), data.value("axis_y"))
    figure, (plane, bars) = plt.subplots(1, 2, figsize=(10.6, 4.9),
                                         gridspec_kw={"width_ratios": [1.15, 1]})
    across = (axis[1], -axis[0])
    base = (0.95 * across[0], 0.95 * across[1])  # the placement of the axis is immaterial
    line = [(base[0] + s * axis[0], base[1] + s * axis[1]) for s in (-1.0, 2.4)]
    plane.plot(*zip(*line), color="black", linewidth=0.9)
    plane.annotate("L", line[1], fontsize=12, fontweight="bold", ha="left", va="bottom")
    for name, fill in (("A", drawing.FIRST), ("B", drawing.SECOND)):
        points = [(row["x"], row["y"]) for row in pick(corners, box=name)]
        drawing.outline(plane, points, fill)
        centre = [sum(c) / 4 for c in zip(*points)]
        plane.text(*centre, name, fontsize=13, fontweight="bold", ha="center", va="center",
                   zorder=5)
        interval = pick(data.rows("projections"), box=name)[0]
        ends = [(base[0] + s * axis[0], base[1] + s * axis[1])
                for s in (interval["lower"], interval["upper"])]
        plane.plot(*zip(*ends), color="black", linewidth=9, solid_capstyle="butt", zorder=3)
        plane.plot(*zip(*ends), color=fill, linewidth=6.5, solid_capstyle="butt", zorder=4)
        for s, end in zip((interval["lower"], interval["upper"]), ends):
            touching = min(points, key=lambda p: abs(p[0] * axis[0] + p[1] * axis[1] - s))
            plane.plot([touching[0], end[0]], [touching[1], end[1]], color="#777777",
                       linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)
    plane.set_aspect("equal")
    plane.set_xlabel("x / m")
    plane.set_ylabel("y / m")
    plane.set_title(f"Disjoint: {data.value('gap'):.4f} m apart along L")

    axes = data.rows("axes")
    names = [row["axis"].replace(" x ", "×") for row in axes]
    for name, row in zip(names, axes):
        gap = row["gap"]
        if gap is None:
            bars.text(0.02, name, "parallel", va="center", fontsize=8)
            bars.barh([name], [0])
            continue
        bars.barh([name], [gap], height=0.66, edgecolor="black", linewidth=0.8,
                  color="#5577aa" if gap > 0 else "#e2e2e2",
                  hatch="///" if row["returned"] else "")
    bars.axvline(0.0, color="black", linewidth=0.9)
    bars.invert_yaxis()
    bars.grid(axis="y", visible=False)
    bars.set_xlabel("|T·L| − (rA + rB) / m")
    bars.set_title("All 15 axes (hatched: returned)")
    figures.save(figure, "fig06", data.entry("caption"))
