"""Settings in which the operations of a program differ: each operation keeps its own on another control."""

import re
from itertools import permutations
from pathlib import Path

import pytest

import trunnion
from trunnion.errors import RefusedError
from trunnion.jobs.convert.result import ConvertResult

OPERATION = """TOOL PATH/{name},TOOL,B6
TLDATA/MILL,6,3,80,0,0
{tolerances}LOAD/TOOL,{tool}
SPINDL/RPM,8000,CLW
RAPID
GOTO/-30,0,60,-0.3,0,0.9539392
FEDRAT/MMPM,300
GOTO/-25,0.5,10.0,-0.25,0.02,0.9680392
GOTO/-20,1,10.0,-0.2,0.03,0.9793365
RAPID
GOTO/-20,1,60.0
END-OF-PATH
"""

#: Machine -> where its programs state the tolerance.
TOLERANCES = {
    "yl569": r"_camtolerance=([.\d]+)",
    "dmu65": r"CYCL DEF 32\.1 T([.\d]+)",
    "xyzac_trt": r"G64 P([.\d]+)",
}
#: Machine -> how its programs state the mode of finishing.
MODES = {"yl569": r"CYCLE832\(_camtolerance,(\w+),1", "dmu65": r"HSC-MODE:(\d)"}
FINISHING = {"yl569": "_ORI_FINISH", "dmu65": "0"}
ROUGHING = {"yl569": "_ORI_ROUGH", "dmu65": "1"}

#: Machines whose work offsets have the same names.
OFFSETS = ("yl569", "matsuura_mx330", "xyzac_trt")


def posted(
    folder: Path, machine: str, settings: dict[str, str] | None = None, tolerances: tuple[float, float] | None = None
) -> Path:
    """A program of two operations, R and F."""
    own = [f"INTOL/{value}\nOUTTOL/{value}\n" for value in tolerances] if tolerances else ["", ""]
    first = OPERATION.format(name="R", tolerances=own[0], tool=4)
    second = OPERATION.format(name="F", tolerances=own[1], tool=5)
    (folder / "part.cls").write_text("UNITS/MM\n" + first + second)
    program = folder / "part.nc"
    trunnion.post(folder / "part.cls", machine=machine, output=program, settings=settings)
    return program


def said(program: str | None, pattern: str) -> list[str]:
    return re.findall(pattern, program or "")


def convert(program: Path, one: str, two: str, **settings: str) -> ConvertResult:
    return trunnion.convert(program, machine=one, to_machine=two, settings=settings)


@pytest.mark.third
@pytest.mark.parametrize(("one", "two"), [*permutations(TOLERANCES, 2), ("dmu65", "mikron_600u")])
def test_each_operation_keeps_its_tolerance_and_its_mode(one: str, two: str, tmp_path: Path) -> None:
    found = convert(posted(tmp_path, one, tolerances=(0.03, 0.005)), one, two)
    alike = "dmu65" if two == "mikron_600u" else two
    assert [float(text) for text in said(found.text, TOLERANCES[alike])] == [0.06, 0.01]
    if one in MODES and alike in MODES:
        assert said(found.text, MODES[alike]) == [ROUGHING[alike], FINISHING[alike]]


@pytest.mark.parametrize("machine", ["dmu65", "xyzac_trt"])
def test_a_cl_file_says_the_tolerance_of_each_operation(machine: str, tmp_path: Path) -> None:
    program = posted(tmp_path, machine, tolerances=(0.03, 0.005))
    found = trunnion.convert(program, machine=machine, to_cl=True, output=tmp_path / "two.cls")
    again = trunnion.post(tmp_path / "two.cls", machine=machine, settings=found.settings)
    assert said(again.text, TOLERANCES[machine]) == said(program.read_text(), TOLERANCES[machine])
    if machine in MODES:
        assert said(again.text, MODES[machine]) == said(program.read_text(), MODES[machine])


