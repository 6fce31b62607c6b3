"""Batches of questions: the Python package beside the batch that a C++ programmer writes.

usage: python3 compare.py LIBRARY [--count N] [--rounds R] [--threads T]

LIBRARY is libkairos_cpp_batch.so (build target kairos_cpp_batch). Both answer the same questions in
turns, so that what disturbs the machine disturbs both: the least processor time of each is told, and
the median of the ratios of neighbours. Bodies are made of numbers on all cores by the package.
"""

import argparse
import ctypes
import resource
import statistics
import time

import numpy as np

import kairos

SEED = 20261


def draw(count, kind, rng, space):
    """Bodies at random: (count, 19) as the library takes them."""
    turn = rng.normal(size=(count, 4))
    size = rng.uniform(0.2, 0.8, (count, 3))
    return np.ascontiguousarray(np.concatenate([
        size, rng.uniform(-space, space, (count, 3)),
        turn / np.linalg.norm(turn, axis=1, keepdims=True), rng.uniform(-2, 2, (count, 3)),
        rng.uniform(-9, 9, (count, 3)), rng.uniform(-3, 3, (count, 3))], axis=1))


def bodies(kind, x):
    size = {"box": x[:, :3], "sphere": x[:, 0]}[kind]
    make = {"box": kairos.boxes, "sphere": kairos.spheres}[kind]
    return make(size, position=x[:, 3:6], orientation=x[:, 6:10], velocity=x[:, 10:13],
                acceleration=x[:, 13:16], angular_velocity=x[:, 16:19])


def load(path):
    library = ctypes.CDLL(path)
    library.batch_new.restype = ctypes.c_void_p
    for name, kinds in (("delete", []), ("fill", [ctypes.c_bool, ctypes.c_int, ctypes.c_size_t,
                                                    ctypes.c_void_p]),
                        ("toi", [ctypes.c_double, ctypes.c_size_t]), ("overlap", [ctypes.c_size_t]),
                        ("distance", [ctypes.c_size_t]), ("sums", [ctypes.c_void_p])):
        function = getattr(library, "batch_" + name)
        function.argtypes = [ctypes.c_void_p, *kinds]
        function.restype = None
    return library


def cpu(function):
    wall, start = time.perf_counter(), time.process_time()
    function()  # answers are dropped: both find memory that was used before
    return time.process_time() - start, time.perf_counter() - wall


def race(title, count, rounds, ours, theirs):
    ours(), theirs()
    times = []
    for i in range(rounds):
        pair = [None, None]
        for k in ((0, 1), (1, 0))[i % 2]:  # neither is always first
            pair[k] = cpu((ours, theirs)[k])
        times.append(pair)
    least = [min(t[k][0] for t in times) / count * 1e9 for k in (0, 1)]
    ratio = statistics.median(t[0][0] / t[1][0] for t in times)
    walls = statistics.median(t[0][1] / t[1][1] for t in times)
    print(f"{title:34}{least[0]:12.1f}{least[1]:10.1f}{least[0] / least[1]:10.3f}{ratio:10.3f}"
          f"{walls:10.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("library")
    parser.add_argument("--count", type=int, default=200_000)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--threads", type=int, default=1)
    choice = parser.parse_args()
    library = load(choice.library)
    print(f"{choice.count} pairs, {choice.threads} threads, {choice.rounds} rounds in turns; "
          "processor time, ns a pair")
    print(f"{'':34}{'Python':>12}{'C++':>10}{'least':>10}{'median':>10}{'wall':>10}")
    for kinds in (("box", "box"), ("sphere", "box"), ("sphere", "sphere")):
        rng = np.random.default_rng(SEED)
        columns = [draw(choice.count, kind, rng, 3) for kind in kinds]
        batch = library.batch_new()
        name = " ".join(kinds)
        race(f"bodies of numbers, {name}", choice.count, choice.rounds,
             lambda: [bodies(kind, x) for kind, x in zip(kinds, columns)],
             lambda: [library.batch_fill(batch, side == 0, kinds[side] == "sphere", choice.count,
                                         columns[side].ctypes.data) for side in (0, 1)])
        a, b = (bodies(kind, x) for kind, x in zip(kinds, columns))
        race(f"toi, {name}", choice.count, choice.rounds,
             lambda: kairos.toi(a, b, 1.0, threads=choice.threads),
             lambda: library.batch_toi(batch, 1.0, choice.threads))
        race(f"distance, {name}", choice.count, choice.rounds,
             lambda: kairos.distance(a, b, threads=choice.threads),
             lambda: library.batch_distance(batch, choice.threads))
        race(f"overlap, {name}", choice.count, choice.rounds,
             lambda: kairos.overlap(a, b, threads=choice.threads),
             lambda: library.batch_overlap(batch, choice.threads))
        sums = np.zeros(3)
        library.batch_sums(batch, sums.ctypes.data)
        toi = kairos.toi(a, b, 1.0)
        ours = [0.0, 0.0, float(kairos.overlap(a, b).sum())]
        for row in toi["t_lo"] + toi["t_hi"] + toi["gap"]:
            ours[0] += row
        for gap in kairos.distance(a, b)["gap"]:
            ours[1] += gap
        if ours != sums.tolist():
            raise SystemExit(f"other answers: {ours} and {sums.tolist()}")
        library.batch_delete(batch)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"the same sums of all answers; peak memory of the process {memory:.0f} MiB")


if __name__ == "__main__":
    main()
