"""What the tests of the Python package share."""

import os
import subprocess

import pytest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


@pytest.fixture(scope="session")
def program():
    """The program kairos of this build: tests compare with it."""
    path = os.environ.get("KAIROS_PROGRAM", "")
    if not os.path.isfile(path):
        pytest.skip("KAIROS_PROGRAM names no program: it was not built")

    def run(*arguments, check=True, **options):
        return subprocess.run([path, *map(str, arguments)], check=check, text=True,
                              capture_output=True, **options)

    return run
