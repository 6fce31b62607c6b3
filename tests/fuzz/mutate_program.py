#!/usr/bin/env python3
"""Runs the program on mutated scenes, specs, queries and options, and watches how it ends.

usage: mutate_program.py FORKED_PROGRAM [--count N] [--first K] [--seed S] [--jobs J] [--seconds T] [--out DIR]

FORKED_PROGRAM (build/PRESET/tests/fuzz/forked_program) is the program, started once and forked for each
case. Written from the manuals alone (scenes/README.md, experiments/README.md, `kairos --help`), not from
the readers. Each case is a function of (seed, number): `--first K --count 1` makes it again.

A case is right if it ends by itself with exit code 0, 1 or 2, with a reason on stderr where it is
not 0, within T seconds of processor time. What takes longer is run once more on a terminal, where
the program says what it does: if simulated time or events go on, that is its reason ("at work");
if not, it is a hang. Programs built with sanitizers report what they find.
"""

import argparse
import collections
import concurrent.futures
import dataclasses
import os
import pathlib
import pty
import queue
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")
EXTREMES = ["0", "-0.0", "1", "-1", "2", "0.5", "1e-320", "1e-300", "1e-15", "1e-9", "1e-3", "1e3",
            "1e9", "1e12", "1e100", "1e300", "1.7e308", "-1e300", "nan", "inf", "-inf",
            "9223372036854775807", "9223372036854775808", "-9223372036854775808", "4294967296",
            "0x7fffffff", "1_000", "true", "\"\"", "[]", "{}", "[[]]", "\"x\"", "1979-05-27"]
BYTES = ["\0", "\x01", "\x7f", "\xff", "\u2028", "\"", "'", "\\", "\n", "\r", "[", "]", "{", "}", "=",
         ".", ",", "#", "-", "e", "\"\"\"", "\\u0000", "../", "%", "{}", " " * 70, "a" * 70]
# Of a sanitizer's allocator, which ends the program where others throw std::bad_alloc.
NO_MEMORY = re.compile(r"AddressSanitizer: (allocator is )?out[- ]of[- ]memory|failed to allocate")
FAULTS = ("signal", "sanitizer", "hang", "exit code", "silent")
SANITIZER = re.compile(r"runtime error:|ERROR: \w*Sanitizer|Assertion .* failed")


def read(path):
    return path.read_text(encoding="utf-8", errors="replace")


class Corpus:
    """What the project ships: texts to mutate, and the words in them."""

    def __init__(self, program, folder):
        self.scenes = {p: read(p) for p in sorted((ROOT / "scenes").glob("*.toml"))}
        self.defs = {p: read(p) for p in sorted((ROOT / "scenes").glob("*.def"))}
        specs = {p: read(p) for p in sorted((ROOT / "experiments" / "specs").glob("*.toml"))}
        # Programs of experiments do a fixed amount of work, of minutes.
        self.specs = {p: t for p, t in specs.items() if "\nprogram =" not in t}
        texts = list(self.scenes.values()) + list(self.specs.values())
        self.words = sorted({w for t in texts for w in re.findall(r"[A-Za-z][\w-]+", t)})
        self.lines = sorted({line for t in texts for line in t.splitlines() if "=" in line})
        self.names = collections.defaultdict(list)
        program.run(["list", "--csv"], folder, Bounds(seconds=60))
        for line in read(program.out).splitlines()[1:]:
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
        if draw.random() < 0.97:
            text = re.sub(r"\bduration = (\{[^}\n]*\}|\"[^\"\n]*\"|[-+.\de]+)",
                          lambda _: f"duration = {10 ** draw.uniform(-3, -1):.3g}", text)
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


@dataclasses.dataclass
class Bounds:
    seconds: int  # of processor time
    wait: int = 600  # seconds until a program that does nothing is ended
    memory: int = 3 << 30  # bytes beyond what the program has when it starts
    whole: bool = True  # ends as the program does; else without what is done at its very end


@dataclasses.dataclass
class Ending:
    signal: int  # 0: none
    code: int
    seconds: float  # of processor time


class ForkedProgram:
    """The program, started once; `run` forks it."""

    def __init__(self, path, place):
        environment = dict(os.environ,
                           ASAN_OPTIONS="exitcode=99:detect_leaks=0:malloc_context_size=2",
                           UBSAN_OPTIONS="exitcode=98:halt_on_error=1:print_stacktrace=1")
        self.process = subprocess.Popen([path], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        env=environment)
        self.out, self.err = place / "stdout", place / "stderr"

    def run(self, words, folder, bounds, err=None):
        fields = [str(bounds.seconds), str(bounds.wait), str(bounds.memory), str(int(bounds.whole)),
                  str(folder), str(self.out), str(err or self.err)] + words
        fields = [str(len(fields))] + [field.replace("\0", "") for field in fields]
        request = "".join(field + "\0" for field in fields)
        self.process.stdin.write(request.encode(errors="surrogateescape"))
        self.process.stdin.flush()
        kind, number, seconds = self.process.stdout.readline().split()
        number = int(number)
        return Ending(number if kind == b"signal" else 0, number if kind == b"exit" else 0,
                      float(seconds))


