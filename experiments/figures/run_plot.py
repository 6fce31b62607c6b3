"""Runs over time: height, gap, speed and energy ledger, with events; several beside each other.

usage: python3 run_plot.py OUT.png|OUT.svg|OUT.pdf [--bodies A,B] RUN [RUN...]

A RUN is a folder that `kairos run --out` wrote. `kairos plot` calls this; the Python package draws
runs in memory by the same functions: `figure_of` takes `DrawnRun`s, from `read_run` or elsewhere.
"""

import csv
import dataclasses
import json
import os
import sys

import matplotlib
import numpy as np

import style
from methods import COLOURS, DASHES
from run_instants import with_events

MOST_BODIES = 6     # that are drawn where nobody says which
MOST_RUNS = 6       # beside each other: more are too narrow to read
INVISIBLE = 1e-3    # of the largest line of a ledger: what is less lies on the axis
RUG_ABOVE = 60      # more events than this are ticks at the foot, not lines over the panel


@dataclasses.dataclass
class DrawnRun:
    """A run as it is drawn. Arrays as of kairos.Run: (frames, bodies, 3), quaternions w first."""

    title: str
    scheme: str
    scene: str
    bodies: list        # of each: name, shape, moves, field, bounds, half_extents or normal
    times: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    orientation: np.ndarray
    ledger: dict        # columns of energy.csv
    events: dict        # t, kind, a, b, gap; a_before_position, ... (events, 3)


def read_run(folder, label=None):
    """Reads the files of a run. What is missing or cut off ends with a message that names it."""
    try:
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        ledger = _columns(os.path.join(folder, "energy.csv"))
        events = _columns(os.path.join(folder, "events.csv"))
        rows = _columns(os.path.join(folder, "trajectory.csv"))
    except (OSError, ValueError) as error:
        raise SystemExit(f"{folder}: is no folder that kairos run --out wrote: {error}")
    bodies = [_body(name, entry) for name, entry in summary["bodies"].items()]
    frames = len(rows["t"]) // len(bodies)

    def of(prefix, axes="xyz"):
        return np.stack([rows[prefix + axis] for axis in axes], 1).reshape(frames, len(bodies), -1)

    scene, scheme = summary["scene"]["name"], summary["method"]["scheme"]
    return DrawnRun(label or f"{scene}, {scheme}", scheme, scene, bodies, rows["t"][::len(bodies)],
                    of("p"), of("v"), of("q", "wxyz"), ledger,
                    _vectors(events))


def event_columns():
    """Names of the vectors of an event that are drawn."""
    return [f"{side}_{when}_{what}" for side in "ab" for when in ("before", "after")
            for what in ("position", "velocity")]


def _vectors(events):
    found = {name: events[name] for name in ("t", "kind", "a", "b", "gap")}
    for name in event_columns():
        stem, what = name.rsplit("_", 1)
        found[name] = np.stack([events[f"{stem}_{what[0]}{axis}"] for axis in "xyz"], axis=-1)
    return found


def _columns(path):
    """Columns of a table: floats, an empty cell nan, or text."""
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.reader(file)
        names = next(reader)
        texts = list(zip(*reader)) or [()] * len(names)
    return {name: _numbers(column) for name, column in zip(names, texts)}


def _numbers(texts):
    try:
        return np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return np.array(texts, dtype=str)


def _body(name, entry):
    size = [entry[k] for k in (("hx", "hy", "hz") if "hx" in entry else ("nx", "ny", "nz"))]
    return {"name": name, "shape": entry["shape"], "moves": entry["moves"], "field": entry["field"],
            "bounds": entry["bounds"], ("half_extents" if "hx" in entry else "normal"): np.array(size)}


# Gaps -------------------------------------------------------------------------------------------

def _turned(q, v):
    """v turned by unit quaternions (..., 4), w first."""
    w, u = q[..., :1], q[..., 1:]
    t = 2 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def _axes(q):
    """Axes of a body in the world, (frames, 3 axes, 3)."""
    return np.stack([_turned(q, np.broadcast_to(e, q.shape[:-1] + (3,))) for e in np.eye(3)], -2)


def _is_box(body):
    return body["shape"] == "box" or (body["shape"] == "sphere" and body["bounds"] == "obb")


def _gap_to_plane(body, p, q, plane, p_plane, q_plane):
    normal = _turned(q_plane, np.broadcast_to(plane["normal"], p.shape))
    reach = body["half_extents"][0] if not _is_box(body) else np.einsum(
        "fa,a->f", np.abs(np.einsum("fax,fx->fa", _axes(q), normal)), body["half_extents"])
    return np.einsum("fx,fx->f", normal, p - p_plane) - reach


