"""The stock that CL files state is the one that is simulated, in the coordinates of the program, by every command."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.batch import run_batch
from trunnion.cl.read import read_cl
from trunnion.cli import main
from trunnion.jobs.view.viewing import prepare_view
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
PROJECT = 'machine = "dmu65"\ncl = ["part.apt"]\noutput = "part.h"\ncell_mm = 1.0\n'


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


def project(folder: Path, text: str) -> Path:
    file = folder / "part.toml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("stated", ["", 'stock = "cl"\n'])
def test_a_project_cuts_the_stock_of_its_cl_files(tmp_path: Path, stated: str) -> None:
    cl = written(tmp_path)
    file = project(tmp_path, stated + PROJECT + '[checks]\nsimulate = "refuse"\n')
    found = trunnion.post_project(file).simulation
    assert found is not None
    assert found.removed == pytest.approx(REMOVED, rel=1e-3)
    assert found.stock_from == str(cl)
    again = trunnion.simulate(file)
    assert again.removed == pytest.approx(REMOVED, rel=1e-3)
    assert again.stock_from == str(cl)


def test_a_project_without_any_stock_is_refused(tmp_path: Path) -> None:
    written(tmp_path, stock="")
    file = project(tmp_path, PROJECT + '[checks]\nsimulate = "warn"\n')
    with pytest.raises(trunnion.InputError, match="no CL file states it"):
        trunnion.post_project(file)
    file = project(tmp_path, 'machine = "dmu65"\nprograms = ["part.h"]\n')
    (tmp_path / "part.h").write_text("BEGIN PGM A MM\nEND PGM A MM\n", encoding="utf-8")
    with pytest.raises(trunnion.InputError, match="stock"):
        trunnion.simulate(file)


def test_the_frame_of_the_program_is_that_of_the_stock(tmp_path: Path) -> None:
    cl = written(tmp_path, "$$-> STOCK / BOX,40,60,10,40,0,-10\n", "MSYS/60,0,0,0,1,0,-1,0,0\n")
    place = tmp_path / "part.h"
    trunnion.post(cl, machine="dmu65", output=place, settings={"frame": "absolute"})
    how = {"machine": "dmu65", "cl": [cl], "settings": {"frame": "absolute"}}
    found = trunnion.simulate(place, cell=1.0, **how)  # type: ignore[arg-type]
    assert found.removed == pytest.approx(REMOVED, rel=1e-3)
    view = prepare_view(place, stock="cl", cell=1.0, **how)  # type: ignore[arg-type]
    assert view.stock is not None
    file = project(tmp_path, PROJECT + '[settings]\nframe = "absolute"\n')
    assert trunnion.simulate(file).removed == pytest.approx(REMOVED, rel=1e-3)


def test_a_batch_cuts_the_stock_of_each_cl_file(tmp_path: Path) -> None:
    for name, width in (("one", 60), ("two", 30)):
        cl = written(tmp_path, f"$$-> STOCK / BOX,{width},40,10,0,-20,-10\n", name=name)
        trunnion.post(cl, machine="dmu65", output=tmp_path / f"{name}.h")
    how = {"action": "simulate", "machine": "dmu65", "workers": 1}
    result = run_batch(tmp_path, results=tmp_path / "out", cl=["{folder}/{stem}.apt"], **how)  # type: ignore[arg-type]
    removed = [record.figures["removed_mm3"] for record in result.records()]
    assert result.passed
    assert removed == pytest.approx([REMOVED, REMOVED / 2], rel=0.05)  # within cells
    with pytest.raises(trunnion.InputError, match="stock"):
        run_batch(tmp_path, results=tmp_path / "out", **how)  # type: ignore[arg-type]


def test_a_view_shows_it_where_it_is_asked_for(tmp_path: Path) -> None:
    cl = written(tmp_path)
    place = tmp_path / "part.h"
    trunnion.post(cl, machine="dmu65", output=place)
    assert prepare_view(place, machine="dmu65", cl=[cl]).stock is None
    view = prepare_view(place, machine="dmu65", cl=[cl], stock="cl", cell=1.0)
    assert view.stock is not None
    assert prepare_view(project(tmp_path, PROJECT)).stock is not None
    with pytest.raises(trunnion.InputError, match="no CL file states it"):
        prepare_view(place, machine="dmu65", stock="cl", cl=[written(tmp_path, stock="")])


def test_a_place_keeps_it_on_the_table(tmp_path: Path) -> None:
    cl = written(tmp_path)
    how = {"machine": "dmu65", "turns": [0.0], "tilts": [0.0]}
    stated = trunnion.place(cl, stock="box:60,40,10,0,-20,-10", **how)  # type: ignore[arg-type]
    assert trunnion.place(cl, stock="cl", **how).zero_mm == stated.zero_mm  # type: ignore[arg-type]
    with pytest.raises(trunnion.InputError, match="no CL file states it"):
        trunnion.place(written(tmp_path, stock=""), stock="cl", **how)  # type: ignore[arg-type]