def at_work(program, words, folder, bounds):
    """What the program says on a terminal in the time that it has."""
    master, slave = pty.openpty()
    shown = []

    def listen():
        try:
            while block := os.read(master, 65536):
                shown[:] = [(b"".join(shown) + block)[-4096:]]
        except OSError:
            pass  # how a terminal ends

    listener = threading.Thread(target=listen)
    listener.start()
    program.run(words, folder, bounds, os.ttyname(slave))
    os.close(slave)
    listener.join()
    os.close(master)
    text = b"".join(shown).decode(errors="replace").split("\r")
    told = [line for line in text if re.search(r"[1-9]\d* events|\] [1-9]\d*/|[1-9]\d* of |, one at ",
                                                   line)]
    progress = [line for line in text if "] " in line]
    moved = re.search(r"\] ([\d.e+-]+) of", progress[-1]) if progress else None
    if told or (moved and float(moved.group(1)) > 0):
        return (told or progress)[-1].strip("\x1b[K\n ")
    return None


def verdict_of(program, words, folder, bounds):
    """(verdict, detail, seconds) of a command."""
    end = program.run(words, folder, bounds)
    err = read(program.err)
    if NO_MEMORY.search(err):
        return "no memory", err[-3000:], end.seconds
    if SANITIZER.search(err) or end.code in (98, 99):
        return "sanitizer", err[-3000:], end.seconds
    if end.signal == signal.SIGALRM:
        return "hang", "waits without working", end.seconds
    if end.signal in (signal.SIGXCPU, signal.SIGKILL):
        told = at_work(program, words, folder, bounds)
        return ("at work", told, end.seconds) if told else ("hang", err[-500:], end.seconds)
    if end.signal:
        return "signal", f"{signal.Signals(end.signal).name} {err[-2000:]}", end.seconds
    if end.code > 2:
        return "exit code", f"{end.code} {err[-500:]}", end.seconds
    if end.code > 0 and not err.strip():
        return "silent", f"exit {end.code} without a reason", end.seconds
    return f"exit {end.code}", err, end.seconds


def judge(number, program, corpus, arguments):
    """(verdict, detail, words, seconds) of a case."""
    with tempfile.TemporaryDirectory(prefix="kairos-mutant-") as name:
        folder = pathlib.Path(name)
        words = case(number, arguments.seed, corpus, folder)
        verdict, detail, seconds = verdict_of(program, words, folder,
                                              Bounds(arguments.seconds, whole=number % 16 == 0))
        if verdict in FAULTS + ("no memory",) and arguments.out:
            kept = pathlib.Path(arguments.out) / f"case-{arguments.seed}-{number}"
            shutil.copytree(folder, kept, symlinks=True, dirs_exist_ok=True)
            (kept / "verdict.txt").write_text(f"{verdict}\n{words}\n{detail}\n")
        return verdict, detail, words, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="forked_program of a build, best one with sanitizers")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=int, default=5, help="of processor time for each")
    parser.add_argument("--out", help="folder for what went wrong")
    parser.add_argument("--times", action="store_true", help="processor time by command, at the end")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="kairos-mutator-") as place:
        run(arguments, pathlib.Path(place))


def run(arguments, place):
    path = os.path.abspath(arguments.program)
    programs = queue.SimpleQueue()
    for k in range(arguments.jobs):
        (place / str(k)).mkdir()
        programs.put(ForkedProgram(path, place / str(k)))
    program = programs.get()
    corpus = Corpus(program, place)
    programs.put(program)

    def one(number):
        program = programs.get()
        try:
            return judge(number, program, corpus, arguments)
        finally:
            programs.put(program)

    print(f"seed {arguments.seed}, cases {arguments.first} to "
          f"{arguments.first + arguments.count - 1}", flush=True)
    tally, spent, reasons, wrong = collections.Counter(), collections.defaultdict(list), [], 0
    numbers = range(arguments.first, arguments.first + arguments.count)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for number, (verdict, detail, words, seconds) in zip(numbers, pool.map(one, numbers)):
            tally[verdict] += 1
            spent[words[0], verdict].append(seconds)
            if verdict == "at work":
                reasons.append((number, detail))
            elif verdict in FAULTS:
                wrong += 1
                print(f"case {number}: {verdict}: {' '.join(words)[:300]}\n  "
                      f"{detail.strip()[-600:]}", flush=True)
    for number, detail in reasons:
        print(f"case {number}: at work after {arguments.seconds} s: {detail}")
    if arguments.times:
        for (command, verdict), times in sorted(spent.items(), key=lambda item: -sum(item[1])):
            print(f"{sum(times):9.2f} s  {len(times):6} of {command}, {verdict}, "
                  f"most {max(times):.2f} s")
    print(", ".join(f"{verdict}: {count}" for verdict, count in sorted(tally.items())))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
