#!/usr/bin/env python3
"""Runs event-driven on degenerate scenes and judges what it writes by a geometry of its own.

usage: degenerate_scenes.py PROGRAM [--count N] [--first K] [--seed S] [--jobs J] [--out DIR]

Scenes start in exact touch: towers, grids, bridges, grooves, corners, boxes on an edge or over a rim,
rows of balls, heaps, hands that let go beside walls. Each is a function of (seed, number):
`--first K --count 1` makes it again. Written from scenes/README.md, not from the readers.

What a scene may not do, whatever becomes of it: end by a signal or without a reason, take more than
40 s of processor time for a tenth of its duration, write a NaN, show two solids in one another at a
frame, leave energy unexplained. A part of the scenes runs again where nothing may change: bodies listed
in another order, interrupted and resumed (the same bytes), half the frame time (the same bodies meet in
the same order, up to the first stop or contact that lasts).
Runs that stop with a reason are counted by that reason; scenes that are refused are faults here.
"""

import argparse
import collections
import concurrent.futures
import csv
import functools
import itertools
import json
import math
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile

# Of processor time: what hangs takes longer. Not a measure of speed: beside another job the same run may
# take twice as long as alone.
SECONDS = 40
TOO_LONG = f"more than {SECONDS} s"
DEPTH = 1e-10  # of the smaller extent: 1e-9 is the tolerance of an impact, and rest is at the surface
ENERGY = 1e-12  # of the energy that flowed: some thousand roundings


# --- Vectors ---------------------------------------------------------------------------------------


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def plus(a, b):
    return tuple(x + y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def quaternion(axis, angle):
    s = math.sin(angle / 2) / length(axis)
    return (math.cos(angle / 2), axis[0] * s, axis[1] * s, axis[2] * s)


def times(p, q):
    w, x, y, z = p
    a, b, c, d = q
    r = (w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
         w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a)
    return tuple(e / length(r) for e in r)


def axes_of(q):
    """The columns of the rotation."""
    w, x, y, z = q
    s = 2.0 / dot(q, q)
    return ((1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)),
            (s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)),
            (s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)))


def turned(q, v):
    columns = axes_of(q)
    return tuple(sum(columns[k][i] * v[k] for k in range(3)) for i in range(3))


# --- Depth of one solid in another -----------------------------------------------------------------


def depth(a, pose_a, b, pose_b):
    """Greatest lower bound over the axes looked at: positive only if the two overlap."""
    if b["shape"] == "half-space":
        return into_plane(a, pose_a, b, pose_b)
    if a["shape"] == "half-space":
        return into_plane(b, pose_b, a, pose_a)
    if a["shape"] == b["shape"] == "sphere":
        return a["radius"] + b["radius"] - math.dist(pose_a[0], pose_b[0])
    if a["shape"] == "sphere":
        return into_box(a, pose_a, b, pose_b)
    if b["shape"] == "sphere":
        return into_box(b, pose_b, a, pose_a)
    return boxes(a, pose_a, b, pose_b)


def into_plane(body, pose, plane, at):
    normal = plane.get("normal", at[1][1])  # the second axis, where none is given
    distance = dot(minus(pose[0], at[0]), normal)
    if body["shape"] == "sphere":
        return body["radius"] - distance
    return sum(h * abs(dot(u, normal)) for h, u in zip(body["half_extents"], pose[1])) - distance


def into_box(ball, pose, box, at):
    local = [dot(u, minus(pose[0], at[0])) for u in at[1]]
    out = [max(abs(x) - h, 0.0) for x, h in zip(local, box["half_extents"])]
    if max(out) > 0.0:
        return ball["radius"] - length(out)
    return ball["radius"] + min(h - abs(x) for x, h in zip(local, box["half_extents"]))


def boxes(a, pose_a, b, pose_b):
    directions = list(pose_a[1]) + list(pose_b[1])
    for u in pose_a[1]:
        for v in pose_b[1]:
            n = cross(u, v)
            if length(n) > 1e-6:
                directions.append(tuple(x / length(n) for x in n))
    between = minus(pose_b[0], pose_a[0])

    def along(n):
        reach = sum(h * abs(dot(u, n)) for h, u in zip(a["half_extents"], pose_a[1]))
        reach += sum(h * abs(dot(u, n)) for h, u in zip(b["half_extents"], pose_b[1]))
        return reach - abs(dot(between, n))

    return min(along(n) for n in directions)


