"""The README's lines of Python run as printed."""

import os
import re
import subprocess
import sys

from conftest import SOURCE


def test_the_lines_of_the_readme_run_as_printed(tmp_path):
    with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
        blocks = re.findall(r"```python\n(.*?)```", file.read(), flags=re.DOTALL)
    assert len(blocks) == 1
    lines = [line for line in blocks[0].splitlines() if line and not line.startswith("import")]
    assert len(lines) == 10
    said = subprocess.run([sys.executable, "-c", blocks[0]], cwd=tmp_path, check=True, text=True,
                          capture_output=True).stdout.splitlines()
    assert len(said) >= 3
    assert float(re.search(r"sinks in by ([0-9.e-]+) m", "\n".join(said))[1]) > 0.0
    assert abs(float(said[-1].strip("[]")) - 1.0) < 1e-6  # sqrt(2 * 4.9 / 9.8), as it is printed
