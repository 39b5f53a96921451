"""The stock that CL files state is the one that is simulated, in the coordinates of the program."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.cl.read import read_cl
from trunnion.cli import main
from trunnion.simulation.stock.solids import stock_shape
from trunnion.simulation.stock.stated_stock import stated_stock

HEAD = "$$-> TRUNNION / 1\nUNITS/MM\n"
BOX = "$$-> STOCK / BOX,60,40,10,0,-20,-10\n"
CUT = (
    "LOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/-20,0,20\nRAPID\nGOTO/-20,0,-4\nFEDRAT/MMPM,500\nGOTO/80,0,-4\n"
    "RAPID\nGOTO/80,0,20\nSPINDL/OFF\nEND-OF-PATH\nFINI\n"
)
TOOL = "TOOL PATH/SLOT,TOOL,FLAT\n$$-> TOOL / MILL,DIAMETER,10,LENGTH,60,FLUTE,20\n"
ABSOLUTE = "MSYS/0,0,0,1,0,0,0,1,0\n"
REMOVED = 60.0 * 10.0 * 4.0


def written(folder: Path, stock: str = BOX, system: str = ABSOLUTE, name: str = "part") -> Path:
    file = folder / f"{name}.apt"
    file.write_text(HEAD + stock + TOOL + system + CUT, encoding="utf-8")
    return file


def test_a_post_cuts_the_stock_of_its_cl_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, place = written(tmp_path), tmp_path / "part.h"
    result = trunnion.post(file, machine="dmu65", output=place, simulation={"cell": 1.0})
    assert result.simulation is not None
    assert result.simulation.removed == pytest.approx(REMOVED, rel=1e-3)
    assert result.simulation.stock_from == str(file)
    assert any(f"stock as {file} states it" in str(check.answer) for check in result.checks if check.answer)
    stated = trunnion.post(file, machine="dmu65", simulation={"cell": 1.0, "stock": "box:30,40,10,0,-20,-10"})
    assert stated.simulation is not None
    assert stated.simulation.stock_from == ""
    assert stated.simulation.removed == pytest.approx(REMOVED / 2, rel=1e-3)
    capsys.readouterr()
    assert main(["simulate", str(place), "--machine", "dmu65", "--cl", str(file), "--cell", "1"]) == 0
    assert f"stock as {file} states it" in capsys.readouterr().out
    found = trunnion.simulate(place, machine="dmu65", cl=[file], cell=1.0)
    assert found.stock_from == str(file)
    assert found.removed == pytest.approx(REMOVED, rel=1e-3)


def test_no_stock_anywhere_is_an_error(tmp_path: Path) -> None:
    file = written(tmp_path, stock="")
    with pytest.raises(trunnion.InputError, match="no CL file states it"):
        trunnion.post(file, machine="dmu65", simulation={"cell": 1.0})


def test_stock_lies_in_the_coordinates_of_the_program(tmp_path: Path) -> None:
    turned = "MSYS/60,0,0,0,1,0,-1,0,0\n"  # X of the program is Y of the model
    toolpath = read_cl(written(tmp_path, "$$-> STOCK / BOX,40,60,10,40,0,-10\n", turned))
    found = stated_stock([toolpath])
    assert found is not None
    assert found.stock == "box:60,40,10,0,-20,-10"
    assert stated_stock([toolpath], absolute=True).stock == toolpath.stock  # type: ignore[union-attr]
    result = trunnion.post(tmp_path / "part.apt", machine="dmu65", simulation={"cell": 1.0})
    assert result.simulation is not None
    assert result.simulation.removed == pytest.approx(REMOVED, rel=1e-3)


def test_leaning_stock_is_a_mesh_and_an_upright_cylinder_stays_one(tmp_path: Path) -> None:
    leaning = read_cl(written(tmp_path, BOX, "MSYS/0,0,0,0.6,0,0.8,0,1,0\n"))
    mesh = stated_stock([leaning])
    assert mesh is not None
    (corner,) = mesh.stock.vertices[np.lexsort(mesh.stock.vertices.T)][:1]  # type: ignore[union-attr]
    np.testing.assert_allclose(corner, (0.6 * 60.0 - 0.8 * 10.0, -20.0, -0.8 * 60.0 - 0.6 * 10.0), atol=1e-9)
    raised = read_cl(written(tmp_path, "$$-> STOCK / CYLINDER,30,20,-20\n", "MSYS/0,0,5,0,1,0,-1,0,0\n"))
    upright = stated_stock([raised])
    assert upright is not None
    assert upright.stock == "cylinder:30,20,-25"
    beside = stated_stock([read_cl(written(tmp_path, "$$-> STOCK / CYLINDER,30,20,-20\n", "MSYS/9,0,0,1,0,0,0,1,0\n"))])
    assert beside is not None
    np.testing.assert_allclose(stock_shape(beside.stock).low, (-24.0, -15.0, -20.0), atol=0.03)  # facets


def test_a_block_form_is_that_of_the_stock_of_the_cl_file(tmp_path: Path) -> None:
    result = trunnion.post(written(tmp_path), machine="dmu65", settings={"blank": "stock"})
    text = str(result.text)
    assert "BLK FORM 0.1 Z X+0 Y-20 Z-10\n" in text
    assert "BLK FORM 0.2 X+60 Y+20 Z+0\n" in text