def extent(body):
    return body.get("radius") or min(body.get("half_extents", (math.inf,)))


# --- Scenes ----------------------------------------------------------------------------------------


class Scene:
    """Bodies and what is said of the whole; a function of a random generator."""

    def __init__(self, rng):
        self.rng = rng
        self.bodies = []
        self.track = ""
        self.restitution = rng.choice([0, 0, 0.3, 0.5, 0.9, 1])
        self.gravity = rng.choice([9.8, 9.8, 9.8, 10.0, 0.0])
        self.duration = rng.choice([0.25, 0.5, 2.0])
        self.frame = 1 / 60
        self.body("floor", entity="wall", shape="half-space")
        if rng.random() < 0.3:
            self.body("side", entity="wall", shape="half-space", position=(-2.0, 0, 0), normal=(1.0, 0, 0))
        self.kind = rng.choice(sorted(self.KINDS))
        top = self.KINDS[self.kind](self)
        if self.track:
            return  # a recording stays in its frame of reference; what a fist holds meets nobody
        if rng.random() < 0.4:
            self.projectile(top)
        if rng.random() < 0.3:
            self.turn()
        if rng.random() < 0.2:
            self.scale(rng.choice([1e-6, 1e-3, 1e6]))

    def some(self, s):
        return self.rng.choice([0.0, 0.0, s, -s, s / 2, self.rng.uniform(-s, s)])

    def body(self, name, **keys):
        keys.setdefault("entity", "body")
        keys.setdefault("position", (0.0, 0.0, 0.0))
        if keys["entity"] in ("body", "ball"):
            keys.setdefault("mass", self.rng.choice([1.0, 1.0, 1.0, 10.0, 1e-3, 1e3]))
            keys.setdefault("restitution", self.restitution)
        self.bodies.append({"name": name, **keys})

    def box(self, name, position, half=(0.25, 0.25, 0.25), **keys):
        self.body(name, shape="box", half_extents=half, position=position, **keys)

    def ball(self, name, position, radius=0.25, **keys):
        self.body(name, shape="sphere", radius=radius, position=position, **keys)

    def tower(self):
        x = y = z = 0.0
        for k in range(self.rng.randint(1, 6)):
            half = tuple(self.rng.choice([0.125, 0.25, 0.5]) for _ in range(3))
            self.box(f"b{k}", (x, y + half[1], z), half)
            x, y, z = x + self.some(0.1), y + 2 * half[1], z + self.some(0.1)
        if self.rng.random() < 0.5:
            self.ball("s", (x, y + 0.25, z))
            y += 0.5
        return y

    def grid(self):
        columns, rows = self.rng.randint(1, 3), self.rng.randint(1, 3)
        for i in range(columns):
            for j in range(rows):
                self.box(f"b{i}_{j}", (0.5 * i, 0.25 + 0.5 * j, 0))
        return 0.5 * rows

    def bridge(self):
        gap = self.rng.choice([0.5, 0.75, 1.0])
        self.box("l", (-gap, 0.25, 0))
        self.box("r", (gap, 0.25, 0))
        self.box("t", (self.some(0.2), 0.75, self.some(0.1)), (gap + 0.25, 0.25, 0.25))
        return 1.0

    def groove(self):
        gap = self.rng.choice([0.125, 0.15, 0.2])
        solid = {} if self.rng.random() < 0.5 else {"entity": "wall"}
        for name, side in (("l", -1), ("r", 1)):
            self.box(name, (side * (gap + 0.3), 0.25, 0), (0.3, 0.25, 1.0), **solid)
        drop = self.rng.choice([0.0, 0.3])
        self.ball("s", (self.some(0.01), 0.5 + math.sqrt(0.0625 - gap * gap) + 0.01 + drop, 0))
        return 1.2

    def corner(self):
        self.body("w1", entity="wall", shape="half-space", position=(-1.0, 0, 0), normal=(1.0, 0, 0))
        self.body("w2", entity="wall", shape="half-space", position=(0, 0, -1.0), normal=(0, 0, 1.0))
        velocity = (-self.rng.choice([0.0, 1.0, 3.0]), 0.0, -self.rng.choice([0.0, 2.0]))
        at = self.rng.choice([(-0.75, 0.25, -0.75), (-0.5, 0.25, 0.0), (-0.75, 0.75, 0.25)])
        self.rng.choice([self.box, self.ball])("a", at, velocity=velocity)
        return 1.1

    def edge(self):
        lift = self.rng.choice([0.0, 1e-9, 0.1])
        self.box("a", (0, 0.25 * math.sqrt(2) * (1 + 4e-16) + lift, 0),
                 orientation=quaternion((0, 0, 1), math.pi / 4))
        return 0.8

    def shelf(self):
        self.box("shelf", (0, 1.0, 0), (0.5, 0.1, 0.5), entity="wall")
        self.box("a", (self.rng.choice([0.25, 0.4, 0.5, 0.6, 0.75]), 1.35, 0))
        if self.rng.random() < 0.5:
            self.box("b", (self.rng.choice([0.0, 0.4]), 1.85 + self.rng.choice([0.0, 0.2]), 0))
        return 2.4

    def row(self):
        speed = self.rng.choice([0.0, 1.0, 5.0])
        count = self.rng.randint(2, 5)
        for k in range(count):
            self.ball(f"s{k}", (0.5 * k, 0.25, 0))
        self.ball("first", (-0.5 - self.rng.choice([0.0, 0.5]), 0.25, 0), velocity=(speed, 0, 0))
        return 0.5

    def heap(self):
        for k in range(self.rng.randint(2, 5)):
            at = (self.rng.uniform(-0.3, 0.3), 0.5 + 0.9 * k, self.rng.uniform(-0.3, 0.3))
            if self.rng.random() < 0.5:
                axis = tuple(self.rng.gauss(0, 1) for _ in range(3))
                self.box(f"h{k}", at, orientation=quaternion(axis, self.rng.uniform(0, 3)))
            else:
                self.ball(f"h{k}", at)
        return 5.0

    def hand(self):
        """A hand carries a ball to the floor, and lets go above it, at it or beside a box."""
        self.box("table", (0.0, 0.25, 0.0), entity="wall")
        at, goal = self.rng.choice([((0, 1.0, 0), (0, 0.7, 0)), ((0.45, 1.0, 0), (0.45, 0.2, 0)),
                                    ((1.0, 1.0, 0), (1.0, 0.25, 0)), ((1.0, 1.0, 0), (0.5, 0.6, 0.1))])
        away = plus(goal, (0, self.rng.choice([0.0, -0.02, 0.5]), 0))
        rows = [(0.0, at, 1), (0.1, at, 1), (0.4, goal, 1), (0.45, away, 0), (3.0, (1.0, 1.5, 0), 0)]
        self.track = "t,x,y,z,gesture\n" + "".join(
            f"{t},{p[0]},{p[1]},{p[2]},{closed}\n" for t, p, closed in rows)
        self.ball("held", at, 0.2, entity="ball")
        self.body("hand", entity="hand", radius=0.05, mass=1.0, position=at, holds="held")
        return 2.0

    KINDS = {"tower": tower, "grid": grid, "bridge": bridge, "groove": groove, "corner": corner, "edge": edge,
             "shelf": shelf, "row": row, "heap": heap, "hand": hand}

    def projectile(self, top):
        speed = self.rng.choice([1.0, 10.0, 100.0])
        if self.rng.random() < 0.5:
            at, velocity = (self.some(0.2), top + 1.0, self.some(0.2)), (0.0, -speed, 0.0)
        else:
            at, velocity = (-1.7, 0.3 + self.rng.random() * top, self.some(0.1)), (speed, 0.0, 0.0)
        if self.rng.random() < 0.5:
            self.ball("thrown", at, 0.2, velocity=velocity)
        else:
            self.box("thrown", at, (0.2, 0.1, 0.15), velocity=velocity)

    def turn(self):
        """All bodies in another frame of reference; gravity stays, so that floors become inclines."""
        q = self.rng.choice([quaternion((0, 0, 1), 0.25), quaternion((0, 1, 0), 0.7),
                             quaternion((1, 2, 3), 1.1), quaternion((1, 0, 0), -0.4)])
        shift = self.rng.choice([(0.0, 0.0, 0.0), (10.0, 20.0, 30.0)])
        for body in self.bodies:
            body["position"] = plus(turned(q, body["position"]), shift)
            if "normal" in body:
                body["normal"] = turned(q, body["normal"])
            else:
                body["orientation"] = times(q, body.get("orientation", (1.0, 0.0, 0.0, 0.0)))
            if "velocity" in body:
                body["velocity"] = turned(q, body["velocity"])

    def scale(self, s):
        for body in self.bodies:
            for key in ("position", "half_extents"):
                if key in body:
                    body[key] = tuple(s * x for x in body[key])
            if "radius" in body:
                body["radius"] *= s
            if "velocity" in body:
                body["velocity"] = tuple(math.sqrt(s) * x for x in body["velocity"])
        self.duration *= math.sqrt(s)
        self.frame *= math.sqrt(s)

    def overlaps_at_start(self):
        """A scene that is wrong from the start judges nobody."""
        poses = {b["name"]: (b["position"], axes_of(b.get("orientation", (1, 0, 0, 0)))) for b in self.bodies}
        return deepest(self.bodies, poses)[0] > 1e-13

    def toml(self):
        def value(v):
            if isinstance(v, tuple):
                return "[" + ", ".join(repr(float(x)) for x in v) + "]"
            return f'"{v}"' if isinstance(v, str) else repr(float(v))

        lines = [f"duration = {self.duration!r}", f"frame = {self.frame!r}", f"G = {self.gravity!r}"]
        for body in self.bodies:
            lines.append("\n[[body]]")
            lines += [f"{key} = {value(v)}" for key, v in body.items()]
            if body["entity"] == "hand":
                lines.append('drive = {track = "hand.csv"}')
        return "\n".join(lines) + "\n"


