"""Rendered frames on one sheet: the original scheme left, event-driven right of it."""

import os
import textwrap

import matplotlib.image
import matplotlib.pyplot as plt


def draw(data, figures):
    rows = data.rows("frames")
    columns = 1 if len(rows) < 4 else 2
    lines = -(-len(rows) // columns)
    pictures = [matplotlib.image.imread(os.path.join(data.folder, f"frame-{row['frame']:.0f}.png"))
                for row in rows]
    height, width = pictures[0].shape[:2]
    across = 10.6 / columns
    figure, panels = plt.subplots(lines, columns, squeeze=False,
                                  figsize=(10.6, lines * (across * height / width + 0.55)))
    for panel in panels.flat:
        panel.set_axis_off()
    for panel, row, picture in zip(panels.flat, rows, pictures):
        panel.imshow(picture)
        text = textwrap.fill(f"{row['frame']:.0f}. {row['caption']}", 112 // columns)
        panel.set_title(text, fontsize=9 if columns == 1 else 8, fontweight="normal")
    figures.save(figure, str(data.entry("name")), data.entry("caption"))
