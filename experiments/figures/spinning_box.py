"""All integrators agree on the impact of a tumbling box as the step shrinks."""

import matplotlib.pyplot as plt

import style
from data import pick, points, unique


def draw(data, figures):
    rows = data.table("spinning-box", "runs")
    methods = [m for m in unique(row["method"] for row in rows)]
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 3.9))
    for panel, metric, label in ((panels[0], "first_impact_error", "error of the time of impact / s"),
                                 (panels[1], "end_spin_error",
                                  "error of the spin after it / (rad/s)")):
        for method in methods:
            h, error = points(pick(rows, method=method), "h", metric)
            if any(value > 0 for value in error):
                panel.plot(h, [value if value > 0 else None for value in error],
                           **style.look(method, methods))
        slopes(panel, rows, metric)
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xlabel("step h / s")
        panel.set_ylabel(label)
    panels[0].set_title("When it hits")
    panels[1].set_title("How it spins afterwards")
    style.legend_below(figure, panels[:1], columns=4)
    figures.save(figure, "spinning_box", data.entry("caption:spinning-box"))


def slopes(panel, rows, metric):
    """Reference slopes 1, 2 and 4, through the largest error at the largest step."""
    h = sorted({row["h"] for row in rows if row["h"]})
    errors = [row[metric] for row in rows if row["h"] == h[-1] and row[metric]]
    if not errors:
        return
    for order in (1, 2, 4):
        y = [2.0 * max(errors) * (x / h[-1]) ** order for x in h]
        shown = [(x, v) for x, v in zip(h, y) if v > 1e-15]
        panel.plot(*zip(*shown), color="#999999", linewidth=0.8, linestyle=":")
        panel.annotate(f"h{'¹²³⁴'[order - 1]}", shown[0], fontsize=8, color="#666666",
                       textcoords="offset points", xytext=(-2, 3))
