"""Sweeps and advice from Python."""

import numpy as np
import pytest

import kairos

SPEC = """
scene = "bounce"
metrics = ["impacts", "max_penetration"]
repeats = 5
reference = "event-driven"
[options]
duration = 1
frame = "= 1/30"
[set]
"body.ball.position" = [0, "= height", 0]
[[axis]]
name = "height"
linear = { from = 1, to = 4, count = 8 }
[[axis]]
name = "jolt"
random = { from = 0, to = 1 }
[[method]]
scheme = "original"
detector = "sat"
[[method]]
scheme = "event-driven"
"""
RUNS = 2 * 8 * 5


@pytest.fixture()
def spec(tmp_path):
    path = tmp_path / "spec.toml"
    path.write_text(SPEC)
    return path


def test_a_sweep_is_tables(program, spec, tmp_path):
    sweep = kairos.sweep(spec, out=tmp_path / "out")
    assert len(sweep.runs) == RUNS
    depth = sweep.runs["max_penetration"]
    methods = sweep.runs["method"]
    assert depth.dtype == float and depth[methods == "original"].max() > depth[methods == "event-driven"].max()
    assert sweep.summary["runs"].tolist() == [5.0] * 16
    with pytest.raises(KeyError, match="no column 'depth'; there are: run, method"):
        sweep.runs["depth"]
    assert sum(1 for _ in sweep.runs.rows()) == RUNS
    from_text = kairos.sweep(SPEC)
    assert open(from_text.runs.path).read() == open(sweep.runs.path).read()


def test_a_wrong_spec_is_named(program, tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text(SPEC.replace('name = "height"', 'nome = "height"'))
    with pytest.raises(kairos.InputError, match=r"wrong\.toml:\d+: .*nome"):
        kairos.sweep(path)


def test_a_table_becomes_a_data_frame_and_parquet(program, spec, tmp_path):
    sweep = kairos.sweep(spec, out=tmp_path / "out")
    pandas = pytest.importorskip("pandas")
    frame = sweep.runs.to_pandas(float_precision="round_trip")
    assert np.array_equal(frame["max_penetration"].to_numpy(), sweep.runs["max_penetration"])
    pytest.importorskip("pyarrow", reason="no pyarrow: Parquet is not tried")
    back = pandas.read_parquet(sweep.runs.to_parquet(tmp_path / "runs.parquet"))
    assert np.array_equal(back["max_penetration"].to_numpy(), sweep.runs["max_penetration"])


def test_tradeoff_and_recommend_take_a_scene_built_here(program):
    scene = kairos.Scene("fall", duration=0.5).wall("floor", shape="half-space")
    scene.ball("ball", radius=0.1, mass=1, position=(0, 1, 0), restitution=0.5)
    tables = kairos.tradeoff(scene).tables
    assert any("method" in table.columns and len(table) > 3 for table in tables.values())
    assert "event-driven" in kairos.recommend(scene, 1e-3)
