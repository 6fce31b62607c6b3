"""Error against counted work: a row per problem, a column per family of methods, a line per method,
failures at the upper edge."""

import math

import matplotlib.pyplot as plt

import style
from data import unique

ASTRAY = 0.3  # m: such an error is no answer
FLOOR = 1e-16

PROBLEMS = [("flight", "flight through air"), ("spring", "ball, spring and wall"),
            ("stroke", "table-tennis stroke"), ("tumbling", "tumbling box")]
FAMILIES = [("fixed step", ("explicit-euler", "symplectic-euler", "velocity-verlet", "rk4",
                            "suzuki4", "rkmk4")),
            ("controlled, one step", ("dopri5", "gsl-rkf45", "gsl-rk8pd", "gsl-bsimp", "arkode-4",
                                      "arkode-6", "arkode-8")),
            ("multistep, and other detectors", ())]  # and whatever else the tables have


def draw(data, figures):
    work(data, figures, "work_precision_rhs", "right-hand sides",
         lambda row: row["right_hand_sides"], PROBLEMS,
         "Error of position at the end against right-hand sides evaluated; one line per method, "
         "from little effort to much, grey: those of the other columns. Crosses at the upper edge: "
         "runs that failed or went astray.")
    work(data, figures, "work_precision_looks", "overlap tests and gap evaluations",
         looks, PROBLEMS[1:],
         "The same against looks at the geometry: overlap tests, and evaluations of gaps while "
         "impacts are located. Problems with impacts only.")
    schemes(data, figures)


def looks(row):
    return (row["overlap_tests"] or 0) + (row["toi_evaluations"] or 0)


def error(row):
    parts = [row[f"end_{axis}_error"] for axis in "xyz"]
    if row["status"] != "completed" or any(part is None for part in parts):
        return None
    return math.sqrt(sum(part * part for part in parts))


def work(data, figures, name, label, cost, problems, caption):
    tables = {sweep: data.table(sweep, "runs") for sweep, _ in problems}
    families = grouped(unique(row["method"] for rows in tables.values() for row in rows
                              if row["method"] != "reference"))
    figure, panels = plt.subplots(len(problems), len(families), sharex="row", sharey=True,
                                  figsize=(11.4, 2.7 * len(problems) + 1.4))
    for line, (sweep, title) in zip(panels, problems):
        for panel, (family, methods) in zip(line, families):
            for others in (True, False):
                draw_family(panel, tables[sweep], families, methods, cost, others)
            panel.set_xscale("log")
            panel.set_yscale("log")
            panel.set_ylim(FLOOR / 2, 1.0)
            panel.set_title(title, fontweight="normal")
        line[0].set_ylabel("error of position / m")
    for top, bottom, (family, methods) in zip(panels[0], panels[-1], families):
        bottom.set_xlabel(label)
        handles = [top.plot([], [], **look(method))[0] for method in methods]
        top.legend(handles, methods, loc="lower left", bbox_to_anchor=(-0.02, 1.12), fontsize=9.5,
                   title=family, title_fontproperties={"weight": "bold", "size": 10.5},
                   ncol=2, columnspacing=0.8, handlelength=1.7, handletextpad=0.5, alignment="left")
    figures.save(figure, name, caption)


def schemes(data, figures):
    """Billiards need no integrator: there the schemes differ."""
    rows = [row for row in data.table("billiard", "runs") if row["method"] != "reference"]
    methods = unique(row["method"] for row in rows)
    figure, panel = plt.subplots(figsize=(7.2, 4.4))
    for method in methods:
        draw_method(panel, [row for row in rows if row["method"] == method], looks,
                    style.look(method, methods))
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_ylim(FLOOR / 2, 1.0)
    panel.set_xlabel("overlap tests and gap evaluations")
    panel.set_ylabel("error of position / m")
    panel.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=9.5)
    figures.save(figure, "work_precision_schemes",
                 "Billiards: error of position at the end against looks at the geometry, a line "
                 "per scheme. Crosses at the upper edge: runs that failed or went astray.")


def grouped(methods):
    """The families with the methods that there are; the last takes all that no other has."""
    named = {method for _, members in FAMILIES for method in members}
    *first, (rest, _) = FAMILIES
    return ([(family, [m for m in members if m in methods]) for family, members in first] +
            [(rest, [m for m in methods if m not in named])])


def draw_family(panel, rows, families, methods, cost, others):
    """The lines of `methods`, or those of all others in grey."""
    for method in (m for _, members in families for m in members):
        of_method = [row for row in rows if row["method"] == method]
        if of_method and others and method not in methods:
            draw_method(panel, of_method, cost, {"color": "#dddddd", "linewidth": 0.9, "zorder": 1})
        elif of_method and not others and method in methods:
            draw_method(panel, of_method, cost, look(method))


def look(method):
    return style.look(method) | {"linewidth": 1.3}


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
    if bad and "marker" in drawn:
        panel.plot(bad, [0.7] * len(bad), linestyle="none", marker="x", color=drawn["color"],
                   markersize=6, clip_on=False)
