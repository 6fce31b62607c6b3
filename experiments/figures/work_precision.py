"""Error against counted work: a panel per problem, a line per method, failures at the upper edge."""

import math

import matplotlib.pyplot as plt

import style
from data import unique

ASTRAY = 0.3  # m: such an error is no answer
FLOOR = 1e-16

PROBLEMS = [("flight", "flight through air"), ("spring", "ball, spring and wall"),
            ("stroke", "table-tennis stroke"), ("tumbling", "tumbling box"),
            ("billiard", "billiards")]


def draw(data, figures):
    work(data, figures, "work_precision_rhs", "right-hand sides",
         lambda row: row["right_hand_sides"], PROBLEMS[:4],
         "Error of position at the end against right-hand sides evaluated; one line per method, "
         "from little effort to much. Crosses at the upper edge: runs that failed or went astray.")
    work(data, figures, "work_precision_looks", "overlap tests and gap evaluations",
         lambda row: (row["overlap_tests"] or 0) + (row["toi_evaluations"] or 0), PROBLEMS[1:],
         "The same against looks at the geometry: overlap tests, and evaluations of gaps while "
         "impacts are located. Problems with impacts only.")


def error(row):
    parts = [row[f"end_{axis}_error"] for axis in "xyz"]
    if row["status"] != "completed" or any(part is None for part in parts):
        return None
    return math.sqrt(sum(part * part for part in parts))


def work(data, figures, name, label, cost, problems, caption):
    columns = 2
    lines = -(-len(problems) // columns)
    tables = {sweep: data.table(sweep, "runs") for sweep, _ in problems}
    every = unique(row["method"] for rows in tables.values() for row in rows
                   if row["method"] != "reference")
    figure, panels = plt.subplots(lines, columns, figsize=(10.5, 3.9 * lines))
    for panel, (sweep, title) in zip(panels.flat, problems):
        for i, method in enumerate(every):
            rows = [row for row in tables[sweep] if row["method"] == method]
            if rows:
                draw_method(panel, rows, cost, look(method, i))
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_ylim(FLOOR / 2, 1.0)
        panel.set_xlabel(label)
        panel.set_ylabel("error of position / m")
        panel.set_title(title)
    for panel in list(panels.flat)[len(problems):]:
        panel.set_visible(False)
    style.legend_below(figure, panels.flat, columns=5)
    figures.save(figure, name, caption)


def look(method, i):
    """More methods than colours: the dashes tell the rounds apart."""
    return {"color": style.COLOURS[i % len(style.COLOURS)],
            "marker": style.MARKERS[i % len(style.MARKERS)],
            "linestyle": style.DASHES[i // len(style.COLOURS)], "markerfacecolor": "white",
            "markeredgewidth": 1.1, "linewidth": 1.1, "label": method}


def draw_method(panel, rows, cost, drawn):
    good, bad = [], []
    for row in rows:
        e, c = error(row), cost(row)
        if row["status"] == "refused" or not c:
            continue  # of a run that failed at once, no work is known
        if e is None or e > ASTRAY:
            bad.append(c)
        else:
            good.append((c, max(e, FLOOR)))
    panel.plot([p[0] for p in good], [p[1] for p in good], **drawn)
    if not bad:
        return
    panel.plot(bad, [0.7] * len(bad), linestyle="none", marker="x", color=drawn["color"],
               markersize=5, clip_on=False)
