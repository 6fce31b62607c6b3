"""The improved flow of events, as `substepped` really went through it, and its fractions."""

import matplotlib.pyplot as plt

from data import pick
from thesis import drawing, stages

PLACES = {"draw": (1.0, 3.4), "calculate-positions": (1.0, 1.9), "restrict-movement": (1.0, 0.2),
          "advance": (3.6, 0.2), "detect": (5.6, 1.9), "handle": (3.6, 3.4)}


def draw(data, figures):
    figure, (flow, line) = plt.subplots(2, 1, figsize=(7.6, 6.6),
                                        gridspec_kw={"height_ratios": [3.2, 1]})
    stages.diagram(flow, data.rows("transitions"), PLACES)
    drawing.bare(flow, 0.0, 6.6, -0.3, 3.9)
    rows = data.rows("frame")
    ends = [row["fraction"] for row in pick(rows, stage="advance")]
    for i, (start, end) in enumerate(zip([0.0] + ends, ends)):
        line.barh([0], [end - start], left=start, height=0.5, edgecolor="black", linewidth=0.9,
                  color=drawing.FIRST if i % 2 == 0 else "white")
    handled = [row["fraction"] for row in pick(rows, stage="handle")]
    line.plot(handled, [0] * len(handled), "X", color="black", markersize=9, zorder=5,
              label="pair handled")
    line.set_xlim(0, 1.02)
    line.set_ylim(-0.5, 0.9)
    line.set_yticks([])
    line.grid(visible=False)
    line.set_xlabel(f"fraction of frame {data.value('frame'):.0f}")
    line.set_title(f"{len(ends)} substeps: {data.value('fraction'):.3g} of the frame each, "
                   f"the last {data.value('last'):.3g}")
    line.legend(loc="upper left")
    figures.save(figure, "fig15", data.entry("caption"))
