"""Energy and apex heights over time, and the ledger's account of where the energy came from."""

import matplotlib.pyplot as plt

import style
from data import pick, points, unique

LINES = ["truncation", "late_impact", "restitution_loss", "position_correction", "field_work",
         "driven_work", "conveyor_and_hand", "roundoff", "unexplained"]
HATCHES = ["///", "...", "xxx", "\\\\\\", "ooo", "+++", "***", "--", "||"]


def draw(data, figures):
    over_time(data, figures)
    apexes(data, figures)
    ledger(data, figures)
    frame_times(data, figures)


def thinned(rows, count):
    return rows[:: max(1, len(rows) // count)]


def over_time(data, figures):
    rows = data.table("drift", "series")
    methods = unique(row["method"] for row in rows)
    figure = plt.figure(figsize=(10.6, 3.9))
    places = figure.add_gridspec(1, 2)
    growing = figure.add_subplot(places[0])
    close, roundoff = style.over_roundoff(figure, places[1], (1e-2, 1e2), (1e-16, 1e-11), 0.45)
    for method in methods:
        of_method = pick(rows, method=method)
        look = style.look(method, methods)
        look["markevery"] = max(1, len(of_method) // 12)
        growing.plot(*points(of_method, "t", "gain"), **look)
        t, gain = points(of_method, "t", "gain")
        for panel in (close, roundoff):
            panel.plot(t, [max(abs(value), 1e-16) for value in gain], **look)
    h, mass, force = (data_value(data, key) for key in ("frame", "mass", "G"))
    n = [row["frame"] for row in pick(rows, method=methods[0])]
    predicted = [max(0.0, (frame - 1) * force**2 * h**2 / (2 * mass)) for frame in n]
    times = [frame * h for frame in n]
    growing.plot(times, predicted, **style.PREDICTION, label="predicted: (n−1) G²h²/(2m)")
    close.plot(times[1:], predicted[1:], **style.PREDICTION)
    growing.set_title("Energy gained")
    growing.set_ylabel("energy gained / J")
    close.set_title("Its magnitude; below the break: roundoff")
    close.set_ylabel("|energy gained| / J")
    growing.set_xlabel("time / s")
    roundoff.set_xlabel("time / s")
    style.legend_below(figure, [growing], columns=4)
    figures.save(figure, "energy_over_time",
                 "Energy over time of an elastic ball (m = 1 kg) dropped on a floor, for each scheme "
                 "and integrator at the same frame time. Dotted: the closed-form prediction for the "
                 "original scheme.")


def data_value(data, name):
    """A constant of the experiment, from the derived columns of its first run."""
    row = data.table("drift", "runs")[0]
    return row[f"const_{name}"]


def apexes(data, figures):
    rows = data.table("drift", "apexes")
    methods = unique(row["method"] for row in rows)
    figure, panel = plt.subplots(figsize=(8.2, 3.8))
    for method in methods:
        of_method = pick(rows, method=method)
        look = style.look(method, methods)
        look["markevery"] = max(1, len(of_method) // 14)
        panel.plot(*points(of_method, "t", "height"), **look)
    panel.axhline(0.0, color="black", linewidth=0.8)
    panel.set_xlabel("time / s")
    panel.set_ylabel("height of the apex, centre of the ball / m")
    panel.set_title("How high the ball comes back")
    style.legend_below(figure, [panel], columns=4)
    figures.save(figure, "apex_heights",
                 "Height of each apex, the highest point between two impacts. An elastic ball should "
                 "come back to where it was dropped, each time. With symplectic Euler a ball that was "
                 "reflected is still inside in the next frame, is turned back in, and sinks through the "
                 "floor, whose top is the line at 0.")


def ledger(data, figures):
    """Bars on a linear axis; what is too small for a bar is told as a number beside it."""
    rows = [row for row in data.table("drift", "runs") if row["status"] == "completed"]
    methods = [row["method"] for row in rows]
    gains = [row["energy_gain"] for row in rows]
    widest = max([1e-3] + [abs(gain) for gain in gains])
    told = {line: [row.get(line) or 0.0 for row in rows] for line in LINES}
    drawn = [line for line in LINES if max(map(abs, told[line])) > 1e-3 * widest]
    figure, panel = plt.subplots(figsize=(9.4, 0.9 + 0.42 * len(methods)))
    positive = [0.0] * len(rows)
    negative = [0.0] * len(rows)
    for line in drawn:
        values = told[line]
        left = [positive[k] if v > 0 else negative[k] for k, v in enumerate(values)]
        panel.barh(methods, values, left=left, height=0.62, label=line.replace("_", " "),
                   color=style.COLOURS[(LINES.index(line) + 4) % len(style.COLOURS)],
                   edgecolor="white", hatch=HATCHES[LINES.index(line)], linewidth=0.4)
        positive = [p + max(v, 0.0) for p, v in zip(positive, values)]
        negative = [p + min(v, 0.0) for p, v in zip(negative, values)]
    panel.plot(gains, methods, "D", color="black", markerfacecolor="white", markersize=5,
               label="energy gained", zorder=6)
    for i, row in enumerate(rows):
        panel.text(1.32 * widest, i, f"{gains[i]:+.3g}", va="center", ha="right", fontsize=8.5)
        panel.text(1.75 * widest, i, f"{row.get('unexplained') or 0.0:+.1e}", va="center", ha="right",
                   fontsize=8.5)
    for x, text in ((1.32, "gained"), (1.75, "unexplained")):
        panel.text(x * widest, -0.72, text, ha="right", fontsize=8.5, fontweight="bold")
    panel.axvline(0.0, color="black", linewidth=0.8)
    panel.set_xlim(-1.1 * widest, 1.78 * widest)
    panel.set_xticks([tick for tick in panel.get_xticks() if abs(tick) <= 1.1 * widest])
    panel.invert_yaxis()
    panel.grid(axis="y", visible=False)
    panel.set_xlabel("energy into the ball / J")
    panel.set_title("Where the energy came from")
    style.legend_below(figure, [panel], columns=5)
    figures.save(figure, "energy_ledger",
                 "The ledger at the end of each run: every line has a formula of its own, and the "
                 "diamond is the energy that the ball gained. Lines below a thousandth of the largest "
                 "have no bar. What is left unexplained is at the level of roundoff.")


def frame_times(data, figures):
    rows = data.table("frame-time", "runs")
    methods = unique(row["method"] for row in rows)
    figure = plt.figure(figsize=(6.4, 4.2))
    panel, roundoff = style.over_roundoff(figure, figure.add_gridspec(1, 1)[0], (1.0, 300.0),
                                          (3e-16, 1e-11), 0.3)
    for method in methods:
        x, y = points(pick(rows, method=method), "frame", "energy_gain")
        look = style.look(method, methods)
        if max(y) < -1e-9:
            look["label"] += ": lost"
        for part in (panel, roundoff):
            part.plot(x, [max(abs(value), 1e-15) for value in y], **look)
    x, y = points(pick(rows, method=methods[0]), "frame", "predicted")
    panel.plot(x, y, **style.PREDICTION, label="predicted: (n−1) G²h²/(2m)")
    panel.set_xscale("log")
    roundoff.set_xlabel(data.label("frame-time", "frame"))
    panel.set_ylabel("energy gained, or lost / J")
    style.legend_below(figure, [panel], columns=3)
    figures.save(figure, "energy_by_frame_time", data.entry("caption:frame-time"))
