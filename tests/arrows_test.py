"""Reads every include of the rooms and checks the arrows of the house.

    ccd -> core      integrators -> core      core -> nothing of ours
    simulation -> core, ccd, integrators      experiments, python -> simulation and below

Folders inside a room are layers too: there is no circle among the folders of the tree, at any depth.
usage: arrows_test.py SOURCE_DIR
"""

import pathlib
import re
import sys

MAY = {
    "core": {"core"},
    "ccd": {"core", "ccd"},
    "integrators": {"core", "integrators"},
    "simulation": {"core", "ccd", "integrators", "simulation"},
    "experiments": {"core", "ccd", "integrators", "simulation", "experiments"},
    "python": {"core", "ccd", "integrators", "simulation", "python"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def includes(root):
    """(file, quote, target) of every include of the rooms."""
    for room in MAY:
        for path in sorted((root / room).rglob("*.[ch]pp")):
            for line in path.read_text().splitlines():
                found = INCLUDE.match(line)
                if found:
                    yield path.relative_to(root), found[1], pathlib.PurePosixPath(found[2])


def is_umbrella(path):
    """ROOM/ROOM.hpp: for consumers, above all folders of its room; nothing of ours includes it."""
    return len(path.parts) == 2 and path.parts[0] in MAY and path.stem == path.parts[0]


def wrong_arrows(root, read):
    for source, quote, target in read:
        if is_umbrella(target) and not is_umbrella(source):
            yield f'{source}: "{target}" is for consumers'
        if quote == "<":
            if target.parts[0] == "kairos":
                yield f"{source}: our own headers are included from the root: <{target}>"
        elif not (root / target).is_file():
            yield f'{source}: "{target}" is not written from the root, or not ours'
        elif target.parts[0] not in MAY[source.parts[0]]:
            yield f'{source}: {source.parts[0]} may not include "{target}"'


def circles(read):
    """Groups of folders each of which includes, in the end, all others of the group."""
    arrows = {}
    for source, quote, target in read:
        inside = source.parent.as_posix() == target.parent.as_posix()
        if quote == '"' and not inside and not is_umbrella(source):
            arrows.setdefault(source.parent.as_posix(), {}).setdefault(
                target.parent.as_posix(), f"{source} -> {target}")

    def reach(start):
        seen, todo = set(), [start]
        while todo:
            for folder in arrows.get(todo.pop(), {}):
                if folder not in seen:
                    seen.add(folder)
                    todo.append(folder)
        return seen

    reached = {folder: reach(folder) for folder in arrows}
    told = set()
    for folder in sorted(arrows):
        circle = {other for other in reached[folder] if folder in reached.get(other, ())}
        if circle and folder not in told:
            told |= circle
            for a in sorted(circle):
                for b, witness in sorted(arrows[a].items()):
                    if b in circle:
                        yield f"circle of folders: {a} -> {b} ({witness})"


def main():
    root = pathlib.Path(sys.argv[1])
    read = list(includes(root))
    if len(read) < 500:
        sys.exit(f"read only {len(read)} includes: is SOURCE_DIR right?")
    wrong = [*wrong_arrows(root, read), *circles(read)]
    if wrong:
        sys.exit("arrows that must not be:\n  " + "\n  ".join(wrong))
    print(f"{len(read)} includes follow the arrows, without a circle")


if __name__ == "__main__":
    main()