def deepest(bodies, poses):
    """Depth in units of the smaller extent, and who."""
    worst = (-math.inf,)
    for k, a in enumerate(bodies):
        for b in bodies[:k]:
            if a["entity"] == b["entity"] == "wall" or "hand" in (a["entity"], b["entity"]):
                continue  # walls may stand in one another, and hands are no solids
            scale = min(extent(a), extent(b))
            worst = max(worst, (depth(a, poses[a["name"]], b, poses[b["name"]]) / scale, a["name"], b["name"]))
    return worst


# --- Runs ------------------------------------------------------------------------------------------


class Run:
    def __init__(self, program, folder, name, scene, options, seconds=SECONDS):
        self.folder = folder / name
        file = folder / "scene.toml"
        file.write_text(scene.toml())
        (folder / "hand.csv").write_text(scene.track)
        limit = ["sh", "-c", f'ulimit -t {seconds}; exec "$@"', "sh"]
        command = [*limit, program, "run", file, "--out", self.folder, *options]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.code, self.words = done.returncode, done.stderr

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def faults(self, bodies):
        if self.code in (-signal.SIGXCPU, -signal.SIGKILL):
            return [TOO_LONG]
        if self.code not in (0, 1):
            return [f"exit code {self.code}: {self.words.strip()[-300:]}"]
        if self.code == 1 and "stopped at t" not in self.words:
            return [f"no reason: {self.words.strip()[-300:]}"]
        found = []
        trajectory = self.rows("trajectory.csv")
        if any("nan" in v or "inf" in v for row in trajectory for k, v in row.items() if k != "body"):
            return ["NaN"]
        for rows in frames(trajectory):
            worst = deepest(bodies, {r["body"]: pose(r) for r in rows})
            if worst[0] > DEPTH:
                found.append(f"overlap at t = {rows[0]['t']}: {worst}")
                break
        for row in self.rows("energy.csv"):
            if abs(float(row["unexplained"])) > ENERGY * float(row["flow"]):
                found.append(f"unexplained {row['unexplained']} J of {row['flow']} at t = {row['t']}")
                break
        return found

    def bytes(self):
        return {f.name: f.read_bytes() for f in self.folder.glob("*.csv")}

    def meetings(self):
        """Who met, in order, until a contact lasted: bodies that turn in touch take steps of a frame at most.
        An edge that lands with both its corners is one impact, or two at one instant."""
        told = [(row["t"], row["kind"], row["a"], row["b"]) for row in self.rows("events.csv")]
        told = list(itertools.takewhile(lambda row: row[1] != "contact-begins", told))
        return [here[1:] for before, here in zip([None, *told], told) if here != before]

    def states(self):
        rows = list(frames(self.rows("trajectory.csv")))[-1]
        return {row["body"]: [v for k, v in row.items() if k != "body"] for row in rows}


