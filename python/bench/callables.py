"""What a force written in Python costs: per evaluation, beside the C++ force of the same formula.

usage: python3 callables.py [--rounds R]

A ball falls through air with rk4, quadratic drag by both; processor time in turns, the least of each.
"""

import argparse
import math
import time

import numpy as np

import kairos

DENSITY, COEFFICIENT, RADIUS = 1.225, 0.47, 0.1  # kg/m^3, 1, m
HALF = 0.5 * DENSITY * COEFFICIENT * math.pi * RADIUS ** 2


def scene():
    return kairos.Scene("drop", duration=20.0, frame="1/1000").ball(
        "ball", radius=RADIUS, mass=1.0, position=(0, 0, 0), velocity=(3, 0, 0))


def of_numpy(t, ball):
    return -HALF * np.linalg.norm(ball.velocity) * ball.velocity


def of_floats(t, ball):
    x, y, z = ball.velocity.tolist()
    k = -HALF * math.sqrt(x * x + y * y + z * z)
    return (k * x, k * y, k * z)


def timed(make):
    start = time.process_time()
    run = kairos.run(make(), integrator="rk4", motions=False)
    return time.process_time() - start, run


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    scenes = {"C++": lambda: scene().force("quadratic-drag", density=DENSITY,
                                           drag_coefficient=COEFFICIENT),
              "Python, numpy": lambda: scene().force(of_numpy, bodies="ball"),
              "Python, floats": lambda: scene().force(of_floats, bodies="ball")}
    least, runs = {}, {}
    for _ in range(rounds):
        for name, make in scenes.items():
            seconds, runs[name] = timed(make)
            least[name] = min(seconds, least.get(name, math.inf))
    calls = runs["C++"].cost["right_hand_sides"]
    print(f"{calls} evaluations; least of {rounds} rounds")
    for name in scenes:
        off = np.abs(runs[name].position - runs["C++"].position).max()
        print(f"{name:16}{least[name] / calls * 1e9:10.0f} ns an evaluation with its step, "
              f"off by at most {off:.1e} m of {np.abs(runs['C++'].position).max():.0f} m")


if __name__ == "__main__":
    main()
