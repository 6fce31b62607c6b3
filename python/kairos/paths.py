"""Paths of robots and other driven things: splines, piece by piece."""

from __future__ import annotations

import bisect

import numpy as np

from ._kairos import Motion
from .bodies import Bodies, Status, toi


def _natural_second_derivatives(t, y):
    """Of the cubic spline through (t, y) whose second derivative vanishes at both ends."""
    n, h = len(t), np.diff(t)
    m = np.zeros_like(y)
    if n > 2:
        system = np.diag(2 * (h[:-1] + h[1:])) + np.diag(h[1:-1], 1) + np.diag(h[1:-1], -1)
        slopes = np.diff(y, axis=0) / h[:, None]
        m[1:-1] = np.linalg.solve(system, 6 * np.diff(slopes, axis=0))
    return m


class Spline:
    """A cubic spline through points: a drive, and a path for `first_contact`.

    times (k,) s, increasing; positions (k, 3) m; velocities (k, 3) m/s, or None: the natural
    spline. orientation (4,): it does not turn. Each piece is a `Motion`, exactly the polynomial that
    it says: its error radius is 0. Before the first time and after the last it stands still.
    """

    def __init__(self, times, positions, velocities=None, orientation=(1, 0, 0, 0)):
        t, p = np.asarray(times, float), np.asarray(positions, float)
        if t.ndim != 1 or len(t) < 2 or not np.all(np.diff(t) > 0):
            raise ValueError("times: allowed: (k,), k >= 2, increasing")
        if p.shape != (len(t), 3):
            raise ValueError(f"positions: has the shape {p.shape}; allowed: ({len(t)}, 3)")
        h = np.diff(t)[:, None]
        if velocities is None:
            m = _natural_second_derivatives(t, p)
            c1 = np.diff(p, axis=0) / h - h * (2 * m[:-1] + m[1:]) / 6
            c2, c3 = m[:-1] / 2, np.diff(m, axis=0) / (6 * h)
        else:
            v = np.asarray(velocities, float)
            if v.shape != p.shape:
                raise ValueError(f"velocities: has the shape {v.shape}; allowed: {p.shape}")
            slope = np.diff(p, axis=0) / h
            c1 = v[:-1]
            c2 = (3 * slope - 2 * v[:-1] - v[1:]) / h
            c3 = (v[:-1] + v[1:] - 2 * slope) / h**2
        self.times, self.orientation = t, orientation
        #: pieces, one between each two times
        self.motions = [Motion([p[i], c1[i], c2[i], c3[i]], float(h[i, 0]), start=float(t[i]),
                               quaternion=orientation) for i in range(len(t) - 1)]

    def position(self, t: float) -> np.ndarray:
        """(3,) at time t, m."""
        piece = self.motions[min(max(bisect.bisect_right(self.times, t) - 1, 0),
                                 len(self.motions) - 1)]
        return piece.position(min(max(t - piece.start, 0.0), piece.duration))

    def __call__(self, t: float, at_most: float) -> Motion:
        """The piece that holds t: what a drive is asked for."""
        if t < self.times[0]:
            return Motion.ballistic(self.position(t), orientation=self.orientation, start=t,
                                    duration=min(at_most, self.times[0] - t))
        i = bisect.bisect_right(self.times, t) - 1
        if i >= len(self.motions):
            return Motion.ballistic(self.position(t), orientation=self.orientation, start=t,
                                    duration=at_most)
        return self.motions[i]


def first_contact(shape, size, path: Spline, other: Bodies, **options):
    """When does a body on a path first touch another? Every piece of the path, in one batch; see
    `toi` for options.

    other: one body that stands still, or moves as a `Motion` over the whole path.
    Returns (t, piece, answer) of the first contact: t is the proven bound before which there is
    none, s; None: there is none on the whole path, proven with detector "certified".
    """
    if other.count > 1:
        raise ValueError("first_contact takes one other body; ask for each of several")
    moving = Bodies(shape, size, motion=path.motions)
    answers = toi(moving, other, [m.duration for m in path.motions],
                  start=[m.start for m in path.motions], **options)
    for i in np.flatnonzero(answers["status"] != Status.separated)[:1]:
        return path.motions[i].start + answers["t_lo"][i], int(i), answers[i]
    return None
