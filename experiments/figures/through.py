"""Panels that several experiments draw alike: how often right through, how deep, how long it shows."""

import style
from data import pick, points, unique


def fraction(panel, rows, x, metric, title):
    """Of the runs that went through, a line per method."""
    methods = unique(row["method"] for row in rows)
    for method in methods:
        panel.plot(*points(pick(rows, method=method), x, f"{metric}.mean"),
                   **style.look(method, methods))
    panel.set_title(title)
    panel.set_ylabel("fraction of runs")
    panel.set_ylim(-0.03, 1.03)


def medians(panel, rows, x, metric, shown=lambda row: True):
    """With the quartiles shaded; only the rows that `shown` wants, with gaps for the others."""
    methods = unique(row["method"] for row in rows)
    for method in methods:
        look = style.look(method, methods)
        of_method = pick(rows, method=method)
        place = [row[x] for row in of_method]
        line, low, high = ([row[f"{metric}.{which}"] if shown(row) else None for row in of_method]
                           for which in ("median", "q1", "q3"))
        nothing = float("nan")
        panel.plot(place, [nothing if y is None else y for y in line], **look)
        panel.fill_between(place, [nothing if y is None else y for y in low],
                           [nothing if y is None else y for y in high], color=look["color"],
                           alpha=0.15, linewidth=0)
    panel.set_ylim(bottom=0)


def drawn_depth(panel, rows, x, passed):
    """Where most runs went through, no frame shows how deep: nothing is drawn there."""
    medians(panel, rows, x, "max_penetration", lambda row: row[f"{passed}.mean"] < 0.5)
    panel.set_title("How deep, as drawn")
    panel.set_ylabel("deepest overlap in a frame / m")


def drawn_time(panel, rows, x, passed):
    """The same of how long."""
    medians(panel, rows, x, "overlap_time", lambda row: row[f"{passed}.mean"] < 0.5)
    panel.set_title("How long, as drawn")
    panel.set_ylabel("time of overlap in frames / s")
