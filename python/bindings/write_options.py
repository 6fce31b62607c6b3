"""Writes the stub of the keywords of `kairos.run` from the library's own table of options.

usage: PYTHONPATH=FOLDER_OF_KAIROS python3 write_options.py OUT.pyi
"""

import sys

import kairos

TYPES = {"name": "str", "number": "Union[float, str]", "count": "int", "flag": "bool",
         "duration": "Union[float, str]", "frames": "Union[float, str, os.PathLike]"}


def main(path):
    lines = ["# Written when the package is built, from simulation/option.cpp.", "import os",
             "from typing import Literal, TypedDict, Union", "", "class Options(TypedDict, total=False):"]
    names = kairos.plug_ins()
    for row in kairos.options():
        known = names.get(row["name"])
        kind = f"Literal[{', '.join(map(repr, known))}]" if known else TYPES[row["kind"]]
        lines.append(f"    {row['name']}: {kind}  # {row['help']}" + (f" ({row['unit']})" if row["unit"] else ""))
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
