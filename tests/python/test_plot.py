"""`kairos plot` and kairos.plot: one picture, by the same functions."""

import numpy as np
import pytest

import kairos
from kairos import plotting

matplotlib = pytest.importorskip("matplotlib")


def runs_of(program, tmp_path, names):
    for name in names:
        program("run", name, "--duration", "1", "--out", tmp_path / name)
    return [tmp_path / name for name in names]


def test_the_command_draws_what_the_package_draws(program, tmp_path):
    folders = runs_of(program, tmp_path, ["bounce", "spinning-box"])
    said = program("plot", *folders, "--out", tmp_path / "two.svg").stdout.strip()
    assert said == str(tmp_path / "two.svg")
    before = dict(matplotlib.rcParams), matplotlib.get_backend()
    figure = kairos.plot(*folders)
    assert (dict(matplotlib.rcParams), matplotlib.get_backend()) == before  # the session's own
    with matplotlib.rc_context():
        plotting._script().style.use()
        figure.savefig(tmp_path / "package.svg", metadata={"Date": None}, facecolor="white")
    assert (tmp_path / "two.svg").read_bytes() == (tmp_path / "package.svg").read_bytes()
    # A run in memory is the same lines as its files.
    in_memory = kairos.plot(*[kairos.run(name, duration=1) for name in ("bounce", "spinning-box")])
    for ours, theirs in zip(in_memory.axes, figure.axes):
        assert [line.get_label() for line in ours.lines] == [line.get_label() for line in theirs.lines]
        for a, b in zip(ours.lines, theirs.lines):
            assert np.array_equal(np.asarray(a.get_ydata(), float), np.asarray(b.get_ydata(), float),
                                  equal_nan=True)


def test_lines_go_through_the_impacts_between_frames():
    run = kairos.run("bounce", duration=3)
    height, gap, speed, _ = kairos.plot(run).axes
    impacts = run.events["t"][run.events["kind"] == "impact"]
    assert len(impacts) == 2 and not np.isin(impacts, run.times).any()
    for t in impacts:
        at, = np.nonzero(gap.lines[0].get_xdata() == t)
        assert len(at) == 2  # before and after
        assert np.all(np.abs(gap.lines[0].get_ydata()[at]) < 1e-9)  # the tolerance, of 0.5 m
    # Each instant of the line is where the run was: cubics are exact for a parabola.
    t = np.asarray(height.lines[0].get_xdata())
    assert np.allclose(height.lines[0].get_ydata(), run.sample(t, "ball").position[:, 1], atol=1e-12)
    assert np.allclose(speed.lines[0].get_ydata(),
                       np.abs(run.sample(t, "ball").velocity[:, 1]), atol=1e-11)


def test_without_out_the_picture_lies_with_the_run(program, tmp_path):
    folder, = runs_of(program, tmp_path, ["bounce"])
    program("plot", folder)
    assert (folder / "plot.png").stat().st_size > 20000


def test_gaps_of_pictures_are_the_gaps_of_the_library():
    """Boxes, balls and planes: against kairos.distance, at the frames of a run."""
    scene = kairos.Scene("all", duration=0.5, G=0.0)
    scene.wall("floor", shape="half-space")
    scene.ball("ball", radius=0.2, mass=1, position=(0, 2, 0), velocity=(1, -1, 0))
    scene.body("crate", entity="body", shape="box", half_extents=(0.2, 0.3, 0.4), mass=1,
               position=(3, 2, 0), velocity=(-1, 0, 0.5), angular_velocity=(1, 2, 3))
    scene.body("plank", entity="body", shape="box", half_extents=(0.5, 0.1, 0.1), mass=1,
               position=(0, 4, 1), angular_velocity=(0, 1, 1))
    run = kairos.run(scene)
    drawn = plotting._as_drawn(run, None)
    make = {"sphere": lambda s, **at: kairos.spheres(s["half_extents"][0], **at),
            "box": lambda s, **at: kairos.boxes(s["half_extents"], **at),
            "half-space": lambda s, **at: kairos.half_spaces(s["normal"], **at)}
    for i in range(4):
        for j in range(i):
            a, b = (make[run.shapes[k]["shape"]](run.shapes[k], position=run.position[:, k],
                                                 orientation=run.orientation[:, k]) for k in (i, j))
            gap = kairos.distance(a, b)["gap"]
            ours = plotting._script().gap_of(drawn, i, j)
            if {run.shapes[i]["shape"], run.shapes[j]["shape"]} == {"box"}:
                # The greatest separation is between distance/sqrt(3) and the distance.
                assert np.all(ours <= gap + 1e-12) and np.all(ours >= gap / np.sqrt(3) - 1e-12)
            else:
                assert np.allclose(ours, gap, atol=1e-13)  # some tens of roundings of 4 m


def test_wrong_input_is_named(program, tmp_path):
    folder, = runs_of(program, tmp_path, ["bounce"])
    for arguments, message in (((tmp_path,), "holds no summary.json"),
                               ((folder, "--out", tmp_path / "x.gif"), "allowed: a file .png"),
                               ((folder, "--bodies", "bell"), "is no body of bounce")):
        done = program("plot", *arguments, check=False)
        assert done.returncode in (1, 2) and message in done.stderr
    with pytest.raises(SystemExit, match="is no body"):
        kairos.plot(folder, bodies=["bell"])
