"""Runs: a scene, a method, and what became of it as arrays."""

from __future__ import annotations

import inspect
import os
from html import escape
from types import SimpleNamespace
from typing import TYPE_CHECKING, Union

import numpy as np

from . import _kairos
from .errors import ProgramError
from .program import viewer_page
from .scene import Scene
from .states import States

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import Options  # a stub, written from the table when the package is built

_LARGEST_PAGE = 20_000_000  # characters: a notebook with a few of these still opens

SceneLike = Union[Scene, str, os.PathLike]


def options() -> list[dict]:
    """Every option of a run: name, kind, unit, default, help. The keywords of `kairos.run`."""
    return _kairos.option_table()


def plug_ins() -> dict[str, list[str]]:
    """Names that the options scheme, integrator, detector and impact take."""
    return _kairos.plug_ins()


class Run:
    """A finished run. Arrays refer to its memory where nothing has to be converted.

    times (frames,) s; position, velocity, angular_velocity (frames, bodies, 3) m, m/s, rad/s;
    orientation (frames, bodies, 4). Bodies as in `bodies`, in the order of creation.
    status: "completed", or "stopped" with a `reason`; end: how far it got, s.
    """

    def __init__(self, record):
        self._record = record

    def __getattr__(self, name):
        if name in ("status", "reason", "end", "times", "position", "orientation", "velocity",
                    "angular_velocity", "cost", "summary"):
            return getattr(self._record, name)
        raise AttributeError(f"a run has no {name!r}")

    @property
    def bodies(self) -> list[str]:
        """Names, in the order of creation: the second axis of the arrays."""
        return [row["name"] for row in self._record.bodies]

    @property
    def shapes(self) -> list[dict]:
        """Of each body: name, entity, shape, moves, field, mass, half_extents or normal."""
        return self._record.bodies

    @property
    def events(self) -> np.ndarray:
        """Structured, a row per event: t, t_correction (s), kind, a, b (names), a_index, b_index,
        gap (m), point, normal (3,), and position, velocity, angular_velocity of both bodies before
        and after: a_before_velocity, ...; grade, how the time of a contact's beginning or end was
        found ("" of others), and bracket (s): it happens in [t, t + bracket]; NaN where that is
        not known; flag, of an impact: "set-valued", "plastic" or "painleve". The columns of
        events.csv."""
        return self._record.events

    @property
    def ledger(self) -> np.ndarray:
        """Structured, a row per frame: frame, t (s), kinetic, potential, and each line of the
        energy ledger (J). The columns of energy.csv."""
        return self._record.ledger

    def index(self, body: str) -> int:
        """Of a body on the second axis of the arrays."""
        return self.bodies.index(body)

    def sample(self, times, bodies=None) -> States:
        """Bodies at any times of the run (s), from their motions: no frame is needed there.

        bodies: a name, or a list of names (default: all). Arrays are (times, bodies, 3), without
        an axis for what is a single time or a single name. At an impact: after it.
        """
        single_time, single_body = np.ndim(times) == 0, isinstance(bodies, str)
        names = self.bodies if bodies is None else [bodies] if single_body else list(bodies)
        parts = self._record.sample(np.atleast_1d(np.asarray(times, float)).ravel(), names)
        place = (0 if single_time else slice(None), 0 if single_body else slice(None))
        return States(*(part[place] for part in parts))

    def to_pandas(self) -> SimpleNamespace:
        """Data frames `trajectory`, `events` and `ledger`, with the columns of the CSV files that
        the program writes. Needs pandas."""
        import pandas
        names = np.array(self.bodies)
        frames, bodies = self.position.shape[:2]
        columns = {"t": np.repeat(self.times, bodies), "body": np.tile(names, frames)}
        for prefix, axes, values in (("p", "xyz", self.position), ("q", "wxyz", self.orientation),
                                     ("v", "xyz", self.velocity),
                                     ("w", "xyz", self.angular_velocity)):
            for i, axis in enumerate(axes):
                columns[prefix + axis] = values[:, :, i].ravel()
        return SimpleNamespace(trajectory=pandas.DataFrame(columns),
                               events=pandas.DataFrame(_flat(self.events)),
                               ledger=pandas.DataFrame(_flat(self.ledger)))

    def view(self, path=None, *, beside: Run | None = None) -> str:
        """The page of `kairos view`: the run in three dimensions at any time, its events and its
        energy, as one HTML file for any browser. beside: another run, shown in step.

        Writes it to `path` and returns the path; without one returns the text. Raises
        `ProgramError` where the page does not come with the program, `ValueError` where the run
        kept no motions.
        """
        runs = [self] if beside is None else [self, beside]
        text = _kairos.page_of(viewer_page(), [run._record for run in runs])
        if path is None:
            return text
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return os.fspath(path)

    def _repr_html_(self):
        """A notebook shows the page of `view` below what became of the run."""
        method = self.summary["method"]
        rows = [("scene", self.summary["scene"]),
                ("method", " + ".join(str(method[k]) for k in
                                      ("scheme", "integrator", "detector", "impact"))),
                (self.status, f"{self.end:g} s" + (f": {self.reason}" if self.reason else "")),
                ("frames, events", f"{len(self.times)}, {len(self.events)}"),
                ("deepest penetration", f"{self.summary['metrics']['max_depth']:.6g} m"),
                ("energy error", f"{self.summary['metrics']['energy_error']:.3e} J")]
        table = "<table>" + "".join(f"<tr><th>{escape(k)}</th><td>{escape(str(v))}</td></tr>"
                                    for k, v in rows) + "</table>"
        try:
            page = self.view()
        except (ProgramError, ValueError) as error:
            return table + f"<p>{escape(str(error))}</p>"
        if len(page) > _LARGEST_PAGE:
            return table + ("<p>The page of this run is too large for a notebook: "
                            "<code>run.view(\"run.html\")</code> writes it to a file.</p>")
        # A frame of its own: neither page can reach into the other.
        return table + ('<iframe sandbox="allow-scripts" style="width:100%;height:44em;border:0" '
                        f'title="{escape(self.summary["scene"])}" srcdoc="{escape(page)}"></iframe>')

    def __repr__(self):
        return (f"<kairos.Run of {self.summary['scene']!r}: {self.status} at {self.end:g} s, "
                f"{len(self.times)} frames, {len(self.events)} events>")


