"""How deep, how long, and how often right through: against speed, frame time and thickness."""

import matplotlib.pyplot as plt

import style
import through
from data import pick, points


def draw(data, figures):
    for sweep in data.sweeps():
        draw_sweep(data, figures, sweep)


def draw_sweep(data, figures, sweep):
    rows = data.table(sweep, "summary")
    x = data.axes(sweep)[0]
    figure, panels = plt.subplots(1, 3, figsize=(10.6, 3.4))
    through.fraction(panels[0], rows, x, "tunnelled", "Went through")
    panels[0].plot(*points(pick(rows, method="original"), x, "predicted.mean"), **style.PREDICTION,
                   label="predicted: max(0, 1 − (w+2r)/(v h))")
    through.drawn_depth(panels[1], rows, x, "tunnelled")
    through.drawn_time(panels[2], rows, x, "tunnelled")
    for panel in panels:
        panel.set_xscale(data.column(sweep, x)["scale"])
        panel.set_xlabel(data.label(sweep, x))
    style.legend_below(figure, panels[:1], columns=4)
    figures.save(figure, sweep, data.entry(f"caption:{sweep}"))
