"""A run's arrays are what the program writes, to the last digit."""

import csv
import inspect
import signal
import time

import numpy as np
import pytest

import kairos
from kairos.program import viewer_page
from test_scenes import drop, refused

SCENES = [("bounce", {}), ("drag-drop", {"integrator": "rk4"}), ("spinning-box", {}),
          ("bat", {"scheme": "original", "integrator": "thesis-euler", "detector": "sat",
                   "impact": "thesis"}), ("cradle", {})]


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def column(rows, name):
    return np.array([float(row[name]) if row[name] else np.nan for row in rows])


def same(a, b):
    """The same numbers, to the last bit."""
    return np.array_equal(np.asarray(a, float).ravel(), np.asarray(b, float).ravel(),
                          equal_nan=True)


@pytest.mark.parametrize("scene, options", SCENES)
def test_arrays_equal_the_files_of_the_program(scene, options, program, tmp_path):
    flags = [word for name, value in options.items() for word in ("--" + name, value)]
    program("run", scene, "--duration", "2", *flags, "--out", tmp_path / "run", check=False)
    run = kairos.run(scene, duration=2, **options)

    trajectory = rows_of(tmp_path / "run" / "trajectory.csv")
    assert len(trajectory) == run.position.shape[0] * run.position.shape[1] > 0
    assert [row["body"] for row in trajectory[:len(run.bodies)]] == run.bodies
    for prefix, axes, values in (("p", "xyz", run.position), ("v", "xyz", run.velocity),
                                 ("w", "xyz", run.angular_velocity), ("q", "wxyz", run.orientation)):
        for i, axis in enumerate(axes):
            assert same(column(trajectory, prefix + axis), values[:, :, i]), prefix + axis
    assert same(column(trajectory, "t"), np.repeat(run.times, len(run.bodies)))

    energy = rows_of(tmp_path / "run" / "energy.csv")
    assert list(energy[0]) == list(run.ledger.dtype.names)
    for name in energy[0]:
        assert same(column(energy, name), run.ledger[name]), name

    frames = run.to_pandas() if pandas_is_here() else None
    events = rows_of(tmp_path / "run" / "events.csv")
    assert len(events) == len(run.events)
    if events and frames is not None:
        assert list(events[0]) == list(frames.events.columns)
        for name in events[0]:
            if name not in ("kind", "a", "b", "grade", "flag"):
                assert same(column(events, name), frames.events[name]), name
        for name in ("kind", "grade", "flag"):
            assert [row[name] for row in events] == list(run.events[name])
        assert [(row["a"], row["b"]) for row in events] == list(zip(run.events["a"], run.events["b"]))


def pandas_is_here():
    try:
        import pandas  # noqa: F401
    except ImportError:
        return False
    return True


def test_arrays_refer_to_the_run_and_outlive_it():
    run = kairos.run(drop())
    position = run.position
    assert not position.flags.owndata and not position.flags.writeable
    assert not run.ledger.flags.owndata and not run.times.flags.owndata
    last = position[-1].copy()
    del run
    assert np.array_equal(position[-1], last)


def test_any_time_can_be_asked_for():
    run = kairos.run(drop())
    states = run.sample(run.times, "ball")
    # A frame is what the motions say at its time; motions are polynomials in local time: 4 ulp of 5 m.
    assert np.abs(states.position - run.position[:, 1]).max() <= 4e-15
    assert run.sample(0.5).position.shape == (2, 3)
    assert run.sample(0.5, "ball").position[1] == pytest.approx(5 - 4.9 * 0.25, abs=1e-15)
    t = run.events["t"][0]
    assert run.sample(t, "ball").velocity[1] == run.events["a_after_velocity"][0][1]
    with pytest.raises(ValueError, match=r"times\[1\]: is 3 s"):
        run.sample([0.0, 3.0])
    with pytest.raises(KeyError):
        run.sample(0.0, "bell")
    with pytest.raises(ValueError, match="motions=True"):
        kairos.run(drop(), motions=False).sample(0.0)


def test_options_are_the_one_table():
    names = [row["name"] for row in kairos.options()]
    assert names == [name for name in inspect.signature(kairos.run).parameters
                     if name not in ("scene", "impact_law", "recorder", "motions")]
    method = kairos.run(drop()).summary["method"]
    assert set(names) <= set(method)
    for row in kairos.options():
        assert f"{row['name']}: {row['help']}" in kairos.run.__doc__
    assert 'did you mean "scheme"' in str(refused(lambda: kairos.run(drop(), schem="original")))
    assert refused(lambda: kairos.run(drop(), frame=-1)).key == "frame"
    assert refused(lambda: kairos.run(drop(), scheme="event")).reason
    with pytest.raises(TypeError, match="frame: is a list"):
        kairos.run(drop(), frame=[1])
    assert len(kairos.run(drop(), frame="1/30").times) == len(kairos.run(drop(), frame=1 / 30).times)


@pytest.mark.parametrize("scheme", kairos.plug_ins()["scheme"])
def test_every_scheme_of_the_registry_runs_or_says_why_not(scheme):
    why = kairos.why_refused(drop(), scheme=scheme)
    if why:
        assert why in str(refused(lambda: kairos.run(drop(), scheme=scheme)))
    else:
        assert kairos.run(drop(), scheme=scheme).summary["method"]["scheme"] == scheme


def test_a_run_that_stops_is_a_result_with_a_reason():
    run = kairos.run(drop(), scheme="substepped", max_substeps=1, threshold=1e-3)
    assert run.status == "stopped" and run.reason and run.end < 2.0
    assert len(run.times) == len(run.position) > 0


def test_ctrl_c_ends_a_run():
    def press(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, press)
    start = time.monotonic()
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(KeyboardInterrupt):
            kairos.run(drop(), frame=1e-6, duration=1e5, motions=False)  # years of frames
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - start < 60


def test_a_run_shows_itself():
    run = kairos.run(drop())
    assert "drop" in repr(run) and "completed" in repr(run)
    assert "event-driven" in run._repr_html_()


def test_a_run_shows_itself_as_the_page_of_kairos_view(program, tmp_path):
    try:
        viewer_page()
    except kairos.ProgramError as error:
        pytest.skip(str(error))
    program("view", "bounce", "--duration", "2", "--beside", "thesis", "--out", tmp_path / "a.html")
    run = kairos.run("bounce", duration=2)
    thesis = kairos.run("bounce", duration=2, scheme="original", integrator="thesis-euler",
                        detector="sat", impact="thesis")
    assert run.view(tmp_path / "b.html", beside=thesis) == str(tmp_path / "b.html")
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()
    shown = run._repr_html_()
    assert shown.count("<iframe") == 1 and "kairos-numbers-0" in shown and "</iframe>" in shown
    unseen = kairos.run("bounce", duration=2, motions=False)
    with pytest.raises(ValueError, match="kept no motions"):
        unseen.view()
    assert "<iframe" not in unseen._repr_html_() and "kept no motions" in unseen._repr_html_()
