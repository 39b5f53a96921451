"""``trunnion.simulate``: what it is given, and what it refuses."""

import json
from pathlib import Path

import pytest

import trunnion
from tests.support.simulating import SLOT, STOCK, TOOL, cuboid, simulate, slotted
from trunnion.cli import main
from trunnion.simulation.meshes import load_mesh, save_mesh


def test_meshes_that_are_odd_are_told(tmp_path: Path) -> None:
    small = cuboid((0, 0, 0), (0.05, 0.04, 0.01))
    save_mesh(small, tmp_path / "metres.stl")
    for which in ("stock", "part", "fixtures"):
        with pytest.raises(trunnion.InputError, match="look like metres; export it in mm"):
            simulate(tmp_path, SLOT, **{which: str(tmp_path / "metres.stl")})
    save_mesh(cuboid((0, -20, -10), (50, 20, 0)).turned_out(), tmp_path / "inside.stl")
    turned = simulate(tmp_path, SLOT, stock=tmp_path / "inside.stl")
    assert [one for one in turned.remarks if "inside out" in one.what]
    assert turned.removed == pytest.approx(2500.0, rel=1e-3)


@pytest.mark.parametrize(
    ("argument", "value"),
    [("nc", 5), ("nc", []), ("tools", [7]), ("fixtures", 3), ("part", 4), ("cell", -1.0), ("threads", 0)],
)
def test_an_argument_that_is_none_is_named(tmp_path: Path, argument: str, value: object) -> None:
    given: dict[str, object] = {"nc": tmp_path / "part.ngc", "machine": "xyzac_trt", "stock": STOCK, "tools": TOOL}
    (tmp_path / "part.ngc").write_text(SLOT)
    assert trunnion.simulate(**given, cell=1.0).passed  # type: ignore[arg-type]
    with pytest.raises(trunnion.InputError) as raised:
        trunnion.simulate(**given | {argument: value})  # type: ignore[arg-type]
    assert raised.value.problems[0].file == argument


@pytest.mark.parametrize("stock", ["box:1,2", "box:0,1,1", "box:a,1,1", "cylinder:1,2,3,4", "box:1e9,1,1"])
def test_stock_that_is_none_is_refused(tmp_path: Path, stock: str) -> None:
    with pytest.raises(trunnion.InputError, match=r"write box:X,Y,Z"):
        simulate(tmp_path, SLOT, stock=stock)


def test_a_cell_for_which_there_is_no_memory_is_refused_with_one_that_does(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match=r"cells of 0\.\d+ mm take less than 3 GB"):
        simulate(tmp_path, SLOT, cell=0.0001)


def test_a_file_that_is_no_program_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="give a program of xyzac_trt"):
        simulate(tmp_path, "".join(f"line {k} of a text\n" for k in range(30)))


@pytest.mark.parametrize(
    ("stock", "words"),
    [
        ("box:50,40,9.5,0,-20,-10", "reaches 0.500 mm beyond the stock"),
        ("cylinder:70,10,-10", "before anything is cut"),
    ],
)
def test_a_part_that_its_stock_does_not_hold_fails(tmp_path: Path, stock: str, words: str) -> None:
    part = cuboid((-30, -30, -10), (30, 30, 0)) if stock.startswith("cyl") else slotted(5.0)
    found = simulate(tmp_path, SLOT, stock=stock, part=part, until=60, cell=1.0)
    assert not found.passed
    assert [one.file for one in found.remarks if words in one.what] == ["part"]
    with pytest.raises(trunnion.InputError, match="more than half of a cell"):
        simulate(tmp_path, SLOT, accuracy=0.6, cell=1.0)


def test_the_command_says_it_in_text_and_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nc = tmp_path / "part.ngc"
    nc.write_text(SLOT.replace("N60 G1 X70 F500", "N60 G0 X70"))
    given = [str(nc), "--machine", "xyzac_trt", "--stock", STOCK, "--tool", TOOL, "--cell", "0.5"]
    assert main(["simulate", *given, "--json", str(tmp_path / "out.json")]) == 1
    text = capsys.readouterr().out
    data = json.loads((tmp_path / "out.json").read_text())
    assert "part.ngc:7: N60 rapid through stock: tool 1, stock: 5.000 mm deep" in text
    (collision,) = data["collisions"]
    assert (collision["between"], collision["block"], collision["line"]) == (["tool 1", "stock"], 60, 7)
    assert main(["simulate", *given, "--save-stock", str(tmp_path / "left.stl")]) == 1
    assert load_mesh(tmp_path / "left.stl", closed=True).volume == pytest.approx(17500.0, rel=1e-5)
    capsys.readouterr()
    assert data["removed_mm3"] == pytest.approx(2500.0, rel=1e-3)
    one, page = str(tmp_path / "one.json"), tmp_path / "nowhere" / "page.html"
    for twice in (["--report", one, "--json", one], ["--json", str(page)], ["--save-stock", str(nc)]):
        assert main(["simulate", *given, *twice]) == 2
        assert "mm³" not in capsys.readouterr().out  # before anything is computed
    assert not Path(one).exists()
    assert main(["simulate", *given, "--json", "-"]) == 1
    assert json.loads(capsys.readouterr().out)["removed_mm3"] == data["removed_mm3"]