def frames(trajectory):
    at = collections.defaultdict(list)
    for row in trajectory:
        at[row["t"]].append(row)
    return at.values()


def pose(row):
    return (tuple(float(row[k]) for k in ("px", "py", "pz")),
            axes_of(tuple(float(row[k]) for k in ("qw", "qx", "qy", "qz"))))


def again(program, folder, scene, options, first, rng):
    """The same scene where nothing may change: neither does the work, but for noise."""
    run = functools.partial(Run, program, folder, seconds=2 * SECONDS)
    way = rng.choice(["order", "resume", "frame"])
    if way == "order":
        mixed = list(scene.bodies)
        rng.shuffle(mixed)
        bodies, scene.bodies = scene.bodies, mixed
        other = run("order", scene, options)
        scene.bodies = bodies
        if other.code != first.code or other.states() != first.states():
            return ["another order of bodies, another end"]
    elif way == "resume":
        part = [*options, "--duration", repr(scene.duration * rng.choice([0.3, 0.5, 0.71]))]
        run("part", scene, [*part, "--save", folder / "checkpoint"])
        if (folder / "checkpoint").exists():
            rest = run("rest", scene, [*options, "--resume", folder / "checkpoint"])
            if rest.code != first.code or rest.bytes() != first.bytes():
                return ["resumed, and other bytes"]
    else:
        other = run("frame", scene, [*options, "--frame", repr(scene.frame / 2)])
        found = other.faults(scene.bodies)
        if found:
            return [f"half the frame time: {f}" for f in found]
        if first.code == other.code == 0 and first.meetings()[:20] != other.meetings()[:20]:
            return ["half the frame time, other meetings"]
    return []


