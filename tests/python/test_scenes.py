"""Scenes built in Python are scenes of files: the same keys, checks and messages."""

import numpy as np
import pytest

import kairos


def drop():
    scene = kairos.Scene("drop", duration=2.0)
    scene.wall("floor", shape="half-space")
    return scene.ball("ball", radius=0.1, mass=1.0, position=(0, 5, 0), restitution=0.9)


def refused(build):
    with pytest.raises(kairos.InputError) as found:
        build()
    return found.value


def test_a_built_scene_reads_back_from_its_text_to_the_same_bits():
    scene = drop().force("quadratic-drag", drag_coefficient=0.47)
    again = kairos.Scene.parse(scene.toml())
    assert again.toml() == scene.toml()
    assert np.array_equal(kairos.run(scene).position, kairos.run(again).position)


def test_values_come_as_python_and_numpy_write_them():
    plain = drop().toml()
    scene = kairos.Scene("drop", duration=np.float64(2))
    scene.wall("floor", shape="half-space", mass=None)  # None: not given
    scene.ball("ball", radius=np.float32(0.5) / 5, mass=np.int64(1), position=np.array([0, 5, 0]),
               restitution=0.9)
    run, same = kairos.run(scene.override("body.ball.radius", 0.1)), kairos.run(drop())
    assert np.array_equal(run.position, same.position)
    assert "mass = 1" in plain
    with pytest.raises(TypeError, match=r"body\.ball\.radius: is a complex"):
        kairos.Scene().ball("ball", radius=1j)


def test_messages_are_those_of_the_reader():
    wrong = refused(lambda: drop().ball("b", radius=-1, mass=1).check())
    assert wrong.key == "body.b.radius" and wrong.line == 0
    assert str(wrong).startswith("body.b.radius: is -1; allowed: a number from")
    assert 'did you mean "radius"' in str(refused(lambda: drop().ball("b", radios=1).check()))
    text = 'duration = 1\n[[body]]\nname = "b"\nentity = "ball"\nradius = -1\nmass = 1\n'
    wrong = refused(lambda: kairos.Scene.parse(text, "my.toml").check())
    assert (wrong.file, wrong.line, wrong.key) == ("my.toml", 5, "body.b.radius")
    assert str(wrong) == f"my.toml:5: body.b.radius: {wrong.reason}"


def test_every_entity_is_a_method():
    for kind in kairos.Scene.entities():
        assert callable(getattr(kairos.Scene, kind.replace("-", "_")))
    scene = kairos.Scene("pad", duration=0.1).anti_gravity_pad("pad", half_extents=(1, 1, 1))
    assert scene.bodies == ["pad"]


def test_shipped_scenes_are_found_and_read():
    names = kairos.shipped_scenes()
    assert "bounce" in names and len(names) > 20
    for name in names:
        kairos.Scene.read(name).check()
    assert refused(lambda: kairos.Scene.read("bounse")).reason


def test_a_scene_of_the_thesis_format_takes_overrides_and_no_keys():
    scene = kairos.Scene.read("physworld")
    assert "TOML" in str(refused(lambda: scene.ball("b", radius=1)))
    assert refused(lambda: kairos.run(scene.override("body.no", 1))).key


def test_a_copy_is_a_scene_of_its_own():
    scene = drop()
    other = scene.copy().ball("other", radius=0.1, mass=1, position=(1, 5, 0))
    assert scene.bodies == ["floor", "ball"] and other.bodies == ["floor", "ball", "other"]


def test_explain_says_what_is_left_out():
    assert any("rotation" in topic for topic, _, _ in drop().explain())


def gas():
    scene = kairos.Scene("gas", duration=0.2, G=0.0)
    return scene.many("ball", entity="ball", count=20, radius=0.05, mass=1.0, velocity_deviation=1.0,
                      region={"min": (0, 0, 0), "max": (1, 1, 1)})


def test_many_bodies_and_other_lists_of_scene_files_are_methods():
    scene = gas()
    text = """name = "gas"
duration = 0.2
G = 0.0
[[many]]
name = "ball"
entity = "ball"
count = 20
radius = 0.05
mass = 1.0
velocity_deviation = 1.0
region = {min = [0, 0, 0], max = [1, 1, 1]}
"""
    same = kairos.run(kairos.Scene.parse(text))
    run = kairos.run(scene)
    assert len(run.bodies) == 20 and np.array_equal(run.position, same.position)
    assert len(kairos.run(gas().override("many.ball.count", 7)).bodies) == 7
    assert "region" in kairos.Scene.many.__doc__
    assert "many" in str(refused(lambda: kairos.Scene().many("m", count=-1).check()))
    assert refused(lambda: kairos.Scene().add("mny", name="m").check())
    # Every list of named tables that the reader knows is a method: none is listed here twice.
    from kairos import _kairos
    for table in _kairos.scene_keys(""):
        if "name" in _kairos.scene_keys(table):
            assert callable(getattr(kairos.Scene, table)), table


