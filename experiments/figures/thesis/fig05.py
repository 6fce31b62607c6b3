"""A ball in a box and a box in a ball, in the plane and in space."""

import matplotlib.pyplot as plt

from thesis import drawing


def draw(data, figures):
    fits = data.rows("fits")
    figure, panels = plt.subplots(2, 2, figsize=(7.4, 7.2), sharex=True, sharey=True)
    for panel, row in zip(panels.flat, fits):
        half = row["half_side"]
        square = (-half, -half, 2 * half, 2 * half)
        if row["body"] == "ball":
            drawing.rectangle(panel, *square, fill="white", line="--")
            drawing.ball(panel, 0, 0, row["radius"], drawing.FIRST)
        else:
            drawing.ball(panel, 0, 0, row["radius"], "white", "--")
            drawing.rectangle(panel, *square, fill=drawing.SECOND, zorder=3)
        plane = row["dimensions"] == 2
        unit = "r²" if plane else "r³"
        name = {"ball": "circle" if plane else "ball", "box": "square" if plane else "cube"}
        bound = {"ball": "circle" if plane else "ball", "box": "square" if plane else "box"}
        panel.set_title(f"{name[row['body']]} in a {bound[row['bound']]}: {row['ratio']:.3f} times")
        panel.text(0.5, 0.03, f"{row['content']:.3f} {unit} in {row['bound_content']:.3f} {unit}"
                   f"  (by points: {row['sampled']:.3f})", transform=panel.transAxes, ha="center",
                   fontsize=8.5)
        panel.set_xlim(-1.6, 1.6)
        panel.set_ylim(-1.75, 1.5)
        panel.set_aspect("equal")
    for panel in panels[1]:
        panel.set_xlabel("x / r" )
    for panel in panels[:, 0]:
        panel.set_ylabel("y / r")
    figures.save(figure, "fig05", data.entry("caption"))
