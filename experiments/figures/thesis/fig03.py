"""Two boxes that overlap along one axis only, and the test that calls them colliding."""

import matplotlib.pyplot as plt

from thesis import aabbs


def draw(data, figures):
    figure, panels = plt.subplots(1, 2, figsize=(8.6, 4.4))
    aabbs.boxes(panels[0], aabbs.examples(data)["one axis"], "Along x only: they are disjoint")
    aabbs.rates(panels[1], data, "invented", "Overlaps invented", "% of disjoint random pairs")
    figures.save(figure, "fig03", data.entry("caption"))
