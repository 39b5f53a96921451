"""``trunnion view``: it takes what ``simulate`` takes, and writes over nothing that it reads."""

from pathlib import Path

import pytest

import trunnion
from tests.support.simulating import STOCK, TOOL, cuboid
from tests.support.stepped_slot import write_slot
from trunnion.cli import main
from trunnion.simulation.meshes import save_mesh


def test_the_verdict_of_the_page_is_said_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, page = tmp_path / "a.mpf", tmp_path / "a.html"
    program.write_text("G71 G90 G54 D1\nG0 X0 Y0 Z50\nG1 X9 F100\nM30\n")
    assert main(["view", str(program), "--machine", "yl569", "--output", str(page)]) == 0
    assert "\nFailed: " in capsys.readouterr().out
    assert trunnion.write_view(program, machine="yl569", output=page).startswith("Failed: ")


def test_it_takes_what_simulate_takes(tmp_path: Path) -> None:
    program, given = write_slot(tmp_path)
    page = tmp_path / "view.html"
    options = ["--machine", given["machine"], "--stock", STOCK, "--part", str(given["part"]), "--tool", TOOL]
    assert main(["view", str(program), *options, "--cell", "1", "--near", "2", "--output", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert 'id="stock-states"' in text
    assert "rapid through stock" in text


def test_it_writes_over_no_stock(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, given = write_slot(tmp_path)
    stock = tmp_path / "stock.html"  # a mesh by its content, and the name that a page may have
    save_mesh(cuboid((0.0, -20.0, -10.0), (50.0, 20.0, 0.0)), tmp_path / "stock.stl")
    stock.write_bytes((tmp_path / "stock.stl").read_bytes())
    before = stock.read_bytes()
    options = ["--machine", given["machine"], "--tool", TOOL, "--stock", str(stock)]
    assert main(["view", str(program), *options, "--output", str(stock)]) == 2
    assert "stock.html" in capsys.readouterr().err
    assert stock.read_bytes() == before


def test_what_belongs_to_stock_is_told_in_options(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, given = write_slot(tmp_path)
    page = tmp_path / "view.html"
    assert main(["view", str(program), "--machine", given["machine"], "--cell", "1", "--output", str(page)]) == 2
    assert "--cell" in capsys.readouterr().err
    assert not page.exists()
