"""3.2: one bat in its box, in its hull and as itself: how early it hits, and what that costs."""

import matplotlib.pyplot as plt

from thesis import drawing


def draw(data, figures):
    figure, (front, gaps, cost) = plt.subplots(1, 3, figsize=(11.2, 3.9),
                                               gridspec_kw={"width_ratios": [0.7, 1, 1]})
    xs, ys = [], []
    for row in data.rows("edges"):
        front.plot([row["x0"], row["x1"]], [row["y0"], row["y1"]], color="#7788aa", linewidth=0.7,
                   zorder=2)
        xs += [row["x0"], row["x1"]]
        ys += [row["y0"], row["y1"]]
    drawing.rectangle(front, min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys), fill="none",
                      zorder=3)
    front.set_aspect("equal")
    front.margins(0.1)
    front.set_xlabel("x / m")
    front.set_ylabel("y / m")
    front.set_title("The bat and its box")
    rows = data.rows("bats")
    names = [row["bat"].replace("mesh, ", "") for row in rows]
    places = range(len(rows))
    gaps.barh(places, [1e3 * row["most_gap"] for row in rows], color=drawing.FIRST,
              edgecolor="black", linewidth=0.8)
    for place, row in zip(places, rows):
        gaps.text(1e3 * row["most_gap"], place, f" {row['early']:.0f} of {row['hits']:.0f} early",
                  va="center", fontsize=8.5)
    gaps.set_yticks(places, names)
    gaps.invert_yaxis()
    gaps.margins(x=0.35)
    gaps.set_xlabel("farthest from the mesh at an impact / mm")
    cost.barh(places, [row["looks"] for row in rows], color=drawing.SECOND, edgecolor="black",
              linewidth=0.8)
    cost.set_yticks(places, names)
    cost.invert_yaxis()
    cost.set_xlabel("looks at an instant, a rally")
    figure.tight_layout()
    figures.save(figure, "sec32", data.entry("caption"))