def _gap_to_box(ball, p, box, p_box, q_box):
    c = np.einsum("fax,fx->fa", _axes(q_box), p - p_box)
    beyond = np.abs(c) - box["half_extents"]
    outside = np.linalg.norm(np.maximum(beyond, 0), axis=1)
    return np.where(outside > 0, outside, beyond.max(axis=1)) - ball["half_extents"][0]


def _gap_of_boxes(a, p_a, q_a, b, p_b, q_b):
    """The greatest of the 15 separations: the gap where faces meet, less where edges are near."""
    axes_a, axes_b, d = _axes(q_a), _axes(q_b), p_b - p_a
    cross = np.cross(axes_a[:, :, None, :], axes_b[:, None, :, :]).reshape(len(d), 9, 3)
    n = np.concatenate([axes_a, axes_b, cross], axis=1)
    length = np.linalg.norm(n, axis=2)
    n = n / np.maximum(length, 1e-300)[..., None]
    reach = sum(np.einsum("fna,a->fn", np.abs(np.einsum("fax,fnx->fna", axes, n)), body["half_extents"])
                for axes, body in ((axes_a, a), (axes_b, b)))
    separation = np.abs(np.einsum("fnx,fx->fn", n, d)) - reach
    return np.where(length > 1e-6, separation, -np.inf).max(axis=1)  # parallel edges say nothing


def _is_known(body):
    return body["shape"] in ("sphere", "box", "half-space")


def gap_of(run, i, j):
    """Gap of bodies i and j in each frame, m; negative: penetration. None: two planes, or a shape
    whose gap is not drawn."""
    a, b = run.bodies[i], run.bodies[j]
    if not _is_known(a) or not _is_known(b):
        return None
    (p_a, q_a), (p_b, q_b) = ((run.position[:, k], run.orientation[:, k]) for k in (i, j))
    if a["shape"] == "half-space":
        return None if b["shape"] == "half-space" else gap_of(run, j, i)
    if b["shape"] == "half-space":
        return _gap_to_plane(a, p_a, q_a, b, p_b, q_b)
    if _is_box(a) and _is_box(b):
        return _gap_of_boxes(a, p_a, q_a, b, p_b, q_b)
    if _is_box(a):
        return gap_of(run, j, i)
    if _is_box(b):
        return _gap_to_box(a, p_a, b, p_b, q_b)
    return np.linalg.norm(p_b - p_a, axis=1) - a["half_extents"][0] - b["half_extents"][0]


def least_gap(run, i):
    """Gap to the nearest solid in each frame, m; None: there is no other."""
    gaps = [gap_of(run, i, j) for j in range(len(run.bodies))
            if j != i and not run.bodies[j]["field"]]
    gaps = [gap for gap in gaps if gap is not None]
    return np.min(gaps, axis=0) if gaps else None


# Panels -----------------------------------------------------------------------------------------

def _chosen(run, bodies):
    names = [body["name"] for body in run.bodies]
    if bodies:
        unknown = [name for name in bodies if name not in names]
        if unknown:
            raise SystemExit(f"{unknown[0]}: is no body of {run.scene}; there are: {', '.join(names)}")
        return [names.index(name) for name in bodies]
    moving = [i for i, body in enumerate(run.bodies) if body["moves"] == "free"]
    moving += [i for i, body in enumerate(run.bodies) if body["moves"] == "driven"]
    return (moving or list(range(len(names))))[:MOST_BODIES]


def _look(k):
    return {"color": COLOURS[k % len(COLOURS)], "linestyle": DASHES[k % len(DASHES)]}


def _draw_events(panel, run):
    t = np.asarray(run.events["t"], float)
    if 0 < len(t) <= RUG_ABOVE:
        for x in t:
            panel.axvline(x, color="#bbbbbb", linewidth=0.6, zorder=0)
    elif len(t):
        panel.plot(t, np.zeros(len(t)), "|", color="#888888", markersize=6, markeredgewidth=0.4,
                   transform=panel.get_xaxis_transform(), clip_on=False)


def _draw_bodies(panel, run, chosen, values):
    for k, i in enumerate(chosen):
        y = values(i)
        if y is not None:
            panel.plot(run.times, y, label=run.bodies[i]["name"], **_look(k))
    _draw_events(panel, run)


