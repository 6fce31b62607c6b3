"""Energy of a spring over very many periods."""

import math

import matplotlib.pyplot as plt

import style
from data import pick, unique


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
    panel.set_ylim(1e-16, 1e3)
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
    """|R(ix)|^2 = 1 - x^6/72 + x^8/576 of Runge-Kutta 4, x the step times the spring's rate;
    `steps`: in a period."""
    x = 2.0 * math.pi / steps
    per_step = math.log1p(-x ** 6 / 72.0 + x ** 8 / 576.0)
    times = sorted({row["t"] for row in rows if row["t"] > 0.0})
    panel.plot(times, [-math.expm1(steps * t * per_step) for t in times],
               **(style.PREDICTION | {"label": "prediction, rk4"}))