def judge(program, seed, number, out):
    rng = random.Random(f"{seed}-{number}")
    scene = Scene(rng)
    while scene.overlaps_at_start():
        scene = Scene(rng)
    options = ["--impact", rng.choice(["newton", "newton", "moreau", "reflections"])]
    if rng.random() < 0.3:
        options += ["--detector", "conservative-advancement"]
    folder = pathlib.Path(tempfile.mkdtemp(prefix="degenerate-"))
    try:
        first = Run(program, folder, "scene", scene, options)
        found = first.faults(scene.bodies)
        long = found == [TOO_LONG]
        if long:  # time goes on if a tenth of the scene ends, and that is judged instead
            scene.duration /= 10
            found = Run(program, folder, "tenth", scene, options).faults(scene.bodies)
        elif not found:
            found = again(program, folder, scene, options, first, rng)
        if found and out:
            out.mkdir(parents=True, exist_ok=True)
            (out / f"{seed}-{number}.toml").write_text(f"# {' '.join(map(str, options))}: {found[0]}\n" + scene.toml())
            (out / "hand.csv").write_text(scene.track)
        reason = f"{TOO_LONG}, and time goes on" if long else ""
        if first.code == 1:
            reason = re.sub(r"'[^']*'", "X", first.words.split("stopped at t", 1)[1])
            reason = re.sub(r"[-+]?\d[\d.e+-]*", "N", reason.split(" s: ", 1)[1])[:90]
        return number, scene.kind, found, reason
    finally:
        shutil.rmtree(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, help="folder for scenes at fault")
    args = parser.parse_args()
    kinds, reasons, faults = collections.Counter(), collections.Counter(), 0
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        numbers = range(args.first, args.first + args.count)
        for number, kind, found, reason in pool.map(
                lambda k: judge(args.program, args.seed, k, args.out), numbers):
            kinds[kind, "stopped" if reason else "completed"] += 1
            reasons[reason] += bool(reason)
            for fault in found:
                faults += 1
                print(f"seed {args.seed} scene {number} ({kind}): {fault}", flush=True)
    for (kind, end), n in sorted(kinds.items()):
        print(f"{kind:8} {end:10} {n}")
    for reason, n in reasons.most_common():
        if n:
            print(f"{n:6}  {reason}")
    print(f"{args.count} scenes, {faults} at fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
