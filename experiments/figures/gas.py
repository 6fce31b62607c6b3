"""A gas of hard bodies against theory; how boxes share energy; what stepping schemes make of it."""

import matplotlib.pyplot as plt

import style
from data import pick, unique


def draw(data, figures):
    fluid(figures, data.rows("fluid"), data.rows("pairs"))
    shares(figures, data.rows("shares"))
    schemes(figures, data.rows("schemes"))
    times(figures, data.rows("timings"), data.rows("schemes"))


def ratio(panel, rows, measured, known, label, **look):
    """Measured over known, in per cent more, with error bars of two standard errors."""
    x = [r["fraction"] for r in rows]
    y = [100.0 * (r[measured] / r[known] - 1.0) for r in rows]
    bar = [200.0 * r[measured + "_error"] / r[known] for r in rows]
    panel.errorbar(x, y, yerr=bar, capsize=3, label=label, **look)


def fluid(figures, rows, pairs):
    figure, panels = plt.subplots(2, 2, figsize=(9.6, 6.2))
    known = [
        (panels[0][0], "pressure", (("carnahan_starling", "Carnahan, Starling", "o", 0.0),
                                    ("kolafa", "Kolafa", "s", 0.006)), 0.2, "Pressure"),
        (panels[0][1], "free_time", (("enskog_time", "Enskog, with Carnahan and Starling", "o", 0.0),
                                     ("enskog_time_kolafa", "Enskog, with Kolafa", "s", 0.006)), 0.5,
         "Mean free time"),
        (panels[1][0], "diffusion", (("enskog_diffusion", "Enskog", "o", 0.0),
                                     ("speedy", "Speedy", "s", 0.006),
                                     ("speedy_in_box", "Speedy, long in this box", "^", 0.012)), None,
         "Self-diffusion")]
    for panel, measured, against, within, title in known:
        panel.axhline(0.0, color="black", linewidth=0.8)
        if within:
            panel.axhspan(-within, within, color="#eeeeee", zorder=0)
        for (column, label, marker, aside), colour in zip(against, style.COLOURS):
            moved = [dict(r, fraction=r["fraction"] + aside) for r in rows]
            ratio(panel, moved, measured, column, label, marker=marker, linestyle="none", color=colour)
        panel.set_title(title)
        panel.set_xlabel("fraction of the volume")
        panel.set_ylabel("measured over known − 1 / %")
        panel.set_xlim(0.0, 0.5)
        panel.legend()
    for k, fraction in enumerate(unique(r["fraction"] for r in pairs)):
        of_one = pick(pairs, fraction=fraction)
        panels[1][1].plot([r["distance"] for r in of_one], [r["pair_distribution"] for r in of_one],
                          label=f"{fraction:g}", color=style.COLOURS[k], linestyle=style.DASHES[k])
    panels[1][1].set_title("Pairs against an ideal gas")
    panels[1][1].set_xlabel("distance / diameters")
    panels[1][1].set_ylabel("pair distribution")
    panels[1][1].legend(title="fraction")
    figures.save(figure, "fluid", f"Balls in a periodic box, {rows[0]['balls']:.0f} of them, against what is "
                 "known. Bars: two standard errors; grey: 0.2 % of the pressure, 0.5 % of the time.")


def shares(figures, rows):
    figure, panel = plt.subplots(figsize=(6.4, 3.6))
    columns = (("translation", "translation, an axis"), ("spin_x", "turning about x"),
               ("spin_y", "turning about y"), ("spin_z", "turning about z"))
    later = rows[len(rows) // 2:]
    means = []
    for k, (column, label) in enumerate(columns):
        panel.plot([r["impacts_a_box"] for r in rows], [r[column] for r in rows], label=label,
                   color=style.COLOURS[k], linestyle=style.DASHES[k])
        means.append(f"{label} {sum(r[column] for r in later) / len(later):.3f} J")
    panel.set_xlabel("impacts that a box has had")
    panel.set_ylabel("twice the energy of a way to move / J")
    panel.set_ylim(bottom=0.0)
    panel.legend()
    figures.save(figure, "shares", f"{rows[0]['boxes']:.0f} boxes of three unlike sides that start without "
                 "turning: each way to move gets the same energy. Means of the second half: "
                 + ", ".join(means) + ".")


def schemes(figures, rows):
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 3.8))
    names = [n for n in unique(str(r["scheme"]) for r in rows) if n != "event-driven"]
    for name in names:
        of_one = [r for r in pick(rows, scheme=name) if r["status"] == "completed"]
        x = [r["way"] for r in of_one]
        panels[0].plot(x, [r["energy_ratio"] for r in of_one], **style.look(name, names))
        panels[1].plot(x, [r["deepest"] for r in of_one], **style.look(name, names))
    exact = pick(rows, scheme="event-driven")[0]
    panels[0].axhline(exact["energy_ratio"], **style.PREDICTION, label="event-driven")
    panels[0].set_ylabel("energy at the end over that at the start")
    panels[1].set_ylabel("deepest penetration / radii")
    panels[1].set_yscale("symlog", linthresh=1e-3)
    panels[1].axhline(exact["deepest"], **style.PREDICTION, label="event-driven")
    for panel in panels:
        panel.set_xscale("log")
        panel.set_xlabel("way in a frame / radii")
    style.legend_below(figure, panels, columns=5)
    figures.save(figure, "schemes", f"One second of {exact['balls']:.0f} elastic balls between walls. The shorter "
                 "the frames, the more work; event-driven does not depend on them.")


def times(figures, timings, rows):
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 3.8))
    names = [n for n in unique(str(r["scheme"]) for r in rows) if n != "event-driven"]
    exact = pick(rows, scheme="event-driven")[0]
    whole = pick(timings, scheme="event-driven")[0]["seconds"]
    for name in names:
        of_one = [r for r in pick(rows, scheme=name) if r["status"] == "completed"]
        seconds = [pick(timings, scheme=name, way=r["way"])[0]["seconds"] / whole for r in of_one]
        panels[0].plot(seconds, [r["deepest"] for r in of_one], **style.look(name, names))
        panels[1].plot(seconds, [r["impacts"] / exact["impacts"] for r in of_one],
                       **style.look(name, names))
    panels[0].set_yscale("symlog", linthresh=1e-3)
    panels[0].set_ylabel("deepest penetration / radii")
    panels[1].set_ylabel("impacts over those of event-driven")
    for panel in panels:
        panel.axvline(1.0, **style.PREDICTION, label="event-driven")
        panel.set_xscale("log")
        panel.set_xlabel("time over that of event-driven")
    style.legend_below(figure, panels, columns=5)
    figures.save(figure, "timing-cost", "The same against the time that it takes, measured on the machine that made "
                 "this page. What looks again at a pair that still overlaps counts it again.")