def test_friction_and_its_combination_are_keys():
    def slide(**keys):
        scene = kairos.Scene("slide", duration=0.5, frame="1/200", **keys)
        scene.wall("floor", shape="half-space", friction=0.4)
        return scene.body("box", entity="body", half_extents=(0.2, 0.1, 0.2), mass=1, friction=0.1,
                          position=(0, 0.1, 0), velocity=(1, 0, 0), restitution=0)

    def slowed(scene):
        run = kairos.run(scene, scheme="moreau-jean")
        assert run.ledger["friction"][-1] < 0
        return 1 - run.velocity[-1, run.index("box"), 0]

    # mu g t, of the pair's mu; the tolerance is a step of it
    for rule, mu in (("minimum", 0.1), ("geometric-mean", 0.2), ("product", 0.04)):
        wanted = min(1.0, mu * 9.8 * 0.5)
        assert abs(slowed(slide(friction_combine=rule)) - wanted) <= mu * 9.8 / 200 + 1e-9, rule
    wrong = refused(lambda: slide(friction_combine="least").check())
    assert wrong.key == "friction_combine"


@pytest.mark.parametrize("scheme", kairos.plug_ins()["scheme"])
def test_every_scheme_and_its_options_are_keywords(scheme):
    scene = drop()
    choice = {"scheme": scheme}
    if kairos.why_refused(scene, **choice):
        choice.update(detector="sat")
    assert kairos.why_refused(scene, **choice) == ""
    run = kairos.run(scene, duration=0.2, **choice)
    assert run.status == "completed" and run.summary["method"]["scheme"] == scheme


@pytest.mark.parametrize("law", kairos.plug_ins()["impact"])
def test_every_impact_law_is_a_keyword(law):
    reason = kairos.why_refused("cradle", impact=law)
    if not reason:
        run = kairos.run("cradle", impact=law, duration=1)
        assert run.cost["impacts"] > 0 and run.summary["method"]["impact"] == law


def test_joints_are_methods_with_the_keys_of_scene_files():
    """The shipped pendulum, built: the same bits."""
    def pendulum(**keys):
        scene = kairos.Scene("pendulum", duration=10.0, frame="1/60", G=9.8)
        scene.body("bar", entity="body", half_extents=(0.05, 0.5, 0.05), mass=1.0,
                   position=(0.45464871341284085, 0.2080734182735712, 0.0),
                   axis_angle=(0.0, 0.0, 1.0, 2.0))
        return scene.joint("pivot", **{"kind": "hinge", "bodies": ["bar"], "anchor": (0, 0, 0),
                                       "axis": (0, 0, 1), **keys})

    built, shipped = kairos.run(pendulum(), duration=1), kairos.run("pendulum", duration=1)
    assert np.array_equal(built.position, shipped.position)
    assert np.ptp(built.position[:, 0, 0]) > 0.1  # it swings
    assert refused(lambda: pendulum(kind="hinj").check()).key == "joint.pivot.kind"
    assert "axes" in str(refused(lambda: pendulum(axes=(0, 0, 1)).check()))


def test_convex_shapes_are_built_with_the_keys_of_scene_files():
    """A capsule, a cylinder, a cone and a hull fall; each stays above the floor."""
    scene = kairos.Scene("shapes", duration=0.5, frame="1/60", G=9.8)
    scene.wall("floor", shape="half-space")
    shapes = {"capsule": {"radius": 0.1, "length": 0.4}, "cylinder": {"radius": 0.1, "length": 0.4},
              "cone": {"radius": 0.2, "height": 0.4},
              "hull": {"points": [(0, 0, 0), (0.3, 0, 0), (0, 0.3, 0), (0, 0, 0.3)]}}
    for k, (shape, keys) in enumerate(shapes.items()):
        scene.body(shape, entity="body", shape=shape, mass=1.0, position=(k, 1.0, 0), **keys)
    run = kairos.run(scene)
    assert len(run.events) >= len(shapes)
    assert run.summary["metrics"]["max_depth"] == 0.0
    assert refused(lambda: scene.body("flat", entity="body", shape="cone", mass=1.0, radius=0.2,
                                      height=0.0).check()).key == "body.flat.height"
