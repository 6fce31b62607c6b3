"""Counted work without each saving, relative to the work with it."""

import matplotlib.pyplot as plt

WORK = [("rhs", "right-hand sides", "#222255", "o"), ("queries", "time-of-impact queries", "#EE6677", "s"),
        ("evaluations", "gap evaluations", "#228833", "^")]


def draw(data, figures):
    rows = data.rows("savings")
    figure, panel = plt.subplots(figsize=(8.2, 0.55 * len(rows) + 1.4))
    for key, label, colour, marker in WORK:
        kept = [(i, r[f"{key}_without"] / r[f"{key}_with"]) for i, r in enumerate(rows)
                if r[f"{key}_with"]]
        panel.plot([x for _, x in kept], [i for i, _ in kept], linestyle="none", marker=marker,
                   color=colour, markerfacecolor="white", label=label)
    panel.axvline(1.0, color="black", linewidth=0.8, linestyle=":")
    panel.set_xscale("log")
    panel.set_yticks(range(len(rows)), [f"{r['saving']}\n({r['scene']})" for r in rows], fontsize=8)
    panel.invert_yaxis()
    panel.set_xlabel("work without the saving, relative to the work with it")
    panel.legend(loc="upper right")
    figures.save(figure, "savings", "What the model's savings save.")
