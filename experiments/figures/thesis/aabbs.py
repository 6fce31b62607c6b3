"""What figs. 2 and 3 share: two boxes, their overlap along each axis, the answers of the tests."""

from data import pick
from thesis import drawing

NAMES = {"printed": "as printed", "corner": "one corner", "corners": "four corners",
         "both": "corners of both", "intervals": "both axes", "library": "library"}


def boxes(panel, rows, title):
    """One example: rows are the answers of the tests on the same two boxes."""
    row = rows[0]
    smaller_d = row["ddx"] * row["ddy"] < row["cdx"] * row["cdy"]
    drawing.rectangle(panel, row["dx"], row["dy"], row["ddx"], row["ddy"], drawing.FIRST,
                      zorder=4 if smaller_d else 2)
    drawing.rectangle(panel, row["cx"], row["cy"], row["cdx"], row["cdy"], drawing.SECOND,
                      zorder=3)
    panel.plot([row["cx"]], [row["cy"]], "ko", markersize=5, zorder=6)
    panel.text(row["dx"] + 0.07, row["dy"] + 0.07, "D", fontsize=11, fontweight="bold", zorder=6)
    panel.text(row["cx"] + row["cdx"] - 0.07, row["cy"] + row["cdy"] - 0.07, "C", fontsize=11,
               fontweight="bold", ha="right", va="top", zorder=6)
    for start, length, offset, label in ((row["dx"], row["ddx"], -0.16, "D"),
                                         (row["cx"], row["cdx"], -0.32, "C")):
        panel.plot([start, start + length], [offset, offset], color="black", linewidth=2.2)
        panel.text(start + length + 0.05, offset, label, va="center", fontsize=8)
    for start, length, offset, label in ((row["dy"], row["ddy"], -0.16, "D"),
                                         (row["cy"], row["cdy"], -0.32, "C")):
        panel.plot([offset, offset], [start, start + length], color="black", linewidth=2.2)
        panel.text(offset, start + length + 0.05, label, ha="center", fontsize=8)
    panel.set_title(title)
    lines = [f"{NAMES[r['test']]}: {'overlap' if r['overlap'] else 'disjoint'}" for r in rows]
    panel.text(0.0, -0.24, "\n".join(lines), transform=panel.transAxes, va="top", fontsize=9)
    panel.set_xlim(-0.5, 3.1)
    panel.set_ylim(-0.5, 2.7)
    panel.set_aspect("equal")
    panel.set_xlabel("x / m")
    panel.set_ylabel("y / m")


def rates(panel, data, column, title, label):
    rows = data.rows("rates")
    names = [NAMES[row["test"]] for row in rows]
    values = [100 * row[column] for row in rows]
    panel.barh(names, values, color="#8aa0c8", edgecolor="black", linewidth=0.8, height=0.62)
    for name, value in zip(names, values):
        panel.text(value, name, f" {value:.3g} %", va="center", fontsize=8.5)
    panel.invert_yaxis()
    panel.grid(axis="y", visible=False)
    panel.set_xlim(0, 1.3 * max(values))
    panel.set_title(title)
    panel.set_xlabel(label)


def examples(data):
    rows = data.rows("pairs")
    return {name: pick(rows, example=name) for name in dict.fromkeys(row["example"] for row in rows)}
