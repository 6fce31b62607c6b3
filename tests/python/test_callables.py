"""Forces, drives, laws and recorders of one's own."""

import numpy as np
import pytest

import kairos
from test_scenes import drop, refused

INTEGRATORS = ["auto", "rk4", "thesis-euler"] + [
    name for name in ("cvode-adams", "gsl-rkf45", "arkode-5")
    if name in kairos.plug_ins()["integrator"]]


def tethered():
    scene = kairos.Scene("tether", duration=1.0, G=0.0)
    return scene.ball("bob", radius=0.1, mass=1.0, position=(1, 0, 0))


def test_a_force_in_python_is_the_force_of_the_library():
    k = 9.0
    own = tethered().force(lambda t, s: -k * s.position, bodies="bob", name="tether",
                           potential=lambda t, s: 0.5 * k * s.position @ s.position)
    # rest length 0, anchored at the origin: the same formula
    theirs = tethered().force("spring", bodies="bob", stiffness=k, anchor=(0, 0, 0))
    a, b = kairos.run(own, integrator="rk4"), kairos.run(theirs, integrator="rk4")
    # 60 frames of 4 stages, each rounding a few products of numbers near 9: 1e3 roundings.
    assert np.abs(a.position - b.position).max() <= 1e3 * 2.3e-16
    assert np.abs(a.ledger["potential"] - b.ledger["potential"]).max() <= 9e3 * 2.3e-16
    assert a.cost["right_hand_sides"] == b.cost["right_hand_sides"]


def test_the_period_of_a_tether_is_known():
    pi = np.pi
    run = kairos.run(tethered().force(lambda t, s: -pi * pi * s.position, bodies="bob"))
    assert run.position[-1, 0, 0] == pytest.approx(-1.0, abs=1e-8)  # dopri5 at 1e-10 a step


def test_bodies_that_a_force_couples_come_as_rows():
    scene = kairos.Scene("two", duration=1.0, G=0.0)
    scene.ball("a", radius=0.1, mass=1.0, position=(0, 0, 0))
    scene.ball("b", radius=0.1, mass=3.0, position=(2, 0, 0))
    shapes = set()

    def pull(t, s):
        shapes.add((s.position.shape, s.orientation.shape, s.velocity.shape))
        f = s.position[1] - s.position[0]
        return np.array([f, -f])

    run = kairos.run(scene.force(pull, bodies=["a", "b"]), integrator="rk4")
    assert shapes == {((2, 3), (2, 4), (2, 3))}
    momentum = run.velocity[:, 0] + 3 * run.velocity[:, 1]
    assert np.abs(momentum).max() <= 60 * 4 * 4 * 2.3e-16  # equal and opposite, to roundoff


def test_a_torque_turns():
    scene = kairos.Scene("top", duration=1.0, G=0.0)
    scene.body("top", entity="body", shape="box", half_extents=(0.5, 0.5, 0.5), mass=6.0)
    run = kairos.run(scene.force(lambda t, s: ((0, 0, 0), (0, 0, 1.0)), bodies="top", rotation=True))
    # The cube's moment is m (2h)^2 / 6 = 1: w = t.
    assert run.angular_velocity[-1, 0] == pytest.approx([0, 0, 1], abs=1e-9)  # dopri5 at 1e-10


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("wrong, message", [
    (lambda t, s: (1, 2), r"force 'wind' at t = 0 s: returned a force of the shape \(2,\)"),
    (lambda t, s: (0, float("nan"), 0), r"returned a force of \(0, nan, 0\); needed: finite"),
    (lambda t, s: "north", "returned 'north' as force; needed: an array of numbers"),
    (lambda t, s: None, r"returned a force of the shape \(\)|returned a force of")])
def test_what_a_force_returns_is_checked_and_named(integrator, wrong, message):
    with pytest.raises(kairos.CallableError, match=message):
        kairos.run(drop().force(wrong, bodies="ball", name="wind"), integrator=integrator)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_exceptions_come_through_as_they_are(integrator):
    class Mine(Exception):
        pass

    def late(t, s):
        if t > 0.5:
            raise Mine("half a second")
        return (0, 0, 0)

    with pytest.raises(Mine, match="half a second"):
        kairos.run(drop().force(late, bodies="ball"), integrator=integrator)


def test_a_force_names_bodies_that_can_be_moved():
    def still(t, s):
        return (0, 0, 0)

    assert "is no body of the scene" in str(refused(lambda: kairos.run(drop().force(still, bodies="bell"))))
    assert "is not moved by forces" in str(refused(lambda: kairos.run(drop().force(still, bodies="floor"))))
    assert "does not turn" in str(refused(
        lambda: kairos.run(drop().force(still, bodies="ball", rotation=True))))
    assert "callables" in str(refused(lambda: drop().force(still, bodies="ball").toml()))
    with pytest.raises(TypeError, match="takes bodies"):
        drop().force(still)


