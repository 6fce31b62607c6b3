"""Every public type and prototype says what it means: Doxygen reads the headers that are installed.

Members that are variables are left out (many are told by the comment of their struct), and so are
overrides, which mean what the function of their port says.
usage: docstrings_test.py DOXYGEN INCLUDE_DIR    (INCLUDE_DIR holds kairos/...)
"""

import pathlib
import re
import subprocess
import sys
import tempfile

SETTINGS = """
INPUT = "{include}"
FILE_PATTERNS = *.hpp
RECURSIVE = YES
OUTPUT_DIRECTORY = "{output}"
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = NO
EXTRACT_ALL = NO
HIDE_UNDOC_MEMBERS = NO
HIDE_UNDOC_CLASSES = NO
EXTRACT_LOCAL_CLASSES = NO
JAVADOC_AUTOBRIEF = YES
WARN_IF_UNDOCUMENTED = YES
QUIET = YES
"""
WARNING = re.compile(r"^(.*?):(\d+): warning: (.* is not documented\.)$")


def undocumented(doxygen, include):
    with tempfile.TemporaryDirectory() as output:
        settings = SETTINGS.format(include=include, output=output)
        done = subprocess.run([doxygen, "-"], input=settings, text=True, stderr=subprocess.PIPE,
                              check=True)
    for line in done.stderr.splitlines():
        found = WARNING.match(line)
        if not found or "(variable)" in found[3] or "(enumvalue)" in found[3]:
            continue
        path = pathlib.Path(found[1])
        source = path.read_text().splitlines()[int(found[2]) - 1]
        if " override" not in source:
            yield f"{path.relative_to(include)}:{found[2]}: {found[3]}"


def sees_what_is_missing(doxygen):
    """Whether this Doxygen complains at all."""
    with tempfile.TemporaryDirectory() as folder:
        header = pathlib.Path(folder) / "bare.hpp"
        header.write_text("/// A room.\nnamespace room {\nint bare(int x);\n}\n")
        return any("bare" in line for line in undocumented(doxygen, folder))


def main():
    doxygen, include = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    headers = list(include.rglob("*.hpp"))
    if len(headers) < 50:
        sys.exit(f"only {len(headers)} headers in {include}: is INCLUDE_DIR right?")
    if not sees_what_is_missing(doxygen):
        sys.exit("this Doxygen does not say what is undocumented")
    missing = sorted(undocumented(doxygen, include))
    if missing:
        sys.exit("public, and nothing says what it means:\n  " + "\n  ".join(missing))
    print(f"{len(headers)} public headers: every type and prototype has its docstring")


if __name__ == "__main__":
    main()
