"""Many questions at once: the bits of `kairos toi`, whatever the number of threads."""

import io
import threading
import time

import numpy as np
import pytest

import kairos
from kairos import Motion, Spline, Status, boxes, half_spaces, spheres, toi

SEED = 20260  # of the draws; numpy's PCG64 is the same everywhere


def unit(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def random_columns(n, seed):
    draw = np.random.default_rng(seed)
    return {"half_extents": draw.uniform(0.05, 1, (n, 3)), "position": draw.uniform(-3, 3, (n, 3)),
            "orientation": unit(draw.normal(size=(n, 4))), "velocity": draw.uniform(-2, 2, (n, 3)),
            "acceleration": draw.uniform(-9, 9, (n, 3)),
            "angular_velocity": draw.uniform(-3, 3, (n, 3))}


def query_file(a, b, kinds_a, kinds_b, durations):
    """The same queries as `kairos toi` reads them; numbers in the shortest form that reads back."""
    names = ["h", "p", "q", "v", "a", "w"]
    columns = ["half_extents", "position", "orientation", "velocity", "acceleration",
               "angular_velocity"]
    out = io.StringIO()
    heads = [f"{side}_{name}{axis}" for side in "ab" for name in names
             for axis in ("wxyz" if name == "q" else "xyz")]
    out.write(",".join(["id", "a_shape", "b_shape", *heads, "duration"]) + "\n")
    for i, duration in enumerate(durations):
        numbers = [repr(float(x)) for side in (a, b) for column in columns for x in side[column][i]]
        out.write(",".join([str(i), kinds_a[i], kinds_b[i], *numbers, repr(float(duration))]) + "\n")
    return out.getvalue()


@pytest.mark.parametrize("detector", ["certified", "conservative-advancement", "bisection"])
def test_answers_have_the_bits_of_the_program(program, detector):
    print("seed", SEED)
    n = 2000
    a, b = random_columns(n, SEED), random_columns(n, SEED + 1)
    kinds_a = (["box", "sphere"] * n)[:n]
    kinds_b = (["box", "box", "half-space", "sphere", "sphere"] * n)[:n]
    durations = np.random.default_rng(SEED + 2).uniform(0, 1, n)
    text = query_file(a, b, kinds_a, kinds_b, durations)
    printed = program("toi", "-", "--detector", detector, input=text).stdout.splitlines()

    def bodies(columns, kinds):
        sizes = np.where((np.array(kinds) == "half-space")[:, None], [0.0, 1.0, 0.0],
                         columns["half_extents"])
        rest = {name: value for name, value in columns.items() if name != "half_extents"}
        return kairos.Bodies(kinds, sizes, **rest)

    answers = toi(bodies(a, kinds_a), bodies(b, kinds_b), durations, detector=detector)
    assert len({int(s) for s in answers["status"]}) >= 3  # all kinds of answers are compared
    for row, line in zip(answers, printed[1:]):
        fields = line.split(",")
        assert Status[fields[1]] == row["status"]
        assert [float(x) for x in fields[2:8]] == [row["t_lo"], row["t_hi"], row["gap"], *row["normal"]]
        assert int(fields[8]) == row["evaluations"]


def test_threads_change_no_bit_and_one_row_stands_for_all():
    n = 3000
    a, b = boxes(**random_columns(n, SEED)), boxes((0.5, 0.4, 0.3))
    one = toi(a, b, 1.0, threads=1)
    assert np.array_equal(one, toi(a, b, 1.0, threads=3))
    assert np.array_equal(one, toi(a, boxes(np.tile([0.5, 0.4, 0.3], (n, 1))), np.ones(n)))


def test_a_bad_row_is_named_and_the_first_of_several():
    position = np.zeros((1000, 3))
    position[700, 1] = np.nan
    position[300, 2] = np.inf
    for _ in range(3):  # whichever thread comes across one first
        with pytest.raises(kairos.InputError, match=r"^row 300: position: inf is not allowed"):
            spheres(0.1, position=position)
    late = np.full(1000, 1.0)
    late[[250, 900]] = -1.0
    for threads in (1, 3):
        with pytest.raises(kairos.InputError, match=r"^row 250: duration: -1 is negative"):
            toi(spheres(0.1), boxes((1, 1, 1)), late, threads=threads)
    cases = [(lambda: spheres([0.1, -1]), "row 1: radius: -1 is no half-extent"),
             (lambda: spheres(0.1, orientation=(2, 0, 0, 0)), "row 0: orientation: the quaternion"),
             (lambda: spheres(0.1, velocity=(1e70, 0, 0), acceleration=(1e70, 0, 0)),
              "row 0: a.velocity: with this acceleration")]
    for make, message in cases:
        with pytest.raises(kairos.InputError) as wrong:
            toi(make(), boxes((1, 1, 1)), 1.0)
        assert str(wrong.value).startswith(message)
    with pytest.raises(kairos.InputError, match="two half-spaces"):
        toi(half_spaces(), half_spaces(), 1.0)
    with pytest.raises(kairos.InputError, match="duration: -1 is negative"):
        toi(spheres(0.1), boxes((1, 1, 1)), -1.0)
    with pytest.raises(kairos.InputError, match="does not tell when"):
        toi(spheres(0.1), boxes((1, 1, 1)), 1.0, detector="sat")
    with pytest.raises(ValueError, match=r"position: has the shape \(2,\)"):
        spheres(0.1, position=(1, 2))
    with pytest.raises(ValueError, match=r"rows of different number: \[2, 3\]"):
        toi(spheres([0.1, 0.2]), spheres([0.1, 0.2, 0.3]), 1.0)


def test_bodies_are_as_they_were_given():
    """Later changes of an array change no answer; no rows are no answers."""
    position = np.array([[3.0, 0, 0], [5, 0, 0]])
    far = spheres(0.5, position=position)
    position[:] = 0
    assert kairos.distance(spheres(0.5), far)["gap"].tolist() == [2.0, 4.0]
    none = spheres(np.zeros(0), position=np.zeros((0, 3)))
    assert len(toi(none, boxes((1, 1, 1)), 1.0)) == len(kairos.overlap(boxes((1, 1, 1)), none)) == 0
    assert len(toi(none, none, np.zeros(0))) == 0
    for columns in (none, far):
        assert len(kairos.distance(columns, columns)) == len(columns)


def test_known_answers():
    # From 1 m apart at 2 m/s: 0.5 s.
    found = toi(spheres(0.5, velocity=(2, 0, 0)), spheres(0.5, position=(2, 0, 0)), 1.0)[0]
    assert found["status"] == Status.impact and found["t_lo"] <= 0.5 <= found["t_hi"]
    assert found["t_hi"] - found["t_lo"] < 1e-9  # the default tolerance at 2 m/s
    gap = kairos.distance(boxes((1, 1, 1)), spheres(0.5, position=[[3, 0, 0], [1.25, 0, 0]]))
    assert np.allclose(gap["gap"], [1.5, -0.25], atol=4e-16)  # an ulp or two of 3 m
    assert kairos.overlap(boxes((1, 1, 1)), spheres(0.5, position=[[3, 0, 0], [1.25, 0, 0]])).tolist() \
        == [False, True]


def test_a_spline_is_asked_piece_by_piece():
    # x = 3 t^2 - 2 t^3 from 0 to 1: the gripper touches the ball where x = 0.85.
    path = Spline([0, 1], [[0, 0, 0], [1, 0, 0]], velocities=np.zeros((2, 3)))
    assert np.allclose(path.motions[0].coefficients[:, 0], [0, 0, 3, -2], atol=0)
    t, piece, answer = kairos.first_contact("box", (0.05, 0.05, 0.05), path,
                                            spheres(0.1, position=(1, 0, 0)))
    root = [r.real for r in np.roots([-2, 3, 0, -0.85]) if 0 < r.real < 1][0]
    assert piece == 0 and answer["status"] == Status.impact
    assert abs(t - root) < 1e-9  # the default tolerance, 1e-10 m, at 1.1 m/s
    assert kairos.first_contact("box", (0.05, 0.05, 0.05), path, spheres(0.1, position=(0, 1, 0))) is None


def test_natural_splines_pass_through_their_points_smoothly():
    times, points = np.array([0, 1, 2.5, 3]), np.array([[0, 0, 0], [1, 2, 0], [2, 0, 1], [0, 0, 0.]])
    path = Spline(times, points)
    for i, motion in enumerate(path.motions):
        assert np.allclose(motion.position(0), points[i], atol=1e-15)
        # A solved system of 4 unknowns: some tens of roundings of numbers near 10.
        assert np.allclose(motion.position(motion.duration), points[i + 1], atol=1e-13)
        if i:
            before = path.motions[i - 1]
            assert np.allclose(before.velocity(before.duration), motion.velocity(0), atol=1e-13)


def test_motions_are_checked():
    with pytest.raises(ValueError, match=r"position: has the shape \(2,\)"):
        Motion([1, 2], 1.0)
    with pytest.raises(ValueError, match="position: holds nan"):
        Motion([[0, 0, np.nan]], 1.0)
    with pytest.raises(ValueError, match="duration"):
        Motion([0, 0, 0], 0.0)
    with pytest.raises(kairos.InputError, match="row 0: a.motion: lasts from 0 s for 1 s"):
        toi(spheres(0.1, motion=Motion([0, 0, 0], 1.0)), boxes((1, 1, 1)), 2.0)


def test_python_goes_on_while_questions_are_answered():
    n = 300_000
    a, b = boxes(**random_columns(n, SEED)), boxes((0.5, 0.4, 0.3))
    turns, done = [], threading.Event()

    def watch():
        while not done.is_set():
            turns.append(time.perf_counter())
            time.sleep(0.005)

    thread = threading.Thread(target=watch)
    thread.start()
    start = time.perf_counter()
    toi(a, b, 1.0, threads=1)
    took = time.perf_counter() - start
    done.set()
    thread.join()
    during = [t for t in turns if start <= t <= start + took]
    assert len(during) >= 3  # with the lock held: none between the first and the last bit of it


CUBE = """OFF
8 6 0
-1 -1 -1
1 -1 -1
1 1 -1
-1 1 -1
-1 -1 1
1 -1 1
1 1 1
-1 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


def test_all_shapes_are_asked_by_the_keys_of_a_scene(tmp_path):
    file = tmp_path / "cube.off"
    file.write_text(CUBE)
    half = {"shape": "box", "half_extents": (0.25, 0.5, 0.5)}
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    shapes = [kairos.Shape(shape="box", half_extents=(0.5, 0.5, 0.5)),
              kairos.Shape(shape="hull", points=corners),
              kairos.Shape(shape="mesh", file=file, unit=0.5),
              kairos.Shape(shape="mesh", file=file, unit=0.5, solid=True),
              kairos.Shape(shape="compound", part=[{**half, "position": (-0.25, 0, 0)},
                                                   {**half, "position": (0.25, 0, 0)}]),
              kairos.Shape(shape="sphere", radius=0.5),
              kairos.Shape(shape="capsule", radius=0.5, length=1),
              kairos.Shape(shape="cylinder", radius=0.5, length=1)]
    # Each reaches 0.5 m along x: at 1 m/s the gap of 1 m to a cube closes after 1 s.
    a = kairos.Bodies(shapes, velocity=(1, 0, 0))
    b = boxes((0.5, 0.5, 0.5), position=(2, 0, 0))
    answers = toi(a, b, 3.0)
    assert (answers["status"] == Status.impact).all()
    assert (np.abs(answers["t_lo"] - 1) < 1e-8).all() and (answers["t_lo"] <= 1).all()
    assert np.allclose(kairos.distance(a, b)["gap"], 1, rtol=0, atol=1e-14)
    assert not kairos.overlap(a, b).any()
    assert kairos.overlap(a, boxes((0.5, 0.5, 0.5), position=(0.9, 0, 0))).all()
    one = kairos.Bodies(shapes[4], velocity=(1, 0, 0))  # stands for all
    assert (toi(one, kairos.Bodies(shapes, position=(2, 0, 0)), 3.0)["status"] == Status.impact).all()


def test_what_is_no_shape_is_refused_by_its_key(tmp_path):
    with pytest.raises(kairos.InputError, match="radius"):
        kairos.Shape(shape="capsule", length=1)
    with pytest.raises(kairos.InputError, match="colour: unknown key"):
        kairos.Shape(shape="sphere", radius=1, colour="red")
    with pytest.raises(kairos.InputError, match="nowhere.off"):
        kairos.Shape(shape="mesh", file=tmp_path / "nowhere.off")
    with pytest.raises(ValueError, match="names and size, or Shapes alone"):
        kairos.Bodies([kairos.Shape(shape="sphere", radius=1), "box"])
    with pytest.raises(ValueError, match="size: is missing"):
        kairos.Bodies("box")
