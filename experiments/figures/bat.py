"""A bat swung at a resting ball: passes through, overlaps; from rest, and from full swing."""

import matplotlib.pyplot as plt

import style
import through


def draw(data, figures):
    from_rest(data, figures)
    full_swing(data, figures)


def from_rest(data, figures):
    rows = data.table("from-rest", "summary")
    figure, panels = plt.subplots(1, 3, figsize=(10.6, 3.4))
    through.fraction(panels[0], rows, "frequency", "passed", "Passed, started at rest")
    through.drawn_depth(panels[1], rows, "frequency", "passed")
    through.drawn_time(panels[2], rows, "frequency", "passed")
    finish(data, figure, panels, "from-rest")
    figures.save(figure, "bat", data.entry("caption:from-rest"))


def full_swing(data, figures):
    rows = data.table("full-swing", "summary")
    figure, panel = plt.subplots(figsize=(5.4, 3.4))
    through.fraction(panel, rows, "frequency", "passed", "Passed, started in full swing")
    finish(data, figure, [panel], "full-swing")
    figures.save(figure, "bat-full-swing", data.entry("caption:full-swing"))


def finish(data, figure, panels, sweep):
    for panel in panels:
        panel.set_xscale("log", base=2)
        panel.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
        panel.set_xlabel(data.label(sweep, "frequency"))
    style.legend_below(figure, panels[:1], columns=3 if len(panels) == 1 else 6)
