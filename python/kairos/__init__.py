"""kairos: what happens between two frames, and what does it cost to know?

    import kairos

    scene = kairos.Scene("drop", duration=2.0)
    scene.wall("floor", shape="half-space")
    scene.ball("ball", radius=0.1, mass=1.0, position=(0, 5, 0), restitution=0.9)
    run = kairos.run(scene, frame="1/60")
    print(run.events["t"], run.sample([0.5, 1.5]).position)

SI units throughout; y is up; quaternions are unit, body to world, w first. Arrays that a run
returns refer to its memory and are read-only; copy what shall change.
"""

from ._kairos import Contact, ContactBody, Motion, Shape, versions
from .bodies import Bodies, Status, boxes, distance, half_spaces, overlap, spheres, toi
from .errors import CallableError, InputError, ProgramError
from .paths import Spline, first_contact
from .plotting import plot
from .program import program
from .runs import Run, options, plug_ins, run, why_refused
from .scene import Scene, shipped_scenes
from .states import States
from .sweeps import Recommendation, Sweep, merge, recommend, sweep, tradeoff
from .tables import Table

__version__ = dict(versions())["kairos"]

__all__ = [
    "Bodies", "CallableError", "Contact", "ContactBody", "InputError", "Motion", "ProgramError",
    "Recommendation", "Run", "Scene", "Shape", "Spline", "States", "Status", "Sweep", "Table", "boxes", "distance",
    "first_contact", "half_spaces", "merge", "options", "overlap", "plot", "plug_ins", "program",
    "recommend", "run", "shipped_scenes", "spheres", "sweep", "toi", "tradeoff", "versions",
    "why_refused",
]
