"""How far each scheme is off, problem by problem, on one scale."""

import matplotlib.pyplot as plt

import style
from data import unique

LEAST, MOST = 1e-16, 2.0  # what is right to the last digit, or beside all truth, is drawn there


def draw(data, figures):
    rows = data.rows("errors")
    problems = unique((str(row["problem"]), str(row["quantity"])) for row in rows)
    schemes = unique(str(row["scheme"]) for row in rows)
    told = [p for p in problems if any(value(rows, p, s) is not None for s in schemes)]
    figure, panel = plt.subplots(figsize=(8.6, 0.6 + 0.27 * len(told)))
    for place, scheme in enumerate(schemes):
        at = [(min(max(value(rows, p, scheme), LEAST), MOST), len(told) - k)
              for k, p in enumerate(told) if value(rows, p, scheme) is not None]
        look = dict(style.by_place(place, scheme), linestyle="none")
        panel.plot([x for x, _ in at], [y for _, y in at], **look)
    panel.set_xscale("log")
    panel.set_xlim(0.5 * LEAST, 2.0 * MOST)
    panel.set_yticks([len(told) - k for k in range(len(told))],
                     [f"{problem}: {quantity}" for problem, quantity in told], fontsize=8)
    panel.grid(axis="y", visible=True)
    panel.set_xlabel("error, of the truth (of 1 where that is zero)")
    style.legend_below(figure, [panel])
    figures.save(figure, "errors",
                 "How far each scheme is off. A mark at the left edge is right to the last digit, "
                 "one at the right edge is off by twice the truth or more; one that is missing tells no such "
                 "moment, or stopped with a reason.")


def value(rows, problem, scheme):
    found = [row["error"] for row in rows
             if (str(row["problem"]), str(row["quantity"])) == problem and row["scheme"] == scheme]
    return found[0] if found else None
