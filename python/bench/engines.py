"""One sweep on four engines: the same bytes, and what each engine costs beside the runs.

usage: python3 engines.py SPEC.toml FOLDER [--shards N]

One process of two threads; shards by GNU parallel, two at a time; a Slurm array on two daemons of
this machine (tests/python/loopback_slurm.py); Dask with two workers, one of which is killed at work.
All use two cores. Told: seconds of the wall clock for the runs and for merging without the figure;
processor time of all of it, the engine's own processes included (of Slurm, its daemons and the tasks,
not what starts them), with the figure; and what that is above one process, per run.
"""

import argparse
import filecmp
import logging
import os
import re
import resource
import shlex
import signal
import subprocess
import sys
import threading
import time

import kairos

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CLUSTERS = os.path.join(SOURCE, "experiments", "clusters")
sys.path.append(os.path.join(SOURCE, "tests", "python"))


def tables(folder):
    return sorted(name for name in os.listdir(folder)
                  if name.endswith(("_runs.csv", "_summary.csv")))


def without_figure(*arguments):
    """Seconds that `kairos sweep ARGUMENTS` took without the figure, and with it."""
    start = time.monotonic()
    done = subprocess.run([kairos.program(), "sweep", *arguments], check=True, text=True,
                          capture_output=True)
    took = time.monotonic() - start
    return took - float(re.search(r"figures in ([0-9.]+) s", done.stdout)[1]), took


def processor():
    """Seconds of this process and of all that it has waited for."""
    return sum(getattr(resource.getrusage(who), what)
               for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
               for what in ("ru_utime", "ru_stime"))


def timed_program(path, log):
    """A script that runs the program and adds its processor time to a log: tasks of Slurm are no
    children of ours."""
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/usr/bin/env bash\nTIMEFORMAT='%U %S'\n"
                   f"{{ time {shlex.quote(kairos.program())} \"$@\" 2>&3; }} 3>&2 2>>{shlex.quote(log)}\n")
    os.chmod(path, 0o755)
    return path


def one_process(choice, out):
    return without_figure(choice.spec, "--threads", "2", "--out", out)[0]


def gnu_parallel(choice, out):
    start = time.monotonic()
    subprocess.run([CLUSTERS + "/sweep-parallel", choice.spec, str(choice.shards), out + "-shards"],
                   check=True, capture_output=True,
                   env={**os.environ, "PARALLEL": "--jobs 2", "KAIROS_PROGRAM": kairos.program()})
    return time.monotonic() - start


def slurm_array(choice, out):
    import loopback_slurm
    with loopback_slurm.cluster() as surroundings:
        start = time.monotonic()
        subprocess.run(["sbatch", f"--array=1-{choice.shards}", f"--output={out}.%a.log",
                        CLUSTERS + "/sweep.slurm", choice.spec, out + "-shards"], check=True,
                       capture_output=True,
                       env={**surroundings,
                            "KAIROS_PROGRAM": timed_program(out + ".program", out + ".times")})
        while subprocess.run(["squeue", "--noheader"], env=surroundings, check=True,
                             capture_output=True).stdout:
            time.sleep(0.05)
        return time.monotonic() - start


def dask_with_a_death(choice, out):
    from dask.distributed import Client, LocalCluster
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                      host="127.0.0.1", silence_logs=logging.CRITICAL) as cluster, \
            Client(cluster) as client:
        victim = list(client.run(os.getpid).values())[0]
        killer = threading.Timer(1.0, os.kill, (victim, signal.SIGKILL))
        start = time.monotonic()
        killer.start()
        kairos.sweep(choice.spec, client=client, shards=choice.shards, out=out)
        took = time.monotonic() - start
        killer.join()
        if took < 1.5:
            raise SystemExit("Dask was done before its worker was killed: take more runs")
        return took


ENGINES = {"one process": one_process, "GNU parallel": gnu_parallel, "Slurm": slurm_array,
           "Dask": dask_with_a_death}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("spec", type=os.path.abspath)
    parser.add_argument("folder", type=os.path.abspath)
    parser.add_argument("--shards", type=int, default=8)
    choice = parser.parse_args()
    os.makedirs(choice.folder, exist_ok=True)
    print(f"{'':16}{'ran, s':>10}{'merged, s':>12}{'processor, s':>14}{'above one, us a run':>22}"
          f"{'tables':>16}")
    first = runs = merging = None
    for name, engine in ENGINES.items():
        out = os.path.join(choice.folder, name.replace(" ", "-"))
        before = processor()
        ran, merged = engine(choice, out), 0.0
        if os.path.isdir(out + "-shards"):
            merging = without_figure("--merge", out + "-shards", "--out", out)
            merged = merging[0]
        elif name == "Dask":  # merged by kairos.sweep, and drawn: as long as the last ones
            ran, merged = ran - merging[1], merging[0]
        spent = processor() - before
        if os.path.isfile(out + ".times"):
            with open(out + ".times", encoding="utf-8") as file:
                spent += sum(float(number) for line in file for number in line.split())
        if first is None:
            first, base = out, spent
            runs = sum(len(kairos.Table(os.path.join(out, table))) for table in tables(out)
                       if table.endswith("_runs.csv"))
        same = tables(out) == tables(first) and all(
            filecmp.cmp(os.path.join(out, table), os.path.join(first, table), shallow=False)
            for table in tables(out))
        print(f"{name:16}{ran:10.2f}{merged:12.2f}{spent:14.2f}{(spent - base) / runs * 1e6:22.1f}"
              f"{'the same bytes' if same else 'DIFFER':>16}", flush=True)
    print(f"{runs} runs, {choice.shards} shards")


if __name__ == "__main__":
    main()
