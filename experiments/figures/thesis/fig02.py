"""Two boxes that overlap along both axes, and where corner tests fail."""

import matplotlib.pyplot as plt

from thesis import aabbs


def draw(data, figures):
    examples = aabbs.examples(data)
    with plt.rc_context({"figure.constrained_layout.hspace": 0.14}):  # below the lists of answers
        figure, panels = plt.subplots(2, 2, figsize=(8.8, 10.2))
    panels = list(panels.flat)
    for panel, (name, title) in zip(panels, (("both axes", "Both axes: they overlap"),
                                             ("cross", "A cross: no corner in the other"),
                                             ("inside", "D inside C: no corner of C"))):
        aabbs.boxes(panel, examples[name], title)
    aabbs.rates(panels[3], data, "missed", "Overlaps missed", "% of overlapping random pairs")
    figures.save(figure, "fig02", data.entry("caption"))
