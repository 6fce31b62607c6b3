"""Many questions about pairs of bodies at once: time of impact, overlap, distance."""

from __future__ import annotations

import enum

import numpy as np

from . import _kairos
from ._kairos import Motion, Shape


class Status(enum.IntEnum):
    """What `toi` found: the numbers of its column status."""

    separated = 0    #: no contact in the window (proven, with detector "certified")
    impact = 1       #: contact by t_hi, none before t_lo
    overlapping = 2  #: they overlap at the start already
    undecided = 3    #: within tolerance at t_lo, and neither contact nor its absence proven


_KINDS = {"box": 0, "sphere": 1, "half-space": 2}


def _rows(value, width, name):
    array = np.asarray(value, dtype=float)
    if array.ndim == 1 and array.shape == (width,):
        array = array[None, :]
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name}: has the shape {np.shape(value)}; allowed: ({width},) or "
                         f"(n, {width})")
    return np.ascontiguousarray(array)


class Bodies:
    """Bodies of a kind, or of several, and how they move: one side of n questions.

    shape: "box", "sphere", "half-space", or a list of n of these, with `size`; or a `Shape` of any
    kind (capsule to mesh), or a list of n, without.
    size (3,) or (n, 3): half-extents (m); radius and two numbers that do not count; outward normal.
    position (m), velocity (m/s), acceleration (m/s^2), angular_velocity (rad/s): (3,) or (n, 3);
    orientation (4,) or (n, 4): unit quaternion, body to world, w first. Bodies move on
    position + velocity t + acceleration t^2/2 and turn at the constant rate.
    motion: instead of these a `Motion`, or a list of n.
    What is given once stands for all n. `boxes`, `spheres` and `half_spaces` are shorter.

    Arrays are converted and checked here, on all cores, and not referred to afterwards: up to 160
    bytes a row. Asking again costs what the question costs. A bad row raises `InputError` with its
    number, the first of several.
    """

    def __init__(self, shape, size=None, *, position=(0, 0, 0), orientation=(1, 0, 0, 0),
                 velocity=(0, 0, 0), acceleration=(0, 0, 0), angular_velocity=(0, 0, 0),
                 motion=None):
        names = [shape] if isinstance(shape, (str, Shape)) else list(shape)
        shapes = [one for one in names if isinstance(one, Shape)]
        if shapes and (len(shapes) < len(names) or size is not None):
            raise ValueError("shape: a Shape has its size; allowed: names and size, or Shapes alone")
        if not shapes and size is None:
            raise ValueError("size: is missing; needed: half-extents, radius or normal")
        names, size = (["box"] * len(shapes), (0, 0, 0)) if shapes else (names, size)
        unknown = [name for name in names if name not in _KINDS]
        if unknown:
            raise ValueError(f"shape: '{unknown[0]}' is unknown; allowed: {', '.join(_KINDS)}")
        kinds = np.array([_KINDS[name] for name in names], dtype=np.int8)
        columns = [_rows(size, 3, "size"), _rows(position, 3, "position"),
                   _rows(orientation, 4, "orientation"), _rows(velocity, 3, "velocity"),
                   _rows(acceleration, 3, "acceleration"),
                   _rows(angular_velocity, 3, "angular_velocity")]
        motions = [] if motion is None else [motion] if isinstance(motion, Motion) else list(motion)
        counts = {len(kinds), len(motions) or 1, *(len(column) for column in columns)} - {1}
        if len(counts) > 1:
            raise ValueError(f"rows of different number: {sorted(counts)}; allowed: n, or 1")
        #: number of rows, 1 where all is given once
        self.count = counts.pop() if counts else 1
        self._columns = _kairos.QueryBodies(kinds, *columns, motions, shapes)

    def __len__(self):
        return self.count


def boxes(half_extents, **motion) -> Bodies:
    """Boxes of these half-extents, (3,) or (n, 3), m. Keywords as of `Bodies`."""
    return Bodies("box", half_extents, **motion)


def spheres(radius, **motion) -> Bodies:
    """Spheres of this radius, a number or (n,), m. Keywords as of `Bodies`."""
    radius = np.atleast_1d(np.asarray(radius, dtype=float))
    if radius.ndim != 1:
        raise ValueError(f"radius: has the shape {radius.shape}; allowed: a number, or (n,)")
    return Bodies("sphere", np.repeat(radius[:, None], 3, axis=1), **motion)


def half_spaces(normal=(0, 1, 0), **motion) -> Bodies:
    """Half-spaces through `position` with this outward unit normal in their own frame."""
    return Bodies("half-space", normal, **motion)


def _count(a: Bodies, b: Bodies, *columns) -> int:
    counts = {len(a), len(b), *(len(column) for column in columns)} - {1}
    if len(counts) > 1:
        raise ValueError(f"rows of different number: {sorted(counts)}; allowed: n, or 1")
    return counts.pop() if counts else 1


def toi(a: Bodies, b: Bodies, duration, *, start=0.0, detector="certified", tolerance=0.0,
        threads=0) -> np.ndarray:
    """When do a[i] and b[i] first touch? On all cores, the interpreter's lock released.

    duration: s, a number or (n,).  start: of the windows, for motions that start elsewhere, s.
    tolerance: m; 0: 1e-9 of the smaller extent plus the roundoff of the coordinates.
    threads: 0: one per core; answers do not depend on it.

    Returns a structured array (n,): status (`Status`), t_lo, t_hi (s from `start`: no contact
    before t_lo, contact by t_hi), gap (m at t_lo, from below), normal (3,) from a to b, witness_a,
    witness_b (3,) nearest points at t_lo, evaluations. The same bits as `kairos toi`. A bad row
    raises `InputError` with its number; of several, the first.
    """
    durations = np.atleast_1d(np.asarray(duration, dtype=float)).ravel()
    starts = np.atleast_1d(np.asarray(start, dtype=float)).ravel()
    count = _count(a, b, durations, starts)
    return _kairos.toi(a._columns, b._columns, durations, starts, detector, tolerance, threads,
                       count)


def overlap(a: Bodies, b: Bodies, *, threads=0) -> np.ndarray:
    """Do a[i] and b[i] overlap where they start? (n,) of bool; touching is overlapping."""
    return _kairos.overlap(a._columns, b._columns, threads, _count(a, b))


def distance(a: Bodies, b: Bodies, *, threads=0) -> np.ndarray:
    """How far apart are a[i] and b[i] where they start? Structured (n,): gap (m; negative: the
    least translation that separates), normal (3,) from a to b, point (3,) in the middle."""
    return _kairos.distance(a._columns, b._columns, threads, _count(a, b))
