"""Sweeps from Python, and on the engines of clusters: the same bytes, whatever was killed."""

import logging
import os
import shutil
import signal
import subprocess
import threading
import time
import tracemalloc

import numpy as np
import pytest

import kairos
import loopback_slurm
from conftest import SOURCE

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


def differences(a, b):
    """Names of tables whose bytes differ; times do, and pictures are not compared."""
    def tables(folder):
        return {name for name in os.listdir(folder)
                if name.endswith((".csv", ".toml")) and name not in ("timings.csv", "figures.csv")}

    assert tables(a) == tables(b)
    return [name for name in tables(a)
            if open(os.path.join(a, name), "rb").read() != open(os.path.join(b, name), "rb").read()]


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


def test_a_table_becomes_columns_that_numpy_maps(program, spec, tmp_path):
    sweep = kairos.sweep(spec, out=tmp_path / "out")
    paths = sweep.runs.to_npy(tmp_path / "columns")
    assert list(paths) == sweep.runs.columns
    for name, path in paths.items():
        column = np.load(path, mmap_mode="r")
        wanted = sweep.runs[name]
        if wanted.dtype == float:
            assert column.dtype == float and np.array_equal(column, wanted, equal_nan=True), name
        else:
            assert column.dtype.kind == "S" and np.array_equal(column, np.char.encode(wanted)), name
    assert len(os.listdir(tmp_path / "columns")) == len(paths)


def test_columns_of_a_long_table_take_no_memory(tmp_path):
    """300,000 rows, 30 MB of text, within 8 MB: blocks of 10,000 rows."""
    path = tmp_path / "long.csv"
    with open(path, "w", encoding="utf-8") as file:
        file.write("run,method,x,gap\n")
        for i in range(300_000):
            gap = '' if i % 3 else repr(i / 11)
            file.write(f"{i},{'é' * (i % 7)},{i / 7!r},{gap}\n")
    tracemalloc.start()
    paths = kairos.Table(path).to_npy(tmp_path / "columns")
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 8e6, most
    runs = np.arange(300_000)
    assert np.array_equal(np.load(paths["x"]), runs / 7)
    assert np.array_equal(np.load(paths["gap"]), np.where(runs % 3, np.nan, runs / 11), equal_nan=True)
    assert np.load(paths["method"])[6].decode() == "éééééé"


def test_tradeoff_and_recommend_take_a_scene_built_here(program):
    scene = kairos.Scene("fall", duration=0.5).wall("floor", shape="half-space")
    scene.ball("ball", radius=0.1, mass=1, position=(0, 1, 0), restitution=0.5)
    tables = kairos.tradeoff(scene).tables
    assert any("method" in table.columns and len(table) > 3 for table in tables.values())
    advice = kairos.recommend(scene, 1e-3)
    assert "event-driven" in str(advice) and "event-driven auto" in advice.table["method"]
    pick = advice.table["method"].tolist().index(advice.pick)
    assert advice.table["recommended"].sum() == advice.table["recommended"][pick] == 1
    assert advice.table["end_error"][pick] <= 1e-3
    assert np.all(np.diff(advice.table["work"]) >= 0) and advice.pick in advice._repr_html_()
    none = kairos.recommend("drag-drop", 1e-300, duration=0.5)
    assert none.pick is None and all(none.table["shortcoming"])


def test_merging_names_what_is_missing(program, spec, tmp_path):
    for k in (1, 3):
        program("sweep", spec, "--shard", f"{k}/3", "--out", tmp_path / f"s{k}")
    with pytest.raises(kairos.InputError, match="of 3 shards these are missing: 2"):
        kairos.merge(tmp_path / "s1", tmp_path / "s3", out=tmp_path / "out")


def test_gnu_parallel_goes_on_after_shards_were_killed(program, spec, tmp_path):
    if not shutil.which("parallel"):
        pytest.skip("GNU parallel is not installed")
    script = os.path.join(SOURCE, "experiments", "clusters", "sweep-parallel")
    command = [script, str(spec), "6", str(tmp_path / "shards")]
    once = tmp_path / "once"  # a line a try; the first six are killed, 1 to 6 ms after their start
    flaky = tmp_path / "flaky"
    flaky.write_text(f"""#!/bin/sh
echo x >> {once}
tries=$(wc -l < {once})
if [ "$tries" -le 6 ]; then
  "{os.environ['KAIROS_PROGRAM']}" "$@" & child=$!
  sleep "0.00$tries"; kill -KILL $child; wait $child; exit $?
fi
exec "{os.environ['KAIROS_PROGRAM']}" "$@"
""")
    flaky.chmod(0o755)
    surroundings = {**os.environ, "KAIROS_PROGRAM": str(flaky)}
    first = subprocess.run(command, env=surroundings, capture_output=True, text=True)
    tries = 1
    while tries < 6 and subprocess.run(command, env=surroundings, capture_output=True).returncode:
        tries += 1
    assert first.returncode != 0  # shards were killed
    kairos.sweep(spec, out=tmp_path / "one")
    kairos.merge(tmp_path / "shards", out=tmp_path / "merged")
    assert differences(tmp_path / "one", tmp_path / "merged") == []


def test_dask_loses_nothing_with_a_worker_killed(program, spec, tmp_path):
    distributed = pytest.importorskip("distributed", reason="apt-get install python3-distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True,
                                  dashboard_address=None, host="127.0.0.1",
                                  silence_logs=logging.ERROR) as cluster, \
            distributed.Client(cluster) as client:
        victim = list(client.run(os.getpid).values())[0]
        killer = threading.Timer(0.3, os.kill, (victim, signal.SIGKILL))
        killer.start()
        started = time.monotonic()
        told = []
        result = kairos.sweep(spec, client=client, shards=12, out=tmp_path / "dask",
                              progress=lambda done, shards: told.append((done, shards)))
        assert told == [(k, 12) for k in range(1, 13)]
        killer.join()
        assert time.monotonic() - started > 0.2  # it was at work
    kairos.sweep(spec, out=tmp_path / "one")
    assert len(result.runs) == RUNS
    assert differences(tmp_path / "one", tmp_path / "dask") == []


