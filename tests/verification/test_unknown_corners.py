"""Where no manual says how a control compensates the radius, every command says that it is not checked, and why."""

import json
from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import check

FOLDER = Path(__file__).parents[1] / "golden/compensation"
CONTOUR, CENTRE = FOLDER / "contour_boss.cls", FOLDER / "pocket.cls"

TYPE_B = """extends = "matsuura_mx330"
[control]
extends = "fanuc_31i"
[control.reading]
compensation_start = "B"
"""

#: Machine, and what stands in its program for what.
CASES: dict[str, tuple[str, dict[str, str]]] = {
    "Fidia": ("hs664rt", {}),
    "KONT": ("yl569", {"G41 ": "KONT G41 "}),
    "DISC": ("yl569", {"G41 ": "DISC=50 G41 "}),
    "G451 beside circles": ("yl569", {"G41 ": "G451 G41 ", "X20.\n": "G2 X20. CR=25.\n", " Y-15.\n": " G1 Y-15.\n"}),
    "another side": ("yl569", {"N530 G40 ": "N525 G42 X-36.\nN530 G40 "}),
    "in space": ("yl569", {"G41 ": "CUT3DC G41 "}),
    "type B": ("type_b.toml", {}),
}


@pytest.fixture(scope="module", params=CASES)
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path | str]:
    """A program, and its machine."""
    folder = tmp_path_factory.mktemp("corners")
    name, changes = CASES[request.param]
    machine: Path | str = name
    if name.endswith(".toml"):
        machine = folder / name
        machine.write_text(TYPE_B)
    found = folder / "boss.nc"
    trunnion.post(CONTOUR, machine=machine, output=found)
    text = found.read_text()
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    found.write_text(text)
    return found, machine


def test_every_command_says_so(program: tuple[Path, Path | str], tmp_path: Path) -> None:
    nc, machine = program
    report = tmp_path / "report.json"
    found = trunnion.verify(nc, machine=machine, cl=CONTOUR, radius_register="radius", columns=True)
    own = check(found, "compensation")
    assert own.state != "ok"
    assert "how the control compensates from" in own.told
    trunnion.write_report(found, report)
    (data,) = [each for each in json.loads(report.read_text())["checks"] if each["key"] == "compensation"]
    assert data["state"] == own.state
    assert any("is not known" in why for why in data["missing"])
    simulated = trunnion.simulate(
        nc, machine=machine, stock="box:120,100,20,-60,-50,-20", tools=["1=flat:12,length=75,flutes=30"], cell=4.0,
        radius_register="radius",
    )  # fmt: skip
    assert not simulated.passed
    assert "SIM164" in {each.code for each in simulated.remarks}
    assert any("is not known" in why for why in simulated.cuts_not_checked)


@pytest.mark.parametrize("word", ["KONTC", "KONTT"])
def test_other_approaches_are_errors(word: str, tmp_path: Path) -> None:
    nc = tmp_path / "boss.mpf"
    trunnion.post(CONTOUR, machine="yl569", output=nc)
    nc.write_text(nc.read_text().replace("G41 ", f"{word} G41 "))
    found = trunnion.verify(nc, machine="yl569", cl=CONTOUR, radius_register="radius")
    assert not check(found, "words").passed
