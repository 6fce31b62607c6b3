"""How much each question had to look at: the mean, the 99th of a hundred, and the most."""

import matplotlib.pyplot as plt

import style
from data import unique


def draw(data, figures):
    rows = [row for row in data.rows("costs") if row["most"] > 0]
    questions = unique(str(row["question"]) for row in rows)
    figure, panel = plt.subplots(figsize=(9.2, 0.8 + 0.235 * (len(rows) + len(questions))))
    place, places, labels = 0, [], []
    for question in questions:
        place -= 1
        panel.text(0.0, place, question, transform=panel.get_yaxis_transform(), fontsize=8.5,
                   fontweight="bold", va="center",
                   bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0})
        for row in rows:
            if str(row["question"]) != question:
                continue
            place -= 1
            places.append(place)
            labels.append(str(row["unit"]))
            values = [max(float(row[name]), 0.1) for name in ("mean", "p99", "most")]
            panel.plot([values[0], values[2]], [place, place], color="#999999", linewidth=1.0)
            for at, mark, label in zip(values, ("o", "|", "x"),
                                       ("mean", "99 of 100 take at most", "most")):
                panel.plot([at], [place], color="black", marker=mark, linestyle="none",
                           markersize=6, label=label)
    panel.set_xscale("log")
    panel.set_yticks(places, labels, fontsize=8)
    panel.set_ylim(place - 0.8, -0.2)
    panel.set_xlabel("how many, for one question")
    style.legend_below(figure, [panel])
    figures.save(figure, "costs",
                 "What each question had to look at. A mean below 0.1 is drawn at 0.1.")