@pytest.fixture(scope="module")
def slurm():
    """The environment of a Slurm controller with two daemons."""
    if loopback_slurm.missing():
        pytest.skip(f"apt-get install slurm-wlm: there is no {', '.join(loopback_slurm.missing())}")
    with loopback_slurm.cluster() as surroundings:
        yield surroundings


def array_of(slurm, spec, shards, folder, *options):
    """Submits the array script as it is; returns the number of the job."""
    script = os.path.join(SOURCE, "experiments", "clusters", "sweep.slurm")
    said = subprocess.run(["sbatch", "--parsable", f"--array=1-{shards}", *options,
                           f"--output={folder}.%a.log", script, str(spec), str(folder)],
                          env=slurm, check=True, text=True, capture_output=True).stdout
    return said.strip().split(";")[0]


def wait_for(slurm, job, seconds=120):
    end = time.monotonic() + seconds
    while subprocess.run(["squeue", "--noheader", f"--job={job}"], env=slurm, text=True,
                         capture_output=True).stdout.strip():
        assert time.monotonic() < end, subprocess.run(
            ["squeue", "--long"], env=slurm, text=True, capture_output=True).stdout
        time.sleep(0.2)


def waits_for_its_time(slurm, task):
    """Slurm starts a requeued task two minutes later, unless it is told otherwise."""
    told = subprocess.run(["squeue", "--noheader", f"--job={task}", "--format=%T %r"], env=slurm,
                          text=True, capture_output=True).stdout
    return told.strip() == "PENDING BeginTime"


def test_a_slurm_array_loses_nothing_with_a_task_requeued(program, slurm, tmp_path):
    """A controller and two daemons; a task at work is killed and requeued, and goes on."""
    spec = tmp_path / "spec.toml"
    spec.write_text(SPEC.replace("repeats = 5", "repeats = 6000"))  # some seconds
    shards = tmp_path / "shards"
    job = array_of(slurm, spec, 4, shards)
    rows = shards / "1" / "spec.rows"
    end = time.monotonic() + 60
    while not (rows.exists() and rows.stat().st_size > 10000):
        assert time.monotonic() < end
        time.sleep(0.01)
    subprocess.run(["scontrol", "requeue", f"{job}_1"], env=slurm, check=True)
    assert not (shards / "1" / "shard.csv").exists()  # it was at work
    while not waits_for_its_time(slurm, f"{job}_1"):  # its processes have ended
        assert time.monotonic() < end
        time.sleep(0.1)
    kept = rows.stat().st_size
    subprocess.run(["scontrol", "update", f"JobId={job}_1", "StartTime=now"], env=slurm, check=True)
    told = subprocess.run(["scontrol", "show", "job", f"{job}_1"], env=slurm, check=True, text=True,
                          capture_output=True).stdout
    assert "Restarts=1" in told
    wait_for(slurm, job)
    assert rows.stat().st_size > kept
    kairos.merge(shards, out=tmp_path / "merged")
    kairos.sweep(spec, out=tmp_path / "one")
    assert len(kairos.Sweep(tmp_path / "merged").runs) == 2 * 8 * 6000
    assert differences(tmp_path / "one", tmp_path / "merged") == []


def test_some_tasks_of_a_slurm_array_are_submitted_again(program, slurm, spec, tmp_path):
    shards = tmp_path / "shards"
    wait_for(slurm, array_of(slurm, spec, 3, shards))
    shutil.rmtree(shards / "2")
    with pytest.raises(kairos.InputError, match="of 3 shards these are missing: 2"):
        kairos.merge(shards, out=tmp_path / "merged")
    script = os.path.join(SOURCE, "experiments", "clusters", "sweep.slurm")
    subprocess.run(["sbatch", "--wait", "--array=2", f"--output={shards}.again.log", script,
                    str(spec), str(shards)], check=True, capture_output=True,
                   env={**slurm, "KAIROS_SHARDS": "3"})
    kairos.merge(shards, out=tmp_path / "merged")
    kairos.sweep(spec, out=tmp_path / "one")
    assert differences(tmp_path / "one", tmp_path / "merged") == []


def test_the_array_script_is_what_slurm_would_run(program, spec, tmp_path):
    """The script by itself, with the variables that Slurm sets."""
    script = os.path.join(SOURCE, "experiments", "clusters", "sweep.slurm")

    def task(k, count=3, **more):
        return subprocess.run(["bash", script, str(spec), str(tmp_path / "shards")], text=True,
                              capture_output=True,
                              env={**os.environ, "SLURM_ARRAY_TASK_ID": str(k),
                                   "SLURM_ARRAY_TASK_MIN": "1", "SLURM_ARRAY_TASK_MAX": "3",
                                   "SLURM_ARRAY_TASK_COUNT": str(count), **more})

    assert [task(k).returncode for k in (1, 2)] == [0, 0]
    assert "of how many shards?" in task(3, count=1).stderr
    assert task(3, count=1, KAIROS_SHARDS="3").returncode == 0
    kairos.sweep(spec, out=tmp_path / "one")
    kairos.merge(tmp_path / "shards", out=tmp_path / "merged")
    assert differences(tmp_path / "one", tmp_path / "merged") == []
