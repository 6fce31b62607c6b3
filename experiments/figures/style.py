"""One look for all figures: legible in grey (line style and marker tell lines apart, not colour
alone), units on axes, the same bytes each time. Methods look as methods.py says."""

import csv
import os

import matplotlib
import matplotlib.pyplot as plt

from methods import (  # noqa: F401  (figures ask style for all)
    COLOURS, DASHES, MARKERS, by_place, look, scheme_of)

PREDICTION = {"color": "black", "linestyle": (0, (1, 1)), "linewidth": 1.1, "zorder": 5}


def use():
    plt.rcParams.update({
        "svg.hashsalt": "kairos", "svg.fonttype": "path", "font.size": 9.5,
        "font.family": "DejaVu Sans", "axes.titlesize": 10, "axes.titleweight": "bold",
        "axes.titlelocation": "left", "axes.spines.top": False, "axes.spines.right": False,
        "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True,
        "legend.frameon": False, "legend.fontsize": 8.5, "lines.linewidth": 1.5,
        "lines.markersize": 4.5, "figure.dpi": 100, "savefig.dpi": 160,
        "figure.constrained_layout.use": True, "axes.formatter.useoffset": False,
    })


def legend_below(figure, axes, columns=3):
    """One legend for all panels, below them."""
    seen = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            seen.setdefault(label, handle)
    legend_of(figure, list(seen.values()), columns, list(seen.keys()))


def legend_of(figure, handles, columns=3, labels=None):
    """A legend of these, below all panels."""
    labels = labels or [handle.get_label() for handle in handles]
    inches = 0.1 + 0.19 * -(-len(labels) // columns)  # of the legend; 3.6 does not make room for it
    figure.legend(handles, labels, loc="outside lower center"
                  if matplotlib.__version_info__ >= (3, 7) else "lower center", ncol=columns,
                  **({} if matplotlib.__version_info__ >= (3, 7)
                     else {"bbox_to_anchor": (0.5, -inches / figure.get_figheight())}))


def over_roundoff(figure, place, upper, lower, share=0.22):
    """Two panels for one quantity on a logarithmic axis with nothing in the decades between: `upper`
    and, below a break, what is at roundoff. Both are limits (low, high). Returns both panels."""
    inner = place.subgridspec(2, 1, height_ratios=[1 - share, share], hspace=0.08)
    top = figure.add_subplot(inner[0])
    bottom = figure.add_subplot(inner[1], sharex=top)
    for panel, limits in ((top, upper), (bottom, lower)):
        panel.set_yscale("log")
        panel.set_ylim(*limits)
    top.spines["bottom"].set_visible(False)
    top.tick_params(axis="x", which="both", bottom=False, labelbottom=False)
    cut = {"marker": [(-1, -0.6), (1, 0.6)], "markersize": 7, "linestyle": "none", "color": "black",
           "markeredgewidth": 1, "clip_on": False}
    top.plot([0], [0], transform=top.transAxes, **cut)
    bottom.plot([0], [1], transform=bottom.transAxes, **cut)
    return top, bottom


class Figures:
    """Saves figures and remembers their captions."""

    def __init__(self, folder):
        self.folder = folder
        self.captions = []

    def save(self, figure, name, caption):
        for kind, metadata in (("svg", {"Date": None}), ("png", {"Software": None})):
            path = os.path.join(self.folder, f"{name}.{kind}")
            figure.savefig(path + ".part", format=kind, metadata=metadata, bbox_inches="tight",
                           facecolor="white")
            os.replace(path + ".part", path)
        plt.close(figure)
        self.captions.append((name, caption))

    def list_captions(self):
        path = os.path.join(self.folder, "figures.csv")
        with open(path + ".part", "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["figure", "caption"])
            writer.writerows(self.captions)
        os.replace(path + ".part", path)
