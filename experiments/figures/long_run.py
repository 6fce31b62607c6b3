"""Energy of a spring over very many periods."""

import math

import matplotlib.pyplot as plt

import style
from data import pick, unique

# Stability functions: coefficients of the powers of z.
RK4 = [1, 1, 1 / 2, 1 / 6, 1 / 24]
DOPRI5 = RK4 + [1 / 120, 1 / 600]


def draw(data, figures):
    rows = data.table("spring", "series")
    runs = data.table("spring", "runs")
    methods = unique(row["method"] for row in rows)
    start = next(row["kinetic"] + row["potential"] for row in rows if row["t"] == 0.0)
    figure, panel = plt.subplots(figsize=(7.6, 4.6))
    for i, method in enumerate(methods):
        times, drift = envelope(pick(rows, method=method), start)
        look = style.look(method, methods) | {"marker": "", "linestyle": style.DASHES[i % 8]}
        status = pick(runs, method=method)[0]["status"]
        look["label"] = method if status == "completed" else f"{method} (leaves the numbers)"
        panel.plot(times, drift, **look)
    done = pick(runs, method="rk4")[0]
    predict(panel, rows, (done["frames"] - 1) / done["end_time"])
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_ylim(1e-7, 1e3)
    panel.set_xlabel("time / periods")
    panel.set_ylabel("largest |E/E₀ − 1| so far")
    panel.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    figures.save(figure, "long_run", data.entry("caption:spring"))


def envelope(rows, start):
    times, drift, largest = [], [], 0.0
    for row in rows:
        if row["gain"] is None:
            break
        largest = max(largest, abs(row["gain"]) / start)
        if row["t"] > 0.0 and largest > 0.0:
            times.append(row["t"])
            drift.append(largest)
    return times, drift


def predict(panel, rows, steps):
    """|R(ix)|^2 of the stability functions, x the step times the spring's rate; `steps`: in a
    period."""
    x = 2.0 * math.pi / steps
    times = sorted({row["t"] for row in rows if row["t"] > 0.0})
    for taylor, label in ((RK4, "predictions, rk4 and dopri5"), (DOPRI5, "_dopri5")):
        growth = abs(sum(c * (1j * x) ** k for k, c in enumerate(taylor))) ** 2
        panel.plot(times, [-math.expm1(steps * t * math.log(growth)) for t in times],
                   **(style.PREDICTION | {"label": label}))
