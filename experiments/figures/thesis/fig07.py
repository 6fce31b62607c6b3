"""The flow of events in `original`, as traced."""

import matplotlib.pyplot as plt

from thesis import drawing, stages

PLACES = {"draw": (2.0, 3.0), "detect": (4.2, 1.8), "handle": (4.2, 0.2),
          "calculate-positions": (0.9, 0.9)}


def draw(data, figures):
    figure, (flow, steps) = plt.subplots(1, 2, figsize=(9.0, 3.9),
                                         gridspec_kw={"width_ratios": [1.5, 1]})
    stages.diagram(flow, data.rows("transitions"), PLACES)
    drawing.bare(flow, -0.1, 5.2, -0.4, 3.6)
    rows = data.rows("frame")
    for row in rows:
        y = -0.5 * row["step"]
        drawing.node(steps, 1.0, y, stages.NAMES[row["stage"]].replace("\n", " "), 2.2, 0.36,
                     drawing.FIRST if row["stage"] == "draw" else "white", 9)
        steps.text(-0.3, y, f"{row['step']:.0f}", ha="right", va="center", fontsize=9)
    for row in rows[1:]:
        y = -0.5 * row["step"]
        drawing.arrow(steps, (1.0, y + 0.32), (1.0, y + 0.18))
    steps.text(1.0, -0.1, f"frame {data.value('frame'):.0f}", ha="center", fontweight="bold")
    drawing.bare(steps, -0.6, 2.3, -0.5 * len(rows) - 0.4, 0.2)
    figures.save(figure, "fig07", data.entry("caption"))