def _flat(array):
    """Columns of a structured array; vectors as NAMEx, NAMEy, NAMEz under the names of the CSV."""
    short = {"point": "p", "normal": "n"}
    columns = {}
    for name in array.dtype.names:
        if array.dtype[name].shape:
            stem = short.get(name, name.replace("angular_velocity", "w").replace("position", "p")
                             .replace("velocity", "v"))
            for i, axis in enumerate("xyz"):
                columns[stem + axis] = array[name][:, i]
        elif not name.endswith("_index"):
            columns[name] = array[name]
    return columns


def _scene(scene) -> Scene:
    return scene if isinstance(scene, Scene) else Scene.read(scene)


def run(scene: SceneLike, *, impact_law=None, recorder=None, motions: bool = True,
        **options: Unpack[Options]) -> Run:
    """Runs a scene: a `Scene`, the path of a scene file, or the name of a shipped scene.

    impact_law: a callable `law(contact)` that returns (velocity_a, velocity_b), (3,) each, None
        for a body that stays as it is. contact: point, normal (a to b), gap, restitution and friction of the pair; of a and b: name,
        entity, mass (kg; inf: not free), restitution, position, velocity, angular_velocity.
    recorder: an object with any of `frame(index, t, states)` and `event(event)`.
    motions: keep them, for `sample` (some 300 bytes to 1 kB an event).

    Where nothing of it is written in Python the interpreter's lock is released. Raises `InputError`
    for what is refused; a run that stops is a result with status "stopped" and a reason.
    """
    if impact_law is not None and not callable(impact_law):
        raise TypeError(f"impact_law: is {impact_law!r}; allowed: a callable law(contact)")
    methods = [getattr(recorder, name, None) for name in ("frame", "event")]
    if recorder is not None and not any(callable(method) for method in methods):
        raise TypeError(f"recorder: {recorder!r} has neither frame(index, t, states) nor event(event)")
    return Run(_kairos.run(_scene(scene)._draft, options, impact_law, recorder, motions))


def why_refused(scene: SceneLike, **options: Unpack[Options]) -> str:
    """The reason why this method cannot run this scene; empty if it can."""
    return _kairos.why_refused(_scene(scene)._draft, options)


def _default(row):
    """As Python writes it; None where the scene or the method decides."""
    text = row["default"]
    if row["kind"] == "flag":
        return text == "true"
    if not text or row["kind"] in ("name", "frames"):
        return text or None
    return int(text) if row["kind"] == "count" else float(text)


def _document(function):
    """Options are keywords: their names and meanings come from the one table of the library."""
    rows = options()
    kept = [p for p in inspect.signature(function).parameters.values()
            if p.kind is not inspect.Parameter.VAR_KEYWORD]
    kept += [inspect.Parameter(row["name"], inspect.Parameter.KEYWORD_ONLY,
                               default=_default(row)) for row in rows]
    function.__signature__ = inspect.Signature(kept)
    function.__doc__ += "\n\n    Options:\n" + "\n".join(
        f"    {row['name']}: {row['help']}" + (f" ({row['unit']})" if row["unit"] else "")
        for row in rows) + "\n"


_document(run)
_document(why_refused)
