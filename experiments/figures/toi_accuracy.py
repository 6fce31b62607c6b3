"""Error and cost of times of impact against the tolerance asked for."""

import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

import style
from data import pick, points, unique

FLOOR = 1e-17  # s: below the last bit of the times


def draw(data, figures):
    rows = data.rows("tolerance")
    methods = unique(row["method"] for row in rows)
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 3.9))
    for method in methods:
        of_method = pick(rows, method=method)
        look = style.look(method, methods)
        x, median = points(of_method, "tolerance", "median_error")
        panels[0].plot(x, [max(value, FLOOR) for value in median], **look)
        x, worst = points(of_method, "tolerance", "greatest_error")
        panels[0].plot(x, [max(value, FLOOR) for value in worst],
                       **{**look, "linestyle": "", "label": None,
                          "markerfacecolor": look["color"]})
        x, cost = points(of_method, "tolerance", "evaluations")
        panels[1].plot(x, cost, **look)
    for panel in panels:
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xlabel("tolerance asked for / m")
        panel.invert_xaxis()
    panels[0].set_ylabel("error of the time of impact / s")
    panels[0].set_title("How far off: median, and worst (filled)")
    panels[1].set_ylabel("evaluations of one query")
    panels[1].yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    panels[1].yaxis.set_major_formatter("{x:g}")
    panels[1].yaxis.set_minor_formatter(NullFormatter())
    silent = [m for m in methods if not points(pick(rows, method=m), "tolerance", "evaluations")[0]]
    panels[1].set_title("What it costs" + (f" ({', '.join(silent)} does not tell)" if silent else ""))
    style.legend_below(figure, panels[:1], columns=4)
    figures.save(figure, "toi_accuracy", data.entry("caption"))
