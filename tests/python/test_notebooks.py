"""Every notebook runs from its first cell to its last, in a folder of its own."""

import glob
import os

import pytest

from conftest import SOURCE

nbclient = pytest.importorskip("nbclient", reason="apt-get install python3-nbclient python3-ipykernel")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel", reason="apt-get install python3-ipykernel")
pytest.importorskip("matplotlib")

NOTEBOOKS = sorted(glob.glob(os.path.join(SOURCE, "python", "notebooks", "*.ipynb")))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[os.path.basename(path)[:-6] for path in NOTEBOOKS])
def test_a_notebook_runs(path, program, tmp_path, monkeypatch):
    monkeypatch.delenv("MPLBACKEND", raising=False)  # as in a notebook: figures are outputs
    notebook = nbformat.read(path, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells)  # none is kept in the tree
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3",
                            resources={"metadata": {"path": str(tmp_path)}}).execute()
    said = [out for cell in notebook.cells for out in cell.get("outputs", [])]
    assert said and not any(out.output_type == "error" for out in said)
    assert any("image/png" in out.get("data", {}) for out in said)  # figures are seen in it
    pictures = glob.glob(str(tmp_path / "*.png"))
    assert pictures and all(os.path.getsize(picture) > 5000 for picture in pictures)


def test_there_are_three():
    assert len(NOTEBOOKS) == 3
