"""Which machines can run a job: literal facts of shipped and changed definitions."""

import json
import math
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main
from trunnion.errors import InputError, MissingExtraError
from trunnion.jobs.capability.fitting import FitStatus, MachineFit
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.machines.loading import EXAMPLES

Capture = pytest.CaptureFixture[str]

HEAD = """TOOL PATH/ONE,TOOL,D10
TLDATA/MILL,10,0,75,0,0
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
FEDRAT/MMPM,300
RAPID
"""


def written(folder: Path, *lines: str) -> Path:
    """A CL file with these points."""
    file = folder / "part.cls"
    file.write_text(HEAD + "\n".join(lines) + "\nEND-OF-PATH\n", encoding="utf-8")
    return file


def tilted(folder: Path, degrees: float) -> Path:
    """A short cut with one tilt of the tool axis, to +X."""
    i, k = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    axis = f"{i:.9f},0,{k:.9f}"
    return written(folder, f"GOTO/40,0,20,{axis}", f"GOTO/30,0,20,{axis}", f"GOTO/30,10,20,{axis}")


def status(found: tuple[MachineFit, ...]) -> dict[str, str]:
    return {each.key: str(each.status) for each in found}


def test_a_tilt_fits_the_machines_whose_rotary_travel_has_it(tmp_path: Path) -> None:
    """115 degrees: B of the UMC-750 and of the LinuxCNC sample go to 120, A of the MX-330 to 125, others less."""
    names = ["haas_umc750", "linuxcnc_5axis", "matsuura_mx330", "dmu65", "yl569", "mikron_600u"]
    found = trunnion.fit(tilted(tmp_path, 115.0), machines=names, turns=[0.0], tool_length=100.0)
    assert status(found) == {
        "haas_umc750": "fits", "linuxcnc_5axis": "fits", "matsuura_mx330": "fits",
        "dmu65": "does not fit", "yl569": "does not fit", "mikron_600u": "does not fit",
    }  # fmt: skip
    assert [each.status for each in found] == sorted((each.status for each in found), key=list(FitStatus).index)
    for each in found[3:]:
        assert "part.cls:7" in each.reasons[0], each.reasons
        assert "would have to leave its travel" in each.reasons[0]


def test_a_tilt_of_130_degrees_fits_a_machine_that_is_made_for_it(tmp_path: Path) -> None:
    machine = load_machine("mikron_600u")
    tilting = replace(
        machine,
        key="tilting",
        axes=tuple(replace(a, low=-140.0, high=140.0) if a.name == "B" else a for a in machine.axes),
    )
    found = trunnion.fit(tilted(tmp_path, 130.0), machines=[machine, tilting, "ucp800"], turns=[0.0], tool_length=100.0)
    assert status(found) == {"tilting": "fits", "mikron_600u": "does not fit", "ucp800": "does not fit"}
    rotary = {each.axis: each.margin for each in found[0].margins if each.unit == "deg"}
    assert rotary["B"] == pytest.approx(10.0, abs=1e-3)
    assert rotary["C"] == math.inf


def shorter(machine: Machine, travel: float) -> Machine:
    """A machine with another travel of Y about the same middle."""
    y = machine.axis("Y")
    middle = (y.low + y.high) / 2.0
    changed = replace(y, low=middle - travel / 2.0, high=middle + travel / 2.0, home=middle)
    return replace(machine, key=f"y{travel:g}", axes=tuple(changed if a is y else a for a in machine.axes))


def test_travel_that_is_too_small_is_told_with_the_lines(tmp_path: Path) -> None:
    """The path takes 320 mm of Y; a YL569 has 300, so 20 are missing, 10 at each end."""
    file = written(tmp_path, "GOTO/0,0,20,0,0,1", "GOTO/0,0,0,0,0,1", "GOTO/0,320,0,0,0,1")
    yl569 = load_machine("yl569")
    machines = [shorter(yl569, 200.0), yl569, shorter(yl569, 400.0)]
    found = trunnion.fit(file, machines=machines, turns=[0.0], tool_length=100.0)
    assert status(found) == {"y400": "fits", "yl569": "does not fit", "y200": "does not fit"}
    assert list(status(found)) == ["y400", "yl569", "y200"]  # what is missing least comes first
    assert found[1].missing == pytest.approx(10.0, abs=1e-6)
    assert found[2].missing == pytest.approx(60.0, abs=1e-6)
    reason, tried = found[1].reasons
    assert tried == "the part was tried turned about Z by 0 degrees: give other turns, or tilt it in its set-up"
    assert reason.startswith("the travel of Y, 300 mm, is 20.000 mm too small for what it goes from ")
    assert "part.cls:9" in reason
    left = {each.axis: each.margin for each in found[0].margins}
    assert left["Y"] == pytest.approx(40.0, abs=1e-6)