def test_arrays_that_a_force_sees_cannot_be_written():
    def write(t, s):
        s.position[0] = 1.0

    with pytest.raises(ValueError, match="read-only"):
        kairos.run(drop().force(write, bodies="ball"))


def test_a_drive_moves_a_body_and_hits():
    scene = kairos.Scene("bat", duration=1.0, G=0.0)
    path = kairos.Spline([0, 1], [[0, 0, 0], [1, 0, 0]], velocities=np.zeros((2, 3)))
    scene.bat("bat", half_extents=(0.1, 0.5, 0.5), mass=10.0, drive=path)
    scene.ball("ball", radius=0.1, mass=1.0, position=(0.7, 0, 0))
    run = kairos.run(scene)
    assert run.sample(0.25, "bat").position[0] == pytest.approx(3 / 16 - 2 / 64, abs=1e-15)
    # The bat's face is at 0.1 + 3 t^2 - 2 t^3: 0.6 at t = 0.5, where it moves at 1.5 m/s.
    assert run.events["t"][0] == pytest.approx(0.5, abs=1e-9)
    assert run.events["b_after_velocity"][0][0] + run.events["a_after_velocity"][0][0] != 0.0


def test_a_drive_that_is_none_is_named():
    def scene(drive):
        return kairos.Scene("bat", duration=1.0).bat("bat", half_extents=(0.1, 0.5, 0.5), mass=10.0,
                                                     drive=drive)

    with pytest.raises(kairos.CallableError, match="drive of 'bat' at t = 0 s: returned 7"):
        kairos.run(scene(lambda t, at_most: 7))
    with pytest.raises(kairos.CallableError, match="needed: one that holds t"):
        kairos.run(scene(lambda t, at_most: kairos.Motion([0, 0, 0], 1.0, start=5.0)))


def test_a_law_gives_new_velocities_and_the_ledger_stays_closed():
    seen = []

    def law(contact):
        seen.append((contact.a.name, contact.b.name, contact.gap))
        moves_a = np.isfinite(contact.a.mass)
        mover, out = (contact.a, -contact.normal) if moves_a else (contact.b, contact.normal)
        velocity = mover.velocity + (1.0 - mover.velocity @ out) * out
        return (velocity, None) if moves_a else (None, velocity)

    scene = kairos.Scene("launcher", duration=2.0, G=0.0).wall("wall", shape="half-space")
    scene.ball("ball", radius=0.1, mass=1.0, position=(0, 3.1, 0), velocity=(0, -3, 0))
    run = kairos.run(scene, impact_law=law)
    assert len(seen) == 1 and {seen[0][0], seen[0][1]} == {"ball", "wall"}
    assert run.position[-1, 1, 1] == pytest.approx(1.1, abs=1e-9)  # 1 s down at 3 m/s, 1 s up
    assert abs(run.ledger["unexplained"][-1]) <= 8 * 2.3e-16 * run.ledger["flow"][-1]


@pytest.mark.parametrize("answer, message", [
    (lambda c: 3, r"returned 3; needed: \(velocity_a, velocity_b\)"),
    (lambda c: ((1, 2), None), r"gave 'ball' the velocity \(1, 2\)"),
    (lambda c: ((0, float("inf"), 0), None), r"gave 'ball' the velocity \(0, inf, 0\)"),
    (lambda c: (None, (0, 0, 0)), "gave 'floor' a velocity; it is not free")])
def test_what_a_law_returns_is_checked_and_named(answer, message):
    with pytest.raises(kairos.CallableError, match=message):
        kairos.run(drop(), impact_law=answer)


def test_a_recorder_hears_frames_and_events():
    class Heard:
        def __init__(self):
            self.frames, self.events = [], []

        def frame(self, index, t, states):
            self.frames.append((index, t, states.position[1, 1]))

        def event(self, event):
            self.events.append((event["t"], str(event["kind"])))

    heard = Heard()
    run = kairos.run(drop(), recorder=heard)
    assert [t for _, t, _ in heard.frames] == run.times.tolist()
    assert [y for _, _, y in heard.frames] == run.position[:, 1, 1].tolist()
    assert heard.events == [(run.events["t"][0], "impact")]

    class Broken:
        def frame(self, index, t, states):
            raise LookupError(index)

    with pytest.raises(LookupError, match="0"):
        kairos.run(drop(), recorder=Broken())


def test_what_is_no_recorder_and_no_law_is_named():
    with pytest.raises(TypeError, match=r"recorder: \[\] has neither frame"):
        kairos.run(drop(), recorder=[])
    with pytest.raises(TypeError, match="impact_law: is 3; allowed: a callable"):
        kairos.run(drop(), impact_law=3)
