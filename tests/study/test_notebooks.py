"""examples/notebooks: each runs from start to end, shows its pictures, and is stored without what it printed."""

import nbformat
import pytest
from nbclient import NotebookClient

BOOKS = {"control": 3, "calibration": 1}
"""Pictures that a notebook shows."""


def test_every_notebook_is_run(root):
    assert {path.stem for path in (root / "examples/notebooks").glob("*.ipynb")} == set(BOOKS)


@pytest.mark.parametrize("name", BOOKS)
def test_a_notebook_runs_from_start_to_end(name, root, command, fmu, tmp_path, monkeypatch):
    path = root / f"examples/notebooks/{name}.ipynb"
    book = nbformat.read(path, as_version=4)
    nbformat.validate(book)
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in code), "stored with outputs"
    for variable, value in (("COMMAND", command), ("FMU", fmu), ("NOTEBOOKS", tmp_path)):
        monkeypatch.setenv(f"COILWIND_{variable}", str(value))
    NotebookClient(book, timeout=300, kernel_name="python3", resources={"metadata": {"path": path.parent}}).execute()
    shown = [output for cell in code for output in cell.outputs]
    assert sum("image/png" in output.get("data", {}) for output in shown) == BOOKS[name]
    # %run tells of a script that failed in a line and goes on
    assert not [output for output in shown if output.output_type == "error" or output.get("name") == "stderr"], shown
