"""Flow diagrams from traces: boxes are stages, arrows are transitions that happened."""

import math

from thesis import drawing

NAMES = {"draw": "draw\nscene", "detect": "detect\ncollisions", "handle": "handle\ncollisions",
         "calculate-positions": "calculate new\npositions", "advance": "advance\nby the fraction",
         "restrict-movement": "scale + restrict\nmovements", "locate": "locate\ncontact"}
WIDTH, HEIGHT = 1.55, 0.72


def edge(start, end):
    """Where the line between two boxes leaves the first one."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    scale = min(WIDTH / 2 / abs(dx) if dx else math.inf, HEIGHT / 2 / abs(dy) if dy else math.inf)
    return start[0] + scale * dx, start[1] + scale * dy


def diagram(panel, transitions, places):
    """places: where each stage of the trace stands. Stages that did not happen are not drawn."""
    happened = {row["from"] for row in transitions} | {row["to"] for row in transitions}
    for stage in sorted(happened):
        fill = drawing.FIRST if stage == "draw" else "white"
        drawing.node(panel, *places[stage], NAMES[stage], WIDTH, HEIGHT, fill)
    pairs = {(row["from"], row["to"]) for row in transitions}
    for row in transitions:
        start, end = places[row["from"]], places[row["to"]]
        shift = 0.0
        if (row["to"], row["from"]) in pairs:
            shift = 0.13  # two arrows between the same boxes stand side by side
        length = math.hypot(end[0] - start[0], end[1] - start[1])
        side = ((end[1] - start[1]) / length * shift, -(end[0] - start[0]) / length * shift)
        a = tuple(p + s for p, s in zip(edge(start, end), side))
        b = tuple(p + s for p, s in zip(edge(end, start), side))
        drawing.arrow(panel, a, b)
        middle = (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))
        panel.text(*middle, f"{row['count']:.0f}", fontsize=8.5, ha="center", va="center",
                   zorder=5, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.2})
