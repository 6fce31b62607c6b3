"""Get and Give: what each registered entity gives, and what it does with what it is given."""

import matplotlib.pyplot as plt

from data import pick, unique
from thesis import drawing

SHOWN = ["get_momentum", "get_force", "give_momentum", "give_force"]


def draw(data, figures):
    rows = data.rows("answers")
    entities = unique(row["entity"] for row in rows)
    figure, panel = plt.subplots(figsize=(10.4, 1.6 + 0.5 * len(entities)))
    columns = {"give_momentum": 1.9, "give_force": 4.3, "get_momentum": 9.6, "get_force": 12.9}
    top = 0.75 * len(entities)
    for method in SHOWN:
        original = pick(rows, method=method)[0]["original"]
        panel.text(columns[method], top + 0.75, method, ha="center", fontsize=9.5,
                   fontweight="bold")
        panel.text(columns[method], top + 0.42, original, ha="center", fontsize=8, color="#555555")
    panel.text(0.5 * (columns["give_momentum"] + columns["give_force"]), top + 1.2, "flows in",
               ha="center", fontsize=10, style="italic")
    panel.text(0.5 * (columns["get_momentum"] + columns["get_force"]), top + 1.2, "flows out",
               ha="center", fontsize=10, style="italic")
    for i, entity in enumerate(entities):
        y = top - 0.75 * i - 0.1
        drawing.node(panel, 6.7, y, entity, 2.4, 0.5, drawing.FIRST)
        for method in SHOWN:
            answer = pick(rows, entity=entity, method=method)[0]["answer"]
            answer = str(f"{answer:g}" if isinstance(answer, float) else answer)
            idle = answer in ("takes none", "0")
            panel.text(columns[method], y, answer, ha="center", va="center", fontsize=8.5,
                       color="#888888" if idle else "black")
        takes = any(pick(rows, entity=entity, method=m)[0]["answer"] != "takes none"
                    for m in ("give_momentum", "give_force"))
        drawing.arrow(panel, (5.15, y), (5.5, y), line="-" if takes else ":")
        drawing.arrow(panel, (7.9, y), (8.2, y))
    drawing.bare(panel, 0.3, 14.4, -0.3, top + 1.6)
    panel.set_aspect("auto")
    figures.save(figure, "fig08", data.entry("caption"))
