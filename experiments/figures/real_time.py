"""Time of a frame against bodies; depth and energy against late frames."""

import matplotlib.pyplot as plt

import style
from data import pick, unique


def draw(data, figures):
    frames_against_bodies(figures, data.rows("timings"))
    late_frames(figures, data.rows("stalls"))


def names(rows):
    return unique(str(r["method"]) for r in rows)


def look_of(name, methods):
    return style.look(name, methods)


def frames_against_bodies(figures, rows):
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 3.6), sharey=True)
    for method in names(rows):
        of_method = pick(rows, method=method)
        look = look_of(method, names(rows))
        for panel, column in zip(panels, ("median_frame", "worst_frame")):
            panel.plot([r["bodies"] for r in of_method], [1e3 * r[column] for r in of_method], **look)
    for panel, title in zip(panels, ("The median frame", "The worst frame")):
        panel.axhline(1e3 / 60.0, color="black", linewidth=0.9, linestyle=":", label="1/60 s")
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_title(title)
        panel.set_xlabel("balls")
    panels[0].set_ylabel("work for a frame / ms")
    style.legend_below(figure, panels, columns=4)
    figures.save(figure, "timing-frames", "Time that a frame takes, one second of a gas at 60 Hz: measured "
                 "on the machine that made this page.")


def late_frames(figures, rows):
    scenes = unique(str(r["scene"]) for r in rows)
    settings = unique(str(r["frames"]) for r in rows)
    figure, panels = plt.subplots(len(scenes), 2, figsize=(9.6, 5.6), sharex=True)
    for line, scene in zip(panels, scenes):
        for panel, column, label in zip(line, ("max_penetration", "energy_error"),
                                        ("deepest penetration / m", "energy error, relative")):
            for method in names(rows):
                values = [pick(rows, scene=scene, method=method, frames=s)[0][column] for s in settings]
                panel.plot(range(len(settings)), values, **look_of(method, names(rows)))
            panel.set_ylabel(label)
            panel.set_title(scene)
            panel.set_yscale("symlog", linthresh=0.02)  # below, linear down to 0
            panel.set_xticks(range(len(settings)), settings, fontsize=7)
    style.legend_below(figure, panels.flat, columns=4)
    figures.save(figure, "stalls", "What schemes do when frames come late: the worst of several runs.")