def test_a_part_that_is_turned_fits_where_it_did_not(tmp_path: Path) -> None:
    """X has 500 mm: a quarter of a turn brings the 320 mm there."""
    file = written(tmp_path, "GOTO/0,0,20,0,0,1", "GOTO/0,0,0,0,0,1", "GOTO/0,320,0,0,0,1")
    (found,) = trunnion.fit(file, machines="yl569", turns=[0.0, 90.0], tool_length=100.0)
    assert found.status is FitStatus.FITS
    assert found.turn_deg == 90.0
    assert found.zero_mm is not None
    assert trunnion.place(file, machine="yl569", turns=[90.0]).margin_at(found.zero_mm, 90.0) > 0.0


def test_without_a_package_no_machine_is_said_not_to_fit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(MissingExtraError, match=r"needs scipy\.optimize, which is not installed"):
        trunnion.fit(tilted(tmp_path, 10.0), machines=["yl569", "dmu65"], tool_length=100.0)


def test_what_is_wrong_with_one_machine_ends_no_other(tmp_path: Path, capfd: Capture) -> None:
    broken, file = tmp_path / "broken.toml", YL569 / "2_hub_rough.cls"
    broken.write_text("schema = 1\nname = 3\n", encoding="utf-8")
    asked = f"{broken},yl569,hs664rt"
    assert main(["fit", str(file), "--machines", asked, "--turns", "360", "--json", "-", "--tool-length", "100"]) == 0
    data = {each["machine"]: each for each in json.loads(capfd.readouterr().out)["machines"]}
    assert list(data)[:2] == ["yl569", "hs664rt"]
    assert {key: each["status"] for key, each in data.items()} == {
        "yl569": "fits", "hs664rt": "open", broken.as_posix(): "does not fit",
    }  # fmt: skip
    assert "[DEF" in data[broken.as_posix()]["reasons"][0]
    assert data["hs664rt"]["reasons"] == ["no limits of X and Y and Z are stated, so only the other axes are judged"]
    assert data["yl569"]["seconds"] > 0.0
    assert [each["axis"] for each in data["yl569"]["margins"]] == ["X", "Y", "Z", "C", "B"]


def test_an_nc_program_is_asked_as_its_cl_data() -> None:
    program = YL569 / "2_hub_rough.expected.mpf"
    found = trunnion.fit(program, machine="yl569", machines="dmu65", turns=[0.0], tool_length=100.0)
    assert status(found) == {"dmu65": "fits"}


def test_examples_come_after_the_machines_of_builders_and_are_marked(tmp_path: Path, capfd: Capture) -> None:
    """The generic head is faster here than the YL569, which a builder makes."""
    blade, own = str(YL569 / "3_blade_finish.cls"), tmp_path / "own.toml"
    own.write_text('schema = 1\nextends = "generic_head_table_bc"\nname = "Own"\n', encoding="utf-8")
    asked = f"generic_head_table_bc,xyzac_trt,{own},yl569"
    assert main(["fit", blade, "--machines", asked, "--turns", "360", "--tool-length", "100"]) == 0
    head, *lines = capfd.readouterr().out.splitlines()
    assert head.startswith("zero: of the workpiece in the machine frame, X,Y,Z in mm with all axes at zero")
    assert [line.split()[0] for line in lines if line[0] != " "] == [
        "own",
        "yl569",
        "generic_head_table_bc",
        "xyzac_trt",
    ]
    assert [line.endswith("; an example, no builder's machine") for line in lines if line[0] != " "] == [
        False,
        False,
        True,
        True,
    ]


def test_examples_are_shipped_and_named_as_what_they_are() -> None:
    shipped = {
        name for name in shipped_machines() if load_machine(name).name.startswith(("Generic", "LinuxCNC", "Desk"))
    }
    assert shipped == EXAMPLES


def test_machines_that_all_fail_are_told_by_the_exit_code(tmp_path: Path, capfd: Capture) -> None:
    assert main(["fit", str(tilted(tmp_path, 170.0)), "--machines", "dmu65,yl569", "--turns", "360"]) == 1
    out = capfd.readouterr().out
    assert out.count("does not fit") == 2


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--tool-length", "abc"], "--tool-length: error: is 'abc'; write MM"),
        (["--turns", "0.001"], "--turns: error: 0.001 is not a step of turns; write degrees, 0.1 to 360, such as 5"),
        (["--turns", "0"], "--turns: error: 0.0 is not a step of turns; write degrees, 0.1 to 360, such as 5"),
        (["--machines", ","], "--machines: error: is ','; give all, or names or files of machines"),
        (["--zero", "1,2,3"], "--zero: error: is for an NC program; name its machine with --machine NAME"),
    ],
)
def test_what_cannot_be_used_is_told_once(arguments: list[str], what: str, capfd: Capture) -> None:
    assert main(["fit", str(YL569 / "2_hub_rough.cls"), *arguments]) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert what in err


def test_files_without_motion_are_refused(tmp_path: Path, capfd: Capture) -> None:
    empty = tmp_path / "empty.cls"
    empty.write_text("$$ nothing\n", encoding="utf-8")
    assert main(["fit", str(empty), "--machines", "dmu65"]) == 2
    assert main(["fit", str(tmp_path / "none.cls"), "--machines", "dmu65"]) == 2
    assert "none.cls: error: file not found" in capfd.readouterr().err


