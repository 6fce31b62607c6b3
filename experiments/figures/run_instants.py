"""Instants between frames: a run as it is drawn goes through its events, not past them."""

import dataclasses

import numpy as np

MOST_EVENTS = 2000  # more would not be told apart in a picture


@dataclasses.dataclass
class Track:
    """What is known of one body: frames, and before and after each of its events, in order."""

    t: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    orientation: np.ndarray

    def at(self, times, after):
        """Cubic between what is known (exact for a parabola); `after`: of an event at that instant.
        Turns go straight from one orientation to the next."""
        last = len(self.t) - 1
        left = np.searchsorted(self.t, times, side="left")
        right = np.searchsorted(self.t, times, side="right")
        end = np.clip(np.where(after, right, left), 1, last)
        begin = end - 1
        h = self.t[end] - self.t[begin]
        s = np.clip(np.divide(times - self.t[begin], h, out=np.ones_like(h), where=h > 0), 0, 1)
        s, h = s[:, None], h[:, None]
        p, q, v, w = (array[k] for array in (self.position, self.velocity) for k in (begin, end))
        position = ((1 + 2 * s) * (1 - s) ** 2 * p + s * (1 - s) ** 2 * h * v +
                    s ** 2 * (3 - 2 * s) * q - s ** 2 * (1 - s) * h * w)
        first, second = self.orientation[begin], self.orientation[end]
        side = np.where(np.einsum("ni,ni->n", first, second) < 0, -1.0, 1.0)[:, None]
        turned = (1 - s) * first + s * side * second
        return (np.where(s == 0, p, np.where(s == 1, q, position)), (1 - s) * v + s * w,
                turned / np.linalg.norm(turned, axis=1, keepdims=True))


def _track(run, body, events):
    """events: (time, position, velocity) before and after, of this body, in order."""
    t = np.concatenate([run.times, [event[0] for event in events]])
    order = np.argsort(t, kind="stable")
    position = np.concatenate([run.position[:, body], [e[1] for e in events]]) if events else \
        run.position[:, body]
    velocity = np.concatenate([run.velocity[:, body], [e[2] for e in events]]) if events else \
        run.velocity[:, body]
    seen = np.searchsorted(run.times, t[order], side="right") - 1
    return Track(t[order], position[order], velocity[order],
                 run.orientation[np.clip(seen, 0, len(run.times) - 1), body])


def with_events(run):
    """The run with two more instants for each impact, before and after it, in a new `DrawnRun`; the
    run itself where there are none, or too many."""
    names = {body["name"]: i for i, body in enumerate(run.bodies)}
    rows = [i for i, kind in enumerate(run.events["kind"]) if kind == "impact"]
    if not rows or len(rows) > MOST_EVENTS or len(run.times) < 2:
        return run
    of_body = [[] for _ in run.bodies]
    for i in rows:
        for side in "ab":
            body = names.get(str(run.events[side][i]))
            for when in ("before", "after"):
                state = [run.events[f"{side}_{when}_{what}"][i] for what in ("position", "velocity")]
                if body is not None and np.all(np.isfinite(state)):
                    of_body[body].append((float(run.events["t"][i]), *state))
    instants = np.unique(np.asarray(run.events["t"], float)[rows])
    instants = instants[(instants >= run.times[0]) & (instants <= run.times[-1])]
    inside = ~np.isin(run.times, instants)
    times = np.concatenate([run.times[inside], instants, instants])
    after = np.concatenate([np.zeros(inside.sum() + len(instants), bool),
                            np.ones(len(instants), bool)])
    order = np.argsort(times, kind="stable")
    times, after = times[order], after[order]
    parts = [_track(run, i, events).at(times, after) for i, events in enumerate(of_body)]
    position, velocity, orientation = (np.stack(part, axis=1) for part in zip(*parts))
    return dataclasses.replace(run, times=times, position=position, velocity=velocity,
                               orientation=orientation)