@pytest.mark.third
@pytest.mark.parametrize("machine", TOLERANCES)
@pytest.mark.parametrize("way", ["program", "operation"])
def test_a_tolerance_that_is_given_precedes_that_of_the_program(machine: str, way: str, tmp_path: Path) -> None:
    given = {"program": "0.02", "operation": "F:0.02"}[way]
    found = convert(posted(tmp_path, machine, tolerances=(0.03, 0.005)), machine, machine, tolerance=given)
    expected = {"program": [0.02, 0.02], "operation": [0.06, 0.02]}[way]
    assert [float(text) for text in said(found.text, TOLERANCES[machine])] == expected


@pytest.mark.third
@pytest.mark.parametrize(("one", "two"), [*permutations(OFFSETS, 2), ("yl569", "generic_head_head_ca")])
def test_each_operation_keeps_its_work_offset(one: str, two: str, tmp_path: Path) -> None:
    program = posted(tmp_path, one, {"work_offset": "G54,F:G55"})
    found = convert(program, one, two)
    assert list(dict.fromkeys(said(found.text, r"\bG5[45]\b"))) == ["G54", "G55"]
    assert found.settings["work_offset"] == "G54,F:G55"
    assert not [problem for problem in found.problems if "work_offset" in problem.what]


@pytest.mark.parametrize("two", ["dmu65", "hs664rt"])
def test_work_offsets_of_operations_that_the_other_control_names_otherwise_are_refused(
    two: str, tmp_path: Path
) -> None:
    program = posted(tmp_path, "yl569", {"work_offset": "G54,F:G55"})
    with pytest.raises(RefusedError, match=r"the work offset is G54,F:G5.*, which .* does not have"):
        convert(program, "yl569", two)


def test_a_work_offset_that_only_this_control_has_is_refused(tmp_path: Path) -> None:
    program = posted(tmp_path, "yl569", {"work_offset": "G54,F:G505"})
    with pytest.raises(RefusedError, match=r"the work offset is G54,F:G5.*, which .* does not have"):
        convert(program, "yl569", "matsuura_mx330")


@pytest.mark.parametrize(("one", "two"), [("yl569", "matsuura_mx330"), ("dmu65", "mikron_600u")])
def test_a_default_of_the_other_machine_is_not_taken_for_what_the_program_says(
    one: str, two: str, tmp_path: Path
) -> None:
    offset, other, said_so = {"yl569": ("G54", "G57", r"\bG5[47]\b"), "dmu65": ("1", "7", r"Q339=\+(\d)")}[one]
    ours = tmp_path / "ours.toml"
    ours.write_text(f'extends = "{two}"\n[control.settings]\nwork_offset = "{other}"\n')
    found = trunnion.convert(posted(tmp_path, one), machine=one, to_machine=ours)
    assert set(said(found.text, said_so)) == {offset}


@pytest.mark.third
@pytest.mark.parametrize(("machine", "setting", "values", "pattern"), [
    ("dmu65", "rotary_tolerance", ("0.1", "0.05"), r" TA([.\d]+)"),
    ("dmu65", "work_offset", ("1", "2"), r"Q339=\+(\d)"),
    ("yl569", "edge", ("1", "2"), r"X_HOME .* D(\d)"),
    ("yl569", "cycle832", ("_ORI_FINISH", "_ORI_ROUGH"), r"CYCLE832\(_camtolerance,(\w+),1"),
    ("hs664rt", "work_offset", ("G55 O1", "G55 O2"), r"\bG55 O\d"),
    ("matsuura_mx330", "tool", ("7", "8"), r"T(\d) M6"),
])  # fmt: skip
def test_what_operations_differ_in_goes_over_to_a_machine_of_the_same_control(
    machine: str, setting: str, values: tuple[str, str], pattern: str, tmp_path: Path
) -> None:
    program = posted(tmp_path, machine, {setting: f"{values[0]},F:{values[1]}"})
    found = convert(program, machine, machine)
    assert list(dict.fromkeys(said(found.text, pattern))) == list(values)
