"""Rallies by every method: passes, penetrating frames, the nudge, and the speed that 13.8 tells."""

import matplotlib.pyplot as plt
from matplotlib.ticker import NullLocator

import style
from data import pick


def draw(data, figures):
    rows = data.rows("methods")
    figure, ((passed, frames), (nudge, speeds)) = plt.subplots(2, 2, figsize=(10.6, 8.2))
    shown = [row for row in rows if row["reading"] != "prose"
             and not ("equal masses" in row["method"] and row["reading"])]
    intervals(passed, shown, "passed", 100, "strokes that pass through the ball / %")
    intervals(frames, shown, "frames", 1, "frames per stroke with the ball inside the bat")
    frames.set_yticklabels([])
    draw_nudge(nudge, rows)
    draw_speeds(speeds, data.rows("speeds"))
    passed.set_title("Passed")
    frames.set_title("Penetrating frames")
    nudge.set_title("The nudge of 7.4")
    speeds.set_title("The bat's speed as 13.8 tells it")
    figures.save(figure, "table-tennis", data.entry("caption"))


def intervals(panel, rows, column, factor, label):
    places = list(range(len(rows)))[::-1]
    for place, row in zip(places, rows):
        low, middle, high = (factor * row[column + end] for end in ("_low", "", "_high"))
        look = style.look(row["method"]) | {"linestyle": "none", "label": None}
        panel.plot([low, high], [place, place], color=look["color"], linewidth=1.6)
        panel.plot([middle], [place], **look)
    panel.set_yticks(places, [str(row["method"]) for row in rows])
    panel.set_xlim(left=-0.02 * panel.get_xlim()[1])
    panel.set_xlabel(label)


def draw_nudge(panel, rows):
    light = pick(rows, method="original, equal masses")[0]
    heavy = pick(rows, method="original")[0]
    for i, (nothing, reading, label) in enumerate((
            (light, "change", "equal masses, along v′ − v"),
            (light, "prose", "equal masses, along v′"),
            (heavy, "change", "heavy bat, along v′ − v"))):
        of_reading = [nothing] + pick(rows, bat=nothing["bat"], reading=reading)
        factors = [1000 * row["nudge"] for row in of_reading]
        panel.plot(factors, [row["frames"] for row in of_reading], color=style.COLOURS[i],
                   marker=style.MARKERS[i], linestyle=style.DASHES[i], markerfacecolor="white",
                   label=label)
    panel.axvline(2.5, **style.PREDICTION)
    panel.set_xlabel("factor of the nudge / ms")
    panel.set_ylabel("penetrating frames per stroke")
    panel.set_ylim(bottom=0)
    jumps = panel.twinx()
    of_reading = [heavy] + pick(rows, bat=heavy["bat"], reading="change")
    jumps.plot([1000 * row["nudge"] for row in of_reading],
               [100 * row["jumps"] for row in of_reading], color="#888888", linestyle=":",
               marker="*", label="hits that jump by > 4 cm, heavy bat")
    jumps.set_ylabel("visible jumps / % of hits")
    jumps.set_ylim(-2, 102)
    jumps.grid(False)
    jumps.spines["right"].set_visible(True)
    panel.text(2.9, 0.05, "0.0025", fontsize=8.5)
    handles = [axis.get_legend_handles_labels() for axis in (panel, jumps)]
    panel.legend(handles[0][0] + handles[1][0], handles[0][1] + handles[1][1],
                 loc="center right", fontsize=7.5)


def draw_speeds(panel, rows):
    rows = [row for row in rows if row["frames"] and row["truth"] is not None]
    # A logarithmic axis has no 0: what stands still is told left of it.
    still = [row for row in rows if row["truth"] <= 0.0]
    rows = [row for row in rows if row["truth"] > 0.0]
    for row in still:
        panel.errorbar(4e-3, row["told"], yerr=[[row["told"] - row["q1"]], [row["q3"] - row["told"]]],
                       color=style.COLOURS[0], marker="s", markerfacecolor="white", linestyle="none",
                       label="told of a bat that stands still")
    truth = [row["truth"] for row in rows]
    panel.fill_between(truth, [row["q1"] for row in rows], [row["q3"] for row in rows],
                       color=style.COLOURS[0], alpha=0.15, linewidth=0)
    panel.plot(truth, [row["told"] for row in rows], color=style.COLOURS[0], marker="o",
               markerfacecolor="white", label="told by 13.8 (median, quartiles)")
    panel.plot([1e-2, 10], [1e-2, 10], label="the truth", **style.PREDICTION)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_xlim(2.5e-3, 14)
    panel.set_xticks([4e-3, 1e-2, 1e-1, 1, 10], ["0", "0.01", "0.1", "1", "10"])
    panel.xaxis.set_minor_locator(NullLocator())
    panel.set_xlabel("true speed / (m/s)")
    panel.set_ylabel("speed told / (m/s)")
    panel.legend(loc="lower right")
