"""Right-hand sides per bounce of each controlled method, restarted and started cold."""

import matplotlib.pyplot as plt

import style
from data import pick, unique


def draw(data, figures):
    rows = data.table("restarts", "runs")
    methods = unique(row["method"] for row in rows)
    tolerances = unique(row["tolerance"] for row in rows)
    figure, panels = plt.subplots(1, len(tolerances), figsize=(9.6, 5.6), sharey=True)
    for panel, tolerance in zip(panels, tolerances):
        for cold, marker, label in ((0, "o", "restarted"), (1, "s", "cold start")):
            of = {row["method"]: row["per_bounce"]
                  for row in pick(rows, tolerance=tolerance, cold=float(cold))}
            x = [of[method] for method in methods]
            shown = [(value, i) for i, value in enumerate(x) if value is not None]
            panel.plot([p[0] for p in shown], [p[1] for p in shown], linestyle="none",
                       marker=marker, color=style.COLOURS[cold], label=label,
                       markerfacecolor=style.COLOURS[0] if cold == 0 else "white")
            for value, i in shown:
                panel.annotate(f"{value:.0f}", (value, i), textcoords="offset points", fontsize=7,
                               xytext=(0, 5 if cold else -11), ha="center",
                               color=style.COLOURS[cold])
        panel.set_xscale("log")
        panel.set_yticks(range(len(methods)), methods)
        panel.set_xlabel("right-hand sides per bounce")
        panel.set_title(f"tolerance {tolerance:g}")
    panels[0].invert_yaxis()
    style.legend_below(figure, panels[:1], columns=2)
    figures.save(figure, "restarts", data.entry("caption:restarts"))
