#!/usr/bin/env python3
"""Runs the program on mutated scenes, specs, queries and options, and watches how it ends.

usage: mutate_program.py PROGRAM [--count N] [--first K] [--seed S] [--jobs J] [--seconds T] [--out DIR]

Written from the manuals alone (scenes/README.md, experiments/README.md, `kairos --help`), not from
the readers. Each case is a function of (seed, number): `--first K --count 1` makes it again.

A case is right if it ends by itself with exit code 0, 1 or 2, with a reason on stderr where it is
not 0, within T seconds of processor time. What takes longer is run once more on a terminal, where
the program says what it does: if simulated time or events go on, that is its reason ("at work");
if not, it is a hang. Programs built with sanitizers report what they find.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import pty
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")
EXTREMES = ["0", "-0.0", "1", "-1", "2", "0.5", "1e-320", "1e-300", "1e-15", "1e-9", "1e-3", "1e3",
            "1e9", "1e12", "1e100", "1e300", "1.7e308", "-1e300", "nan", "inf", "-inf",
            "9223372036854775807", "9223372036854775808", "-9223372036854775808", "4294967296",
            "0x7fffffff", "1_000", "true", "\"\"", "[]", "{}", "[[]]", "\"x\"", "1979-05-27"]
BYTES = ["\0", "\x01", "\x7f", "\xff", "\u2028", "\"", "'", "\\", "\n", "\r", "[", "]", "{", "}", "=",
         ".", ",", "#", "-", "e", "\"\"\"", "\\u0000", "../", "%", "{}", " " * 70, "a" * 70]
SANITIZER = re.compile(r"runtime error:|ERROR: \w*Sanitizer|Assertion .* failed")


def read(path):
    return path.read_text(encoding="utf-8", errors="replace")


class Corpus:
    """What the project ships: texts to mutate, and the words in them."""

    def __init__(self, program):
        self.scenes = {p: read(p) for p in sorted((ROOT / "scenes").glob("*.toml"))}
        self.defs = {p: read(p) for p in sorted((ROOT / "scenes").glob("*.def"))}
        specs = {p: read(p) for p in sorted((ROOT / "experiments" / "specs").glob("*.toml"))}
        # Programs of experiments do a fixed amount of work, of minutes.
        self.specs = {p: t for p, t in specs.items() if "\nprogram =" not in t}
        texts = list(self.scenes.values()) + list(self.specs.values())
        self.words = sorted({w for t in texts for w in re.findall(r"[A-Za-z][\w-]+", t)})
        self.lines = sorted({line for t in texts for line in t.splitlines() if "=" in line})
        self.names = collections.defaultdict(list)
        listing = subprocess.run([program, "list", "--csv"], capture_output=True, text=True,
                                 check=True).stdout
        for line in listing.splitlines()[1:]:
            kind, name = line.split(",")[:2]
            self.names[kind].append(name)
        self.keys = self.override_keys()

    def override_keys(self):
        keys = set()
        for text in self.scenes.values():
            body = None
            for line in text.splitlines():
                match = re.match(r'\s*([\w.]+)\s*=', line)
                named = re.match(r'\s*name\s*=\s*"([^"]+)"', line)
                if line.startswith("[[body]]"):
                    body = ""
                elif body == "" and named:
                    body = named.group(1)
                elif match and body:
                    keys.add(f"body.{body}.{match.group(1)}")
                elif match:
                    keys.add(match.group(1))
        return sorted(keys)


def mutated(text, draw, corpus):
    """One to four changes, each of a kind that a person or a broken disk could make."""
    mild = draw.random() < 0.5  # other numbers only: most of these are read, and run
    for _ in range(draw.choice([1, 1, 1, 2, 3, 4])):
        kind = 3 if mild else draw.randrange(11)
        lines = text.split("\n")
        at = draw.randrange(len(lines))
        numbers = list(NUMBER.finditer(text))
        if kind <= 2 and numbers:
            hit = draw.choice(numbers)
            text = text[:hit.start()] + draw.choice(EXTREMES) + text[hit.end():]
        elif kind == 3 and numbers:
            hit = draw.choice(numbers)
            scaled = float(hit.group()) * draw.choice([-1, 0.5, 2, 1e-6, 1e-3, 1e3, 1e6, 1 + 1e-9])
            text = text[:hit.start()] + repr(scaled) + text[hit.end():]
        elif kind == 4:
            del lines[at:at + draw.randint(1, 3)]
            text = "\n".join(lines)
        elif kind == 5:
            end = min(len(lines), at + draw.randint(1, 8))
            other = draw.randrange(len(lines) + 1)
            text = "\n".join(lines[:other] + lines[at:end] + lines[other:])
        elif kind == 6:
            lines.insert(at, draw.choice(corpus.lines))
            text = "\n".join(lines)
        elif kind == 7:
            place = draw.randrange(len(text) + 1)
            text = text[:place] + draw.choice(BYTES) + text[place + draw.randint(0, 3):]
        elif kind == 8:
            words = list(re.finditer(r"[A-Za-z][\w-]+", text))
            if words:
                hit = draw.choice(words)
                text = text[:hit.start()] + draw.choice(corpus.words) + text[hit.end():]
        elif kind == 9:
            text = text[:draw.randrange(len(text) + 1)]
        else:
            other = draw.choice(list(corpus.scenes.values()))
            text = text[:draw.randrange(len(text) + 1)] + other[draw.randrange(len(other)):]
        text = text or "\n"
    return text


def value(draw):
    return draw.choice(EXTREMES) if draw.random() < 0.2 else f"{10 ** draw.uniform(-6, 3):.3g}"


def options(draw, corpus, duration=True):
    """Of `kairos run`; the duration is short most of the time, so that 5 s are a fair bound."""
    words = []
    for flag, kind in (("--scheme", "schemes"), ("--integrator", "integrators"),
                       ("--detector", "detectors"), ("--impact", "impact-laws")):
        if draw.random() < 0.35:
            words += [flag, draw.choice(corpus.names[kind] + ["", "none"])]
    for flag in ("--frame", "--step", "--threshold", "--max-substeps", "--tolerance",
                 "--relative-tolerance", "--absolute-tolerance"):
        if draw.random() < 0.12:
            words += [flag, value(draw)]
    for flag in ("--thesis", "--equal-substeps", "--roundoff"):
        if draw.random() < 0.08:
            words.append(flag)
    while draw.random() < 0.25:
        words += ["--set", f"{draw.choice(corpus.keys)}={value(draw)}"]
    if duration and draw.random() < 0.9:
        words += ["--duration", f"{10 ** draw.uniform(-3, 0):.3g}"]
    if draw.random() < 0.02:
        words.append(draw.choice(["--", "-", "--help", "--fly", "--set", "extra"]))
    return words


QUERY = [f"{b}_{c}" for b in "ab" for c in
         ("hx hy hz px py pz qw qx qy qz vx vy vz ax ay az wx wy wz").split()]


def queries(draw, corpus):
    rows = ["id," + ",".join(QUERY) + ",duration"]
    for k in range(draw.randint(1, 6)):
        row = []
        for body in range(2):
            row += [f"{draw.uniform(0.1, 2):.4f}" for _ in range(3)]
            row += [f"{draw.uniform(-3, 3) + 4 * body:.4f}" for _ in range(3)]
            row += ["1", "0", "0", "0"]
            row += [f"{draw.uniform(-2, 2):.4f}" for _ in range(9)]
        rows.append(f"q{k}," + ",".join(row) + f",{draw.uniform(0.1, 5):.3f}")
    text = "\n".join(rows) + "\n"
    return mutated(text, draw, corpus) if draw.random() < 0.8 else text


def case(number, seed, corpus, folder):
    """The command of a case; its files are in `folder`."""
    draw = random.Random(f"{seed}/{number}")

    def file(name, text):
        path = folder / name
        path.write_text(text, encoding="utf-8", errors="replace")
        return str(path)

    def scene():
        if draw.random() < 0.25:
            return draw.choice(corpus.names["scenes"])
        if draw.random() < 0.1:
            return file("world.def", mutated(draw.choice(list(corpus.defs.values())), draw, corpus))
        return file("scene.toml", mutated(draw.choice(list(corpus.scenes.values())), draw, corpus))

    for shared in ("recordings", "object_files", "piston.csv"):
        (folder / shared).symlink_to(ROOT / "scenes" / shared)
    kind = draw.random()
    if kind < 0.55:
        words = ["run", scene()] + options(draw, corpus)
        if draw.random() < 0.3:
            words += ["--out", str(folder / "out")]
        if draw.random() < 0.1:
            words += ["--save", str(folder / "saved"), "--save-interval", "0"]
        return words
    if kind < 0.63:
        return ["explain", scene()]
    if kind < 0.78:
        text = mutated(draw.choice(list(corpus.specs.values())), draw, corpus)
        # Small, so that 5 s are a fair bound: few repeats, short runs.
        text = re.sub(r"full = \d+", "full = 1", re.sub(r"quick = \d+", "quick = 1", text))
        text = re.sub(r"count = \d+", "count = 2", text)
        words = ["sweep", file("spec.toml", text), "--threads", "1"]
        return words + (["--out", str(folder / "out")] if draw.random() < 0.2 else [])
    if kind < 0.92:
        words = ["toi", file("queries.csv", queries(draw, corpus))]
        if draw.random() < 0.3:
            words += ["--detector", draw.choice(corpus.names["detectors"])]
        if draw.random() < 0.3:
            words += ["--tolerance", value(draw)]
        return words + (["--keep-going"] if draw.random() < 0.5 else [])
    if kind < 0.95:
        return ["recommend", scene(), "--error", value(draw), "--duration",
                f"{10 ** draw.uniform(-2, -0.5):.3g}", "--threads", "1"]
    if kind < 0.97:
        return ["list"] + [draw.choice(corpus.words) for _ in range(draw.randrange(3))]
    return draw.choice([["record", "--out", str(folder / "out"), "--strokes", value(draw),
                         "--rate", value(draw), "--noise", value(draw)],
                        ["random-scenes", "--count", "3", "--first", value(draw)],
                        ["render", str(folder), "--out", str(folder / "out"), "--every", value(draw)],
                        ["experiment", draw.choice(corpus.words)],
                        ["bench", draw.choice(corpus.words)]])


def limits(seconds, memory):
    def set_them():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if memory:
            resource.setrlimit(resource.RLIMIT_AS, (memory << 20, memory << 20))
    return set_them


def at_work(command, folder, arguments):
    """What the program says on a terminal in the time that it has."""
    master, slave = pty.openpty()
    process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=slave,
                               preexec_fn=limits(arguments.seconds, 0))
    os.close(slave)
    shown = b""
    until = time.monotonic() + 60
    while time.monotonic() < until:
        try:
            block = os.read(master, 4096)
        except OSError:
            break
        if not block:
            break
        shown = (shown + block)[-4096:]
    process.kill()
    process.wait()
    os.close(master)
    text = shown.decode(errors="replace").split("\r")
    told = [line for line in text if re.search(r"[1-9]\d* events|\] [1-9]\d*/|[1-9]\d* of ", line)]
    progress = [line for line in text if "] " in line]
    moved = re.search(r"\] ([\d.e+-]+) of", progress[-1]) if progress else None
    if told or (moved and float(moved.group(1)) > 0):
        return (told or progress)[-1].strip("\x1b[K\n ")
    return None


def judge(number, corpus, arguments):
    """(verdict, detail) of a case."""
    with tempfile.TemporaryDirectory(prefix="kairos-mutant-") as name:
        folder = pathlib.Path(name)
        words = case(number, arguments.seed, corpus, folder)
        words = [w.replace("\0", "") for w in words]
        command = [arguments.program] + words
        environment = dict(os.environ,
                           ASAN_OPTIONS="exitcode=99:detect_leaks=0:hard_rss_limit_mb=3000",
                           UBSAN_OPTIONS="exitcode=98:halt_on_error=1:print_stacktrace=1")
        memory = 0 if arguments.sanitized else 3000
        try:
            done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL,
                                  capture_output=True, env=environment, timeout=600,
                                  preexec_fn=limits(arguments.seconds, memory), check=False)
        except subprocess.TimeoutExpired:
            done = None  # it waits, and works not even so long
        err = done.stderr.decode(errors="replace") if done else ""
        if done is None:
            verdict = "hang", "waits without working"
        elif SANITIZER.search(err) or done.returncode in (98, 99):
            verdict = "sanitizer", err[-3000:]
        elif done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            told = at_work(command, folder, arguments)
            verdict = ("at work", told) if told else ("hang", err[-500:])
        elif done.returncode < 0:
            verdict = "signal", f"{signal.Signals(-done.returncode).name} {err[-2000:]}"
        elif done.returncode > 2:
            verdict = "exit code", f"{done.returncode} {err[-500:]}"
        elif done.returncode > 0 and not err.strip():
            verdict = "silent", f"exit {done.returncode} without a reason"
        else:
            verdict = f"exit {done.returncode}", err
        if verdict[0] in ("signal", "sanitizer", "hang", "exit code", "silent") and arguments.out:
            kept = pathlib.Path(arguments.out) / f"case-{arguments.seed}-{number}"
            shutil.copytree(folder, kept, symlinks=True, dirs_exist_ok=True)
            (kept / "verdict.txt").write_text(f"{verdict[0]}\n{words}\n{verdict[1]}\n")
        return verdict[0], verdict[1], words


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=int, default=5, help="of processor time for each")
    parser.add_argument("--sanitized", action="store_true", help="no limit of address space")
    parser.add_argument("--out", help="folder for what went wrong")
    arguments = parser.parse_args()
    arguments.program = os.path.abspath(arguments.program)
    corpus = Corpus(arguments.program)
    print(f"seed {arguments.seed}, cases {arguments.first} to "
          f"{arguments.first + arguments.count - 1}", flush=True)
    tally, reasons, wrong = collections.Counter(), [], 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        numbers = range(arguments.first, arguments.first + arguments.count)
        jobs = {pool.submit(judge, n, corpus, arguments): n for n in numbers}
        for job in concurrent.futures.as_completed(jobs):
            verdict, detail, words = job.result()
            tally[verdict] += 1
            if verdict == "at work":
                reasons.append((jobs[job], detail))
            elif not verdict.startswith("exit ") or verdict == "exit code":
                wrong += 1
                print(f"case {jobs[job]}: {verdict}: {' '.join(words)[:300]}\n  "
                      f"{detail.strip()[-600:]}", flush=True)
    for number, detail in sorted(reasons):
        print(f"case {number}: at work after {arguments.seconds} s: {detail}")
    print(", ".join(f"{verdict}: {count}" for verdict, count in sorted(tally.items())))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
