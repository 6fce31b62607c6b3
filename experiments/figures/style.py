"""One look for all figures: legible in grey (line style and marker tell lines apart, not colour
alone), units on axes, the same bytes each time."""

import csv
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

# Paul Tol's "bright" colours, ordered so that neighbours differ in lightness, too.
COLOURS = ["#222255", "#EE6677", "#228833", "#AA3377", "#4477AA", "#CC9900", "#66CCEE", "#888888"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
DASHES = ["-", "--", "-.", (0, (1, 1.2)), (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (3, 1, 1, 1)),
          (0, (2, 2))]
PREDICTION = {"color": "black", "linestyle": (0, (1, 1)), "linewidth": 1.1, "zorder": 5}

# A method looks the same in every figure.
ORDER = ["original", "geometric", "substepped", "equal_substeps", "bisected", "event-driven"]


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


def look(name, names=()):
    """Line properties of a method: fixed for the schemes, what is left for anything else."""
    taken = [ORDER.index(other) for other in names if other in ORDER]
    free = [i for i in range(len(COLOURS)) if i not in taken]
    others = [other for other in names if other not in ORDER]
    if name in ORDER:
        i = ORDER.index(name)
    else:
        i = free[others.index(name) % len(free)] if name in others and free else 0
    return {"color": COLOURS[i], "marker": MARKERS[i], "linestyle": DASHES[i],
            "markerfacecolor": "white", "markeredgewidth": 1.1, "label": name}


def legend_below(figure, axes, columns=3):
    """One legend for all panels, below them."""
    seen = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            seen.setdefault(label, handle)
    inches = 0.1 + 0.19 * -(-len(seen) // columns)  # of the legend; 3.6 does not make room for it
    figure.legend(seen.values(), seen.keys(), loc="outside lower center"
                  if matplotlib.__version_info__ >= (3, 7) else "lower center", ncol=columns,
                  **({} if matplotlib.__version_info__ >= (3, 7)
                     else {"bbox_to_anchor": (0.5, -inches / figure.get_figheight())}))


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