def _draw_gaps(panel, run, gaps):
    _draw_bodies(panel, run, gaps, gaps.get)
    panel.axhline(0, color="black", linewidth=0.8)
    depths = [np.minimum(gap, 0) for gap in gaps.values() if gap is not None]
    if depths:
        panel.fill_between(run.times, np.min(depths, axis=0), 0, color="#EE6677", alpha=0.35,
                           linewidth=0)


def _draw_ledger(panel, run):
    scale = max(np.nanmax(np.abs(run.ledger["kinetic"])), abs(run.ledger["kinetic"][0] +
                run.ledger["potential"][0]), 1e-300)
    lines = [name for name in run.ledger
             if name not in ("frame", "t", "kinetic", "potential", "flow")
             and np.nanmax(np.abs(run.ledger[name])) > 1e-9 * scale]
    most = max((np.nanmax(np.abs(run.ledger[name])) for name in lines), default=0.0)
    lines = [name for name in lines if np.nanmax(np.abs(run.ledger[name])) > INVISIBLE * most]
    change = run.ledger["kinetic"] + run.ledger["potential"]
    panel.plot(run.ledger["t"], change - change[0], color="black", linewidth=2.2, alpha=0.35,
               label="change of energy")
    for k, name in enumerate(lines):
        panel.plot(run.ledger["t"], run.ledger[name], label=name.replace("_", " "), **_look(k))
    _draw_events(panel, run)


def _axis_of_heights(runs, bodies):
    """y, unless nothing that is drawn moves along it: then the axis of the widest movement."""
    ways = np.max([np.ptp(run.position[:, _chosen(run, bodies)], axis=0).max(axis=0)
                   for run in runs], axis=0)
    return 1 if ways[1] > 1e-9 * ways.max() or ways.max() == 0 else int(np.argmax(ways))


def figure_of(runs, bodies=None):
    """One column per run, one row per quantity; rows share their scale."""
    import matplotlib.pyplot as plt
    if not 1 <= len(runs) <= MOST_RUNS:
        raise SystemExit(f"{len(runs)} runs; allowed: 1 to {MOST_RUNS} beside each other")
    style.use()
    axis = _axis_of_heights(runs, bodies)
    runs = [with_events(run) for run in runs]
    gaps_of = [{i: least_gap(run, i) for i in _chosen(run, bodies)} for run in runs]
    # Gaps are told of balls, boxes and half-spaces; without any, their row is left out.
    some_gaps = any(gap is not None for gaps in gaps_of for gap in gaps.values())
    rows = [("x / m", "height / m", "z / m")[axis], "gap to the nearest / m", "speed / (m/s)",
            "energy ledger / J"]
    if not some_gaps:
        del rows[1]
    figure, panels = plt.subplots(len(rows), len(runs), squeeze=False, sharex="col", sharey="row",
                                  figsize=(1.2 + 4.6 * len(runs), 2.1 * len(rows)))
    for column, (run, gaps) in enumerate(zip(runs, gaps_of)):
        chosen = list(gaps)
        height, speed, ledger = panels[0, column], panels[-2, column], panels[-1, column]
        _draw_bodies(height, run, chosen, lambda i: run.position[:, i, axis])
        if some_gaps:
            _draw_gaps(panels[1, column], run, gaps)
        _draw_bodies(speed, run, chosen, lambda i: np.linalg.norm(run.velocity[:, i], axis=1))
        _draw_ledger(ledger, run)
        more = sum(body["moves"] != "fixed" for body in run.bodies) - len(chosen)
        height.set_title(run.title + (f" ({len(chosen)} bodies, {more} more not drawn)"
                                      if more > 0 and not bodies else ""))
        ledger.set_xlabel("t / s")
        height.legend(loc="best")
        ledger.legend(loc="best")
    for row, name in enumerate(rows):
        panels[row, 0].set_ylabel(name)
    figure.align_ylabels(panels[:, 0])
    return figure


def main(arguments):
    bodies = None
    if "--bodies" in arguments:
        at = arguments.index("--bodies")
        bodies = arguments[at + 1].split(",")
        del arguments[at:at + 2]
    if len(arguments) < 2:
        sys.exit(__doc__)
    out, folders = arguments[0], arguments[1:]
    matplotlib.use("Agg")  # here alone: who draws from Python has a screen of their own
    figure = figure_of([read_run(folder) for folder in folders], bodies)
    kind = os.path.splitext(out)[1].lstrip(".")
    metadata = {"svg": {"Date": None}, "png": {"Software": None},
                "pdf": {"CreationDate": None}}.get(kind, None)
    figure.savefig(out + ".part", format=kind, metadata=metadata, facecolor="white")
    os.replace(out + ".part", out)


if __name__ == "__main__":
    main(sys.argv[1:])
