"""The program kairos and its data: sweeps, advice and figures are its work."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import sys
import sysconfig

from .errors import InputError, ProgramError


@functools.lru_cache(maxsize=None)
def program() -> str:
    """Path of the program: $KAIROS_PROGRAM, the one installed beside this package, the one on PATH.
    Raises `ProgramError`."""
    here = os.path.dirname(os.path.abspath(__file__))
    beside = [os.path.join(sysconfig.get_path("scripts"), "kairos"),
              os.path.join(sys.prefix, "bin", "kairos")]
    # PREFIX/lib/python3/dist-packages/kairos, and the like, of an installation by CMake
    folder = here
    for _ in range(5):
        folder = os.path.dirname(folder)
        beside.append(os.path.join(folder, "bin", "kairos"))
    for path in [os.environ.get("KAIROS_PROGRAM", ""), *beside, shutil.which("kairos") or ""]:
        if path and os.access(path, os.X_OK) and os.path.isfile(path):
            return path
    raise ProgramError("the program kairos is not found; install it, or set KAIROS_PROGRAM")


@functools.lru_cache(maxsize=None)
def data_folder(name: str) -> str:
    """Folder of data that came with the program (scenes, figures); "" where there is none."""
    try:
        beside = os.path.join(os.path.dirname(os.path.dirname(program())), "share", "kairos", name)
    except ProgramError:
        beside = ""
    given = os.environ.get("KAIROS_DATA", "")
    for folder in (os.path.join(os.path.abspath(given), name) if given else "", beside):
        if folder and os.path.isdir(folder):
            return folder
    return ""


@functools.lru_cache(maxsize=None)
def viewer_page() -> str:
    """Text of the page of `kairos view`, without runs. Raises `ProgramError` where it is not there."""
    here = os.path.dirname(program())
    for folder in (os.path.join(here, "..", "share", "kairos", "studio"),
                   os.path.join(here, "..", "studio")):  # installed; in the build tree
        path = os.path.join(folder, "viewer.html")
        if os.path.isfile(path):
            with open(path, encoding="utf-8") as file:
                return file.read()
    raise ProgramError("the page of kairos view is not built beside the program "
                       f"{program()}; that takes Node and npm")


def call(*arguments, input_text=None) -> str:
    """Runs `kairos ARGUMENTS` and returns what it prints. Raises `InputError` where the input is
    wrong, `ProgramError` otherwise; Ctrl-C ends it."""
    done = subprocess.run([program(), *map(os.fspath, map(str, arguments))], text=True,
                          capture_output=True, input=input_text)
    if done.returncode == 2:
        raise InputError("", 0, "", done.stderr.strip())
    if done.returncode != 0:
        raise ProgramError(f"kairos {arguments[0]}: {done.stderr.strip()}", done.returncode)
    return done.stdout