def test_a_tool_without_a_known_length_leaves_it_open(tmp_path: Path, capfd: Capture) -> None:
    file = tilted(tmp_path, 30.0)
    found = trunnion.fit(file, machines="generic_head_head_ca", turns=[0.0])
    assert status(found) == {"generic_head_head_ca": "open"}
    (reason,) = found[0].reasons
    assert reason == "the tool counts as 0 mm long, and places depend on its length (X, Y, Z); give its length"
    assert main(["fit", str(file), "--machines", "dmu65", "--turns", "360"]) == 0
    out, err = capfd.readouterr()
    assert "places depend on its length (Z); give its length" in out
    assert "--tool-length: warning: the tool counts as 0 mm long where linear axes depend on its length" in err
    assert "[PLC210]" in err
    assert main(["fit", str(file), "--machines", "dmu65", "--turns", "360", "--tool-length", "80"]) == 0
    out, err = capfd.readouterr()
    assert "fits" in out
    assert err == ""


def test_a_length_in_the_spindle_that_cl_files_state_counts(tmp_path: Path) -> None:
    """The head stands 500 mm above the tip at a tilt of 90 degrees, so X needs that much more on one side."""
    file = tilted(tmp_path, 30.0)
    (toolpath,) = [trunnion.read_cl(file)]
    tools = [replace(each, tool=replace(each.tool, set_length=140.0)) for each in toolpath.operations]
    stated = replace(toolpath, operations=tuple(tools))
    (found,) = trunnion.fit(stated, machines="generic_head_head_ca", turns=[0.0])
    (given,) = trunnion.fit(file, machines="generic_head_head_ca", turns=[0.0], tool_length=140.0)
    assert found.status is FitStatus.FITS
    assert found.zero_mm == given.zero_mm


def test_the_turns_are_those_of_place(tmp_path: Path) -> None:
    """One tool axis at an azimuth of 45 degrees; C turns by 30 at most, so no quarter of a turn brings it there."""
    machine = load_machine("dmu65")
    axes = tuple(
        replace(a, endless=False, low=-30.0, high=30.0) if a.name == "C"
        else replace(a, low=-60.0, high=-5.0, home=-5.0) if a.name == "A" else a
        for a in machine.axes
    )  # fmt: skip
    narrow = replace(machine, key="narrow", axes=axes)
    i, k = math.sin(math.radians(20.0)) * math.sqrt(0.5), math.cos(math.radians(20.0))
    file = written(tmp_path, *[f"GOTO/{x},0,20,{i:.9f},{i:.9f},{k:.9f}" for x in (40, 30)])
    (found,) = trunnion.fit(file, machines=[narrow], tool_length=100.0)
    assert found.status is FitStatus.FITS
    (quarters,) = trunnion.fit(file, machines=[narrow], tool_length=100.0, turns=90.0)
    assert quarters.status is FitStatus.NOT
    assert quarters.reasons[1].startswith("the part was tried turned about Z by 4 angles from 0 to 270: give other")


def test_a_name_that_is_no_machine_is_refused_with_the_one_that_is_near(tmp_path: Path) -> None:
    """A definition that is wrong is the reason of its machine alone."""
    file, wrong = written(tmp_path, "GOTO/0,0,20,0,0,1", "GOTO/9,0,20,0,0,1"), tmp_path / "wrong.toml"
    wrong.write_text('extends = "nosuch"\n', encoding="utf-8")
    missing = tmp_path / "missing.toml"
    with pytest.raises(InputError) as caught:
        trunnion.fit(file, machines=f"yl569,dmu56,{missing},{wrong}", tool_length=100.0)
    assert [(problem.file, problem.code) for problem in caught.value.problems] == [
        ("dmu56", "DEF110"),
        (str(missing), "FIL110"),
    ]
    assert 'did you mean "dmu65"?' in caught.value.problems[0].cure
    found = trunnion.fit(file, machines=f"yl569,{wrong}", tool_length=100.0, turns=[0.0])
    assert [each.status for each in found] == [FitStatus.FITS, FitStatus.NOT]


def test_travel_from_a_place_that_is_assumed_is_open(tmp_path: Path) -> None:
    """The UMC-750 does not state its gauge point: where C lies in the travel of X and Y is not known."""
    ways = ((1, 0), (0, 1), (-1, 0), (0, -1))
    file = written(tmp_path, *[f"GOTO/{60 * x},{60 * y},20,{0.5 * x},{0.5 * y},0.866025404" for x, y in ways])
    (found,) = trunnion.fit(file, machines="haas_umc750", tool_length=100.0)
    assert found.status is FitStatus.OPEN
    assert found.missing is not None
    assert found.reasons[0].startswith("the definition does not state the gauge point, and with it where the rotary")
    stated = replace(load_machine("haas_umc750"), spindle_point_is_stated=True)
    (found,) = trunnion.fit(file, machines=[stated], tool_length=100.0)
    assert found.status is FitStatus.NOT
