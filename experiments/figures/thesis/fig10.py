"""The class diagram of the entities, from the catalogue."""

import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle

from data import pick
from thesis import drawing

LINE = 0.3


def card(panel, x, top, width, title, sections):
    """A class: its name, then sections of lines. Returns where it ends."""
    height = LINE * (1.4 + sum(len(lines) + 0.5 for lines in sections))
    panel.add_patch(Rectangle((x, top - height), width, height, facecolor="white",
                              edgecolor="black", linewidth=1.1, zorder=2))
    panel.add_patch(Rectangle((x, top - 1.4 * LINE), width, 1.4 * LINE, facecolor=drawing.FIRST,
                              edgecolor="black", linewidth=1.1, zorder=3))
    panel.text(x + width / 2, top - 0.7 * LINE, title, ha="center", va="center", fontsize=9,
               fontweight="bold", zorder=4)
    y = top - 1.4 * LINE
    for lines in sections:
        y -= 0.25 * LINE
        for line in lines:
            y -= LINE
            panel.text(x + 0.1, y + 0.5 * LINE, line, va="center", fontsize=8, zorder=4)
        y -= 0.25 * LINE
        if lines is not sections[-1]:
            panel.plot([x, x + width], [y, y], color="black", linewidth=0.8, zorder=3)
    return top - height


def draw(data, figures):
    attributes = data.rows("attributes")
    answers = data.rows("answers")
    classes = data.rows("classes")
    methods = list(dict.fromkeys(row["method"] for row in answers))
    common = [row["key"] for row in attributes if row["entity"] is None]
    root = next(row["parent"] for row in classes
                if row["parent"] not in {other["class"] for other in classes})
    figure, panel = plt.subplots(figsize=(11.4, 6.4))
    # What most entities answer is the base class's business; a card shows what differs.
    usual = {}
    for method in methods:
        given = [row["answer"] for row in pick(answers, method=method)]
        usual[method] = max(dict.fromkeys(map(str, given)), key=lambda a: [str(g) for g in given].count(a))
    bottoms = [0.3, 0.3, 0.3]  # of each column of cards, the gap to the next one included
    base = card(panel, 0.0, 0.0, 2.9, f"{root} of a body", [common, [m + "()" for m in methods]])
    for row in classes:
        keys = [f"{key['key']} = {key['default']:g}" + (f" {key['unit']}" if key["unit"] else "")
                for key in pick(attributes, entity=row["entity"])]
        traits = [f"type {row['physics_type']}, {row['mobility']}"]
        traits += [word for word in ("stationary", "field", "rotates") if row[word]]
        differs = [f"{method}: {a:g}" if isinstance(a, float) else f"{method}: {a}"
                   for method in methods
                   for a in [pick(answers, entity=row["entity"], method=method)[0]["answer"]]
                   if str(a) != usual[method]]
        sections = [lines for lines in (traits, keys, differs) if lines]
        column = bottoms.index(max(bottoms))
        bottoms[column] = card(panel, 3.5 + 3.55 * column, bottoms[column] - 0.3, 3.35,
                               f"{row['class']} : {row['parent']}", sections)
    panel.set_xlim(-0.15, 14.2)
    panel.set_ylim(min(base, *bottoms) - 0.2, 0.2)
    panel.axis("off")
    figures.save(figure, "fig10", data.entry("caption"))
