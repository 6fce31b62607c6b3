"""Energy of a spring over very many periods."""

import math

import matplotlib.pyplot as plt

import style
from data import pick, unique

FAR_OUT = 1e9  # above the panel

# Stability functions: coefficients of the powers of z.
EULER = [1, 1]
RK4 = [1, 1, 1 / 2, 1 / 6, 1 / 24]
DOPRI5 = RK4 + [1 / 120, 1 / 600]


def draw(data, figures):
    sweeps = ("start", "spring")  # the first periods, closely; then very many
    series = {sweep: data.table(sweep, "series") for sweep in sweeps}
    runs = data.table("spring", "runs")
    methods = unique(row["method"] for row in series["spring"])
    energy = next(row["kinetic"] + row["potential"] for row in series["start"] if row["t"] == 0.0)
    figure, panel = plt.subplots(figsize=(8.6, 5.0))
    for method in methods:
        rows = sorted((row for sweep in sweeps for row in pick(series[sweep], method=method)),
                      key=lambda row: row["t"])
        times, drift = envelope(rows, energy)
        look = style.look(method, methods) | {"markevery": 0.09}
        status = pick(runs, method=method)[0]["status"]
        look["label"] = method if status == "completed" else f"{method} (leaves the numbers)"
        panel.plot(times, drift, **look)
    done = pick(runs, method="rk4")[0]
    predict(panel, done["end_time"], (done["frames"] - 1) / done["end_time"])
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_xlim(1.0, done["end_time"])
    panel.set_ylim(1e-6, 1e2)
    panel.set_xlabel("time / periods")
    panel.set_ylabel("largest |E/E₀ − 1| so far")
    panel.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=9.5)
    figures.save(figure, "long_run", data.entry("caption:spring"))


def envelope(rows, start):
    times, drift, largest = [], [], 0.0
    for row in rows:
        if row["gain"] is None or largest > FAR_OUT:
            break
        largest = max(largest, abs(row["gain"]) / start)
        if row["t"] > 0.0 and largest > 0.0:
            times.append(row["t"])
            drift.append(largest)
    return times, drift


def predict(panel, end, steps):
    """|R(ix)|^2 of the stability functions, x the step times the spring's rate; `steps`: in a
    period, until `end` periods."""
    x = 2.0 * math.pi / steps
    times = [end ** (k / 200.0) for k in range(201)]
    for taylor, label in ((RK4, "predictions: explicit Euler,\nrk4, dopri5"), (DOPRI5, "_dopri5"),
                          (EULER, "_euler")):
        rate = steps * math.log(abs(sum(c * (1j * x) ** k for k, c in enumerate(taylor))) ** 2)
        drawn = [t for t in times if rate * t < 20.0]
        panel.plot(drawn, [abs(math.expm1(rate * t)) for t in drawn],
                   **(style.PREDICTION | {"label": label}))
