"""Pictures of runs and tables: drawn by the scripts that draw the report, in one place."""

from __future__ import annotations

import functools
import importlib.util
import os
import sys

import numpy as np

from .errors import ProgramError
from .program import data_folder
from .runs import Run


@functools.lru_cache(maxsize=None)
def _script():
    """The module `run_plot` of the figures that come with the program."""
    folder = data_folder("figures")
    if not folder:
        raise ProgramError("the figure scripts are not found; install the program, or set "
                           "KAIROS_DATA to the folder share/kairos")
    if folder not in sys.path:
        sys.path.append(folder)  # its modules import each other by name
    specification = importlib.util.spec_from_file_location(
        "run_plot", os.path.join(folder, "run_plot.py"))
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def _as_drawn(run, label):
    """A run as the script sees it: the columns of the files that `kairos run --out` writes."""
    method = run.summary["method"]
    ledger, events = run.ledger, run.events
    return _script().DrawnRun(
        title=label or f"{run.summary['scene']}, {method['scheme']}",
        scheme=method["scheme"], scene=run.summary["scene"], bodies=run.shapes, times=run.times,
        position=run.position, velocity=run.velocity, orientation=run.orientation,
        ledger={name: ledger[name] for name in ledger.dtype.names},
        events={name: events[name] for name in ("t", "kind", "a", "b", "gap",
                                                *_script().event_columns())})


def plot(*runs, labels=None, bodies=None):
    """Height, gap, speed and energy ledger over time, with events; several runs beside each other.

    runs: `Run`s, or folders that `kairos run --out` wrote. labels: a title for each.
    bodies: names of those that are drawn (default: those that move freely, up to six).
    Returns a matplotlib figure: the picture that `kairos plot` draws. Needs matplotlib.
    """
    script = _script()
    labels = labels or [None] * len(runs)
    drawn = [_as_drawn(run, label) if isinstance(run, Run) else script.read_run(os.fspath(run), label)
             for run, label in zip(runs, labels)]
    import matplotlib
    with matplotlib.rc_context():  # the figure has the report's style, the session keeps its own
        return script.figure_of(drawn, np.atleast_1d(bodies).tolist() if bodies is not None else None)
