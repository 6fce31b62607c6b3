"""The hierarchy of the registered entities, as compiled."""

import matplotlib.pyplot as plt

from thesis import drawing

WIDTH, HEIGHT = 2.1, 0.7


def widths(children, name):
    """Leaves below a class: how much room it takes."""
    return max(1, sum(widths(children, child) for child in children.get(name, [])))


def place(children, name, left, depth, places):
    """Each class above the middle of those that inherit from it."""
    below = children.get(name, [])
    at = left
    for child in below:
        place(children, child, at, depth + 1, places)
        at += widths(children, child)
    middle = 0.5 * (places[below[0]][0] + places[below[-1]][0]) if below else left
    places[name] = (middle, depth)
    return places


def draw(data, figures):
    rows = data.rows("classes")
    children = {}
    for row in rows:
        children.setdefault(row["parent"], []).append(row["class"])
    names = {row["class"] for row in rows}
    root = next(row["parent"] for row in rows if row["parent"] not in names)
    places = place(children, root, 0.0, 0, {})
    kinds = {row["class"]: row["entity"] for row in rows}
    figure, panel = plt.subplots(figsize=(10.4, 3.6))
    position = {name: (2.4 * x, -1.5 * depth) for name, (x, depth) in places.items()}
    for name, (x, y) in position.items():
        text = name if name not in kinds else f"{name}\n({kinds[name]})"
        drawing.node(panel, x, y, text, WIDTH, HEIGHT,
                     drawing.FIRST if name not in kinds else "white", 8.5)
    for parent, below in children.items():
        x, y = position[parent]
        for child in below:
            u, v = position[child]
            middle = 0.5 * (y - HEIGHT / 2 + v + HEIGHT / 2)
            panel.plot([u, u, x, x], [v + HEIGHT / 2, middle, middle, y - HEIGHT / 2 - 0.14],
                       color="black", linewidth=1.0, zorder=1)
        panel.plot([x], [y - HEIGHT / 2 - 0.1], "^", color="black", markerfacecolor="white",
                   markersize=8, zorder=3)
    xs = [x for x, _ in position.values()]
    ys = [y for _, y in position.values()]
    drawing.bare(panel, min(xs) - 1.3, max(xs) + 1.3, min(ys) - 0.6, max(ys) + 0.6)
    figures.save(figure, "fig09", data.entry("caption"))
