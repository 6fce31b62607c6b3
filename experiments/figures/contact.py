"""What the schemes that people use do with contact that lasts: sinking, drift, energy, order."""

import matplotlib.pyplot as plt

import style
from data import pick, points, unique

PANELS = {
    "stack": (("max_penetration", "deepest overlap / m", "Sinking"),
              ("drift", "top box from its place / m", "Drift"),
              ("energy_error", "|energy error| / energy", "Energy")),
    "incline": (("distance_error", "error of the distance / m", "Sliding 2 m"),
                ("max_penetration", "deepest overlap / m", "Sinking"),
                ("friction_error", "error of the work / J", "Work of friction")),
    "dominoes": (("end_x", "tenth domino at the end, x / m", "Where the tenth one is"),
                 ("max_penetration", "deepest overlap / m", "Sinking")),
}
LINEAR = ("end_x",)
LEAST = 1e-13  # below this it is roundoff: drawn there


def draw(data, figures):
    for sweep in data.sweeps():
        draw_sweep(data, figures, sweep)


def draw_sweep(data, figures, sweep):
    rows = data.table(sweep, "runs")
    methods = unique(row["method"] for row in rows)
    # Where a run stopped nothing is known of its end.
    rows = [row for row in rows if row["status"] == "completed"]
    x = data.axes(sweep)[0]
    told = PANELS[sweep]
    figure, panels = plt.subplots(1, len(told), figsize=(1.0 + 3.6 * len(told), 3.8))
    for panel, (metric, label, title) in zip(panels, told):
        for place, method in enumerate(methods):
            done = pick(rows, method=method)
            if not done:
                continue
            at, value = points(done, x, metric)
            if metric not in LINEAR:
                value = [max(abs(v), LEAST) for v in value]
            panel.plot(at, value, **style.by_place(place, method))
        if metric == "distance_error":
            slopes(panel, rows, x, metric)
        panel.set_xscale("log")
        panel.set_yscale("linear" if metric in LINEAR else "log")
        panel.set_xlabel(data.label(sweep, x))
        panel.set_ylabel(label)
        panel.set_title(title)
    style.legend_below(figure, panels[:1])
    figures.save(figure, f"contact_{sweep}", data.entry(f"caption:{sweep}"))


def slopes(panel, rows, x, metric):
    """Slopes 1 and 2 through the largest error at the largest step."""
    steps = sorted({row[x] for row in rows})
    worst = max(row[metric] for row in rows if row[x] == steps[-1])
    for order in (1, 2):
        y = [2.0 * worst * (step / steps[-1]) ** order for step in steps]
        panel.plot(steps, y, color="#999999", linewidth=0.8, linestyle=":")
        panel.annotate(f"h{'¹²'[order - 1]}", (steps[0], y[0]), fontsize=8, color="#666666",
                       textcoords="offset points", xytext=(-2, 3))
