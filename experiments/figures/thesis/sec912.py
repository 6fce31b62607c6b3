"""9.1.2, gaining energy: heights of successive bounces and energy over time for every scheme and
integrator, and what each of the causes contributes."""

import math

import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap

import style
from data import pick, points, unique

SHOWN = [("original", "thesis-euler"), ("original", "symplectic-euler"),
         ("original", "velocity-verlet"), ("bisected", "thesis-euler"),
         ("event-driven", "thesis-euler"), ("event-driven", "closed-form")]


def draw(data, figures):
    over_time(data, figures)
    every_combination(data, figures)
    causes(data, figures)


def over_time(data, figures):
    figure, (heights, energy) = plt.subplots(1, 2, figsize=(10.4, 4.3))
    names = [f"{scheme}, {integrator}" for scheme, integrator in SHOWN]
    for (scheme, integrator), name in zip(SHOWN, names):
        look = style.look(name, names)
        rows = pick(data.rows("heights"), scheme=scheme, integrator=integrator)
        look["markevery"] = max(1, len(rows) // 9)
        heights.plot(*points(rows, "t", "height"), **look)
        rows = pick(data.rows("energy"), scheme=scheme, integrator=integrator)
        look["markevery"] = max(1, len(rows) // 9)
        energy.plot(*points(rows, "t", "gain"), **look)
    end = data.value("duration")
    energy.plot([0, end], [0, data.value("per_second") * end], **style.PREDICTION,
                label="predicted: G²h²/(2m) a frame")
    heights.axhline(0.0, color="black", linewidth=0.8)
    heights.annotate("top of the floor", (end, 0.0), fontsize=8, ha="right", va="bottom",
                     textcoords="offset points", xytext=(0, 2))
    heights.set_xlabel("time / s")
    heights.set_ylabel("height of the apex, centre of the ball / m")
    heights.set_title("How high the ball comes back")
    energy.set_xlabel("time / s")
    energy.set_ylabel("energy gained / J")
    energy.set_title("Energy over time")
    style.legend_below(figure, [energy], columns=3)
    figures.save(figure, "heights",
                 "Heights of successive bounces and energy over time. The integrator decides: the "
                 "thesis' own gains the same under every scheme, also where impacts are located "
                 "exactly; one of order 2 or more gains nothing under any. With symplectic Euler the "
                 "ball is turned back into the floor and sinks through it.")


def shade(gain, start):
    """0: roundoff, 1: small, 2: large, relative to the energy at the start."""
    size = abs(gain) / start
    return 0 if size < 1e-9 else 1 if size < 1e-2 else 2


def every_combination(data, figures):
    rows = data.rows("methods")
    schemes = unique(row["scheme"] for row in rows if row["gain"] is not None)
    integrators = unique(row["integrator"] for row in rows)
    figure, panel = plt.subplots(figsize=(7.6, 8.2))
    cells = []
    for y, integrator in enumerate(integrators):
        line = []
        for x, scheme in enumerate(schemes):
            row = pick(rows, scheme=scheme, integrator=integrator)[0]
            if row["gain"] is None:
                line.append(math.nan)
                text = row["status"]
            else:
                line.append(shade(row["gain"], row["gain"] / row["relative"]
                                  if row["relative"] else 1.0))
                text = "0" if row["gain"] == 0 else f"{row['gain']:+.1e}"
            panel.text(x, y, text, ha="center", va="center", fontsize=8,
                       color="white" if line[-1] == 2 else "black")
        cells.append(line)
    colours = ListedColormap(["#ffffff", "#cfd8e8", "#33508a"])
    colours.set_bad("#f3e6cc")
    panel.imshow(cells, cmap=colours, vmin=0, vmax=2, aspect="auto")
    panel.set_xticks(range(len(schemes)), schemes)
    panel.set_yticks(range(len(integrators)), integrators)
    panel.xaxis.tick_top()
    panel.set_xticks([x - 0.5 for x in range(1, len(schemes))], minor=True)
    panel.set_yticks([y - 0.5 for y in range(1, len(integrators))], minor=True)
    panel.grid(visible=False)
    panel.grid(which="minor", color="#999999", linewidth=0.6)
    panel.tick_params(length=0, which="both")
    for side in ("top", "right", "left", "bottom"):
        panel.spines[side].set_visible(True)
    figures.save(figure, "combinations",
                 f"Energy gained in {data.value('duration'):g} s, J, by every scheme (across) with "
                 "every integrator (down), from an initial energy of 49 J. White: below 1e-9 of it; "
                 "pale: below 1e-2; dark: more; sand: refused. The schemes that step over "
                 "contacts have integrators of their own.")


def causes(data, figures):
    figure, (left, line) = plt.subplots(1, 2, figsize=(10.4, 3.4),
                                        gridspec_kw={"width_ratios": [1, 1.1]})
    named = [("energy gained", data.value("gain")), ("predicted", data.value("predicted")),
             ("ledger: truncation", data.value("truncation")),
             ("roundoff (long double)", data.value("roundoff")),
             ("roundoff (ledger)", abs(data.value("ledger_roundoff"))),
             ("impacts", data.value("impact_energy"))]
    largest = max(value for _, value in named)
    for i, (name, value) in enumerate(named):
        guess = name.startswith(("roundoff", "impacts"))
        left.barh([i], [value], height=0.62, edgecolor="black", linewidth=0.8, color="#8aa0c8")
        text = "exactly 0 J" if value == 0 else f"{value:.4g} J"
        left.text(value + 0.02 * largest, i, text, va="center", fontsize=8.5,
                  fontweight="bold" if guess else "normal")
    left.set_yticks(range(len(named)), [name for name, _ in named])
    left.invert_yaxis()
    left.grid(axis="y", visible=False)
    left.set_xlim(0, 1.3 * largest)
    left.set_xlabel("energy / J")
    left.set_title("The thesis' two guesses (bold)")
    rows = data.rows("precision")
    line.plot([row["t"] for row in rows], [row["difference"] for row in rows], color="black",
              linewidth=1.0)
    line.set_xlabel("time / s")
    line.set_ylabel("energy, double − long double / J")
    line.set_title("Roundoff's true share")
    figures.save(figure, "causes",
                 "Left: what each cause contributes to the energy gained; the guessed ones are too "
                 "small to be seen as bars. Right: the same arithmetic in double and in long double; "
                 "the difference is roundoff, all of it.")
