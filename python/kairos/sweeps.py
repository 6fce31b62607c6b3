"""Sweeps and advice: the program's work, here and on other machines."""

from __future__ import annotations

import contextlib
import glob
import os
import re
import shutil
import tempfile

from .errors import ProgramError
from .program import call
from .scene import Scene, _find
from .tables import Table


class Sweep:
    """What a sweep left in a folder: `tables`, by name ("NAME_runs", "NAME_summary", ...)."""

    def __init__(self, folder):
        self.folder = os.fspath(folder)

    @property
    def tables(self) -> dict[str, Table]:
        paths = sorted(glob.glob(os.path.join(glob.escape(self.folder), "*.csv")))
        return {os.path.basename(path)[:-4]: Table(path) for path in paths}

    def _only(self, kind) -> Table:
        found = [table for name, table in self.tables.items() if name.endswith("_" + kind)]
        if len(found) != 1:
            raise KeyError(f"{len(found)} tables *_{kind} in {self.folder}; name one of tables")
        return found[0]

    @property
    def runs(self) -> Table:
        """A row per run, of a spec with one sweep."""
        return self._only("runs")

    @property
    def summary(self) -> Table:
        """Quartiles over repeats, of a spec with one sweep."""
        return self._only("summary")

    def __repr__(self):
        return f"<kairos.Sweep {self.folder}: {', '.join(self.tables)}>"


def _spec_file(spec, folder):
    """The path of a spec; its text is written to a file first."""
    if isinstance(spec, str) and "\n" in spec:
        path = os.path.join(folder, "sweep.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(spec)
        return path
    return os.path.abspath(os.fspath(spec))


@contextlib.contextmanager
def _folder(out):
    if out is not None:
        os.makedirs(out, exist_ok=True)
        yield os.fspath(out)
    else:
        yield tempfile.mkdtemp(prefix="kairos-")


def _size(full):
    return "--full" if full else "--quick"


def run_shard(spec: str, index: int, count: int, full: bool, threads: int) -> dict[str, bytes]:
    """One shard, in a folder of its own: its files. What a worker of a cluster is asked for; the
    worker has to have kairos, and the spec and its scene under the same path."""
    folder = tempfile.mkdtemp(prefix="kairos-shard-")
    try:
        call("sweep", spec, _size(full), "--shard", f"{index}/{count}", "--threads", threads,
             "--out", folder)
        files = {}
        for name in os.listdir(folder):
            with open(os.path.join(folder, name), "rb") as file:
                files[name] = file.read()
        return files
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _keep_shard(files, folder):
    os.makedirs(folder, exist_ok=True)
    for name, content in files.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)


def sweep(spec, *, out=None, full=False, threads=0, client=None, shards=None,
          progress=None) -> Sweep:
    """Runs a sweep: the path of a spec (TOML), or its text.

    out: folder of the tables (default: a temporary one). threads: 0: one per core.
    client: a dask.distributed.Client: shards are tasks of that cluster, on Kubernetes, Slurm, PBS
        or this machine. A worker that dies loses nothing: its shards are run again elsewhere.
    shards: how many (default: four for each core of the cluster). Tables are the same bytes,
        whatever their number and wherever they were run.
    progress: called with (shards done, shards) whenever one of the cluster's is.
    """
    with _folder(out) as folder:
        path = _spec_file(spec, folder if out is None else tempfile.mkdtemp(prefix="kairos-spec-"))
        if client is None:
            call("sweep", path, _size(full), "--threads", threads, "--out", folder)
            return Sweep(folder)
        count = shards or 4 * max(1, sum(client.ncores().values()))
        from dask.distributed import as_completed
        futures = {client.submit(run_shard, path, index, count, full, 1, pure=False): index
                   for index in range(1, count + 1)}
        parts = tempfile.mkdtemp(prefix="kairos-shards-")
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                _keep_shard(future.result(), os.path.join(parts, str(futures[future])))
                future.release()  # its rows are on the disk
                if progress is not None:
                    progress(done, count)
            return merge(parts, out=folder)
        finally:
            shutil.rmtree(parts, ignore_errors=True)


def merge(*folders, out) -> Sweep:
    """Merges shards: folders of shards, or folders of such folders. Raises `InputError` that names
    a shard that is missing, there twice, not finished, or of another spec or version."""
    call("sweep", "--merge", *folders, "--out", out)
    return Sweep(out)


@contextlib.contextmanager
def _scene_file(scene):
    if not isinstance(scene, Scene):
        yield _find(scene)
        return
    with tempfile.TemporaryDirectory(prefix="kairos-") as folder:
        path = os.path.join(folder, re.sub(r"[^A-Za-z0-9_-]", "-", scene.name) + ".toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene.toml())
        yield path


def tradeoff(scene, *, duration=None, out=None, threads=0) -> Sweep:
    """What accuracy costs on a scene: every sensible method, its errors and its counted work.
    `.tables` holds them by name. duration: s, instead of the scene's."""
    with _folder(out) as folder, _scene_file(scene) as path:
        limits = ["--duration", duration] if duration is not None else []
        call("tradeoff", path, *limits, "--threads", threads, "--rounds", 1, "--out", folder)
        return Sweep(folder)


class Recommendation:
    """What `recommend` found: `pick`, the name of the cheapest method that does (None: none does),
    its `options` as the program takes them, `table` with a row per method in the order of its work,
    and `text`, what the program prints."""

    def __init__(self, text, table):
        self.text = text
        self.table = table
        chosen = [row for row in table.rows() if row["recommended"] == "1"]
        self.pick = chosen[0]["method"] if chosen else None
        self.options = chosen[0]["options"] if chosen else None

    def _repr_html_(self):
        from html import escape
        heads = "".join(f"<th>{escape(name)}</th>" for name in self.table.columns)
        rows = "".join("<tr>" + "".join(f"<td>{escape(text)}</td>" for text in row.values()) + "</tr>"
                       for row in self.table.rows())
        return f"<p>{escape(self.text.splitlines()[0])}</p><table><tr>{heads}</tr>{rows}</table>"

    def __str__(self):
        return self.text

    def __repr__(self):
        return f"<kairos.Recommendation: {self.pick or 'none'}>"


def recommend(scene, error, *, penetration=None, duration=None, threads=0) -> Recommendation:
    """The cheapest method that meets a bound on a scene, with the evidence. error: of a position at
    the end, m; penetration: deepest, m. Where none meets it, `pick` is None."""
    path = os.path.join(tempfile.mkdtemp(prefix="kairos-"), "recommend.csv")
    with _scene_file(scene) as scene_path:
        limits = ["--penetration", penetration] if penetration is not None else []
        limits += ["--duration", duration] if duration is not None else []
        try:
            text = call("recommend", scene_path, "--error", error, *limits, "--threads", threads,
                        "--csv", path)
        except ProgramError as none_does:
            if not os.path.isfile(path):
                raise
            text = str(none_does)
    return Recommendation(text, Table(path))
