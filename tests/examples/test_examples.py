"""The examples run as they stand: scripts in an empty folder, the notebook with the outputs that it shows."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.support.locations import ROOT

EXAMPLES = ROOT / "examples"

#: Name of a script -> what its output contains, and the files that it leaves.
SCRIPTS = {
    "post_with_proof.py": ("blade.mpf: 154 motions, proven", ["blade.mpf"]),
    "verify_program.py": ("spoiled.mpf:52 (N520), line 20 of the CL file", ["spoiled.html", "spoiled.mpf"]),
    "convert_to_another_machine.py": ("the tool does the same", ["blade.cls", "head_head.mpf"]),
    "wrapped_text.py": ("175 mm³ removed, findings: 0", ["wrapped_text.apt", "wrapped_text.nc"]),
    "plan_and_inspect.py": ("BLADE_FINISH: TCP, 147 points", []),
}


def test_every_script_is_tried() -> None:
    assert {path.name for path in EXAMPLES.glob("*.py")} == set(SCRIPTS)
    assert [path.name for path in EXAMPLES.glob("*.ipynb")] == ["post_and_prove.ipynb"]


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_script_runs_in_an_empty_folder(name: str, tmp_path: Path) -> None:
    expected, files = SCRIPTS[name]
    command = [sys.executable, str(EXAMPLES / name)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert expected in done.stdout
    assert sorted(path.name for path in tmp_path.iterdir()) == files


def texts(notebook: Any) -> list[str]:
    """What the outputs of each code cell show."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    # What a cell prints may come in one piece or in several.
    return ["".join(one.get("text") or one["data"]["text/plain"] for one in cell.outputs) for cell in cells]


@pytest.mark.nightly
def test_the_notebook_runs_and_shows_what_it_holds() -> None:
    if "CI" not in os.environ:
        pytest.importorskip("nbclient")
        pytest.importorskip("ipykernel")
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(EXAMPLES / "post_and_prove.ipynb", as_version=4)
    nbformat.validate(notebook)
    shown = texts(notebook)
    folder = {"metadata": {"path": str(EXAMPLES)}}
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources=folder).execute()
    assert texts(notebook) == shown
    assert all(shown)
