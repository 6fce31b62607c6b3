"""Error against counted work and against measured time, a panel per kind of error; failures are
drawn as failures, above the frame."""

import math
import os

import matplotlib.pyplot as plt

import style

PANELS = [("position_error", "front_position", "position at the end / m"),
          ("event_time_error", "front_event_time", "worst time of an impact / s"),
          ("penetration", "front_penetration", "deepest penetration / m"),
          ("energy_error", "front_energy", "largest energy error, relative")]
FLOOR = 1e-17  # an error of 0 is drawn here


def draw(data, figures):
    times = data.rows("timings") if os.path.exists(os.path.join(data.folder, "timings.csv")) else []
    for reference in data.rows("references"):
        scene = str(reference["scene"])
        rows = data.rows(f"{scene}_methods")
        by_work(figures, scene, rows, reference)
        by_time(figures, scene, rows, [t for t in times if t["scene"] == scene])


def by_work(figures, scene, rows, reference):
    figure, panels = plt.subplots(2, 2, figsize=(9.6, 6.6), sharex=True)
    schemes = [name for name in style.ORDER if any(r["scheme"] == name for r in rows)]
    for panel, (error, front, label) in zip(panels.flat, PANELS):
        scatter(panel, rows, schemes, "work", error)
        best = sorted((r["work"], max(r[error], FLOOR)) for r in rows if r[front] == 1)
        panel.step([w for w, _ in best], [e for _, e in best], where="post", color="black",
                   linewidth=0.9, linestyle=":", label="front: nothing cheaper is better")
        if error == "position_error" and reference["position_uncertainty"]:
            panel.axhline(reference["position_uncertainty"], color="#888888", linewidth=0.8)
        panel.set_title(label.split(" / ")[0].split(",")[0])
        panel.set_ylabel(label)
        label_zero(panel, [row[error] for row in rows])
    for panel in panels[1]:
        panel.set_xlabel("counted work: right-hand sides, overlap tests, gap evaluations")
    style.legend_below(figure, panels.flat, columns=4)
    figures.save(figure, f"{scene}-work", f"{scene}: {reference['compared']}. Reference: "
                 f"{reference['reference']}. Marks on the upper edge: refused, stopped or too long; of a "
                 "scheme: it missed the impact.")


def label_zero(panel, errors):
    """What is drawn at FLOOR is 0: the axis says so, the panel if there is nothing else."""
    errors = [error for error in errors if error is not None]
    if not any(error <= FLOOR for error in errors):
        return
    panel.axhline(FLOOR, color="#888888", linewidth=0.8, linestyle=":")
    if max(errors) <= FLOOR:
        panel.set_ylim(FLOOR / 10, FLOOR * 10)
        panel.set_yticks([FLOOR], ["0"])
        panel.text(0.5, 0.7, "0 for every method", transform=panel.transAxes, ha="center")
    else:
        panel.set_ylim(bottom=FLOOR / 3)
        ticks = [tick for tick in panel.get_yticks() if 10 * FLOOR <= tick <= panel.get_ylim()[1]]
        panel.set_yticks([FLOOR] + ticks, ["0"] + [f"$10^{{{math.log10(t):.0f}}}$" for t in ticks])
    panel.minorticks_off()


def by_time(figures, scene, rows, times):
    if not times:
        return
    seconds = {t["method"]: t for t in times}
    timed = [dict(r, seconds=seconds[r["method"]]["seconds"], slowest=seconds[r["method"]]["slowest"])
             for r in rows if r["method"] in seconds]
    figure, panel = plt.subplots(figsize=(6.4, 3.9))
    schemes = [name for name in style.ORDER if any(r["scheme"] == name for r in rows)]
    scatter(panel, timed, schemes, "seconds", "position_error")
    for row in timed:
        if row["position_error"] is not None:
            panel.plot([row["seconds"], row["slowest"]], [max(row["position_error"], FLOOR)] * 2,
                       color="#999999", linewidth=0.7, zorder=1)
    panel.set_xlabel("least seconds of several rounds, in turn; the line ends at the slowest")
    panel.set_ylabel("position at the end / m")
    style.legend_below(figure, [panel], columns=3)
    figures.save(figure, f"timing-{scene}", f"{scene}: the same against measured time, which differs "
                 "from run to run.")


def scatter(panel, rows, schemes, x, error):
    for scheme in schemes:
        look = style.look(scheme, schemes)
        look.update(linestyle="none", alpha=0.9)
        good = [r for r in rows if r["scheme"] == scheme and r[error] is not None and r[x]]
        panel.plot([r[x] for r in good], [max(r[error], FLOOR) for r in good], **look)
        # Without an impact there is no error of its time.
        none = [r for r in rows if r["scheme"] == scheme and r["status"] == "completed" and
                r[error] is None]
        if none:
            panel.plot([r[x] for r in none], [0.985] * len(none), **look | {"label": None},
                       transform=panel.get_xaxis_transform(), clip_on=False)
    panel.set_xscale("log")
    panel.set_yscale("log")
    failed = [r for r in rows if r["status"] != "completed"]
    if failed:
        panel.plot([max(r[x] or 1, 1) for r in failed], [0.985] * len(failed), "x", color="#BB3333",
                   transform=panel.get_xaxis_transform(), clip_on=False,
                   label="failed: refused, stopped, too long")
