"""Definitions for programs in inches: no length of a template stays in mm unseen."""

from pathlib import Path

import pytest

from trunnion.controls import Control, load_control
from trunnion.controls.inches import in_units, literal_length
from trunnion.controls.template import Printing
from trunnion.errors import InputError
from trunnion.machines import load_machine

MACHINES = {"sinumerik": "yl569", "klartext": "dmu65", "fanuc": "matsuura_mx330", "linuxcnc": "xyzac_trt"}

#: Lines of programs, and the number in them that may be a length; empty: there is none.
LINES = [
    ("sinumerik", "SUPA G0 Z=100 D0", "Z=100"),
    ("sinumerik", "SUPA G0 Z=_Z_HOME D0", ""),
    ("sinumerik", "_X_HOME=-12.5", "_X_HOME=-12.5"),
    ("sinumerik", "_X_HOME=0.0 T=5 S1=300 M2=3 TURN=2 C=90", ""),
    ("sinumerik", "CYCLE832(0.01,_ORI_ROUGH,1)", "0.01 in CYCLE832"),
    ("sinumerik", "CYCLE832(\0,_ORI_ROUGH,1)", ""),
    ("sinumerik", 'CYCLE800(0,"TABLE",100000,57,0,0,0,30,40,50,0,0,0,-1,0,1)', ""),
    ("sinumerik", "CYCLE800(0,,0,57,1.5,0,0,0,0,0,0,0,0,1,0,1)", "1.5 in CYCLE800"),
    ("sinumerik", "L_RETRACT(150)", "150 in L_RETRACT"),
    ("sinumerik", "G0 A=DC(90) X=AC(3)", "X=AC(3"),
    ("sinumerik", 'MSG("X100") ; Z50', ""),
    ("sinumerik", "G1 F2000", "F2000"),
    ("sinumerik", "G54 G64 G90 M8 D1", ""),
    ("klartext", "L Z+560 R0 FMAX M91", "Z+560"),
    ("klartext", "L IZ+2 F500", "IZ+2"),
    ("klartext", "L M140 MB50", "MB50"),
    ("klartext", "L M140 MB MAX", ""),
    ("klartext", "CYCL DEF 32.1 T0.01", "CYCL DEF 32.1 T0.01"),
    ("klartext", "CYCL DEF 32.2 HSC-MODE:1 TA0.5", ""),
    ("klartext", "  Q339=+1 ;DATUM NUMBER", "Q339=+1"),
    ("klartext", "  Q339=+\0 ;DATUM NUMBER", ""),
    ("klartext", "CYCL DEF 7.1 X+0", ""),
    ("klartext", "CYCL DEF 7.1 X+12", "X+12"),
    ("klartext", "CYCL DEF 1.2 DEPTH -20", "CYCL DEF 1.2 DEPTH -20"),
    ("klartext", "CYCL DEF 9.1 DWELL 5", ""),
    ("klartext", "TOOL CALL 5 Z S3000 DL+0.1", "DL+0.1"),
    ("klartext", "BLK FORM 0.1 Z \0", ""),
    ("klartext", "PLANE SPATIAL SPA+10 SPB+0 SPC+0 TURN FMAX", ""),
    ("fanuc", "G91 G28 Z0.", ""),
    ("fanuc", "G53 G0 Z-10.", "Z-10."),
    ("fanuc", "#100=25.4", "#100=25.4"),
    ("fanuc", "G43 H1 (Z50)", ""),
    ("fanuc", "G65 P9001 M8 S100 T5", ""),
    ("linuxcnc", "G64 P0.01", "G64 P0.01"),
    ("linuxcnc", "G4 P0.5", ""),
    ("linuxcnc", "(MSG, X 100)", ""),
    ("linuxcnc", "o100 call [5]", ""),
]


@pytest.fixture(scope="module")
def controls() -> dict[str, Control]:
    return {name: load_control(load_machine(machine).control) for name, machine in MACHINES.items()}


def test_numbers_that_may_be_lengths_are_found(controls: dict[str, Control]) -> None:
    found = [(control, line, literal_length(controls[control], line)) for control, line, _ in LINES]
    assert found == LINES


def own_machine(folder: Path, text: str, base: str = "matsuura_mx330") -> Control:
    file = folder / "own.toml"
    file.write_text(f'extends = "{base}"\n{text}', encoding="utf-8")
    return load_control(load_machine(file).control)


@pytest.mark.parametrize("machine", MACHINES.values())
def test_shipped_definitions_have_no_lengths_of_their_own(machine: str, tmp_path: Path) -> None:
    control = own_machine(tmp_path, "", machine)
    assert in_units(control, "inch").unit == 25.4
    assert in_units(control, "mm") is control


TEMPLATE = "[control.templates]\nprogram_end = '''\nM9\n{line}\nM30\n%\n'''\n"


def test_a_length_in_a_template_is_refused_with_its_line(tmp_path: Path) -> None:
    control = own_machine(tmp_path, TEMPLATE.replace("{line}", "G53 G0 Z-25.4"))
    with pytest.raises(InputError) as refused:
        in_units(control, "inch")
    (problem,) = refused.value.problems
    assert (Path(problem.file).name, problem.line) == ("own.toml", 5)
    assert "may be a length in mm: Z-25.4" in problem.what
    assert "{-25.4:coordinate}" in problem.cure


def test_a_number_with_a_format_is_a_length_in_mm(tmp_path: Path) -> None:
    control = own_machine(tmp_path, TEMPLATE.replace("{line}", "G53 G0 Z{-25.4:coordinate} P{3:code}"))
    for units, text in (("mm", "G53 G0 Z-25.4 P3"), ("inch", "G53 G0 Z-1. P3")):
        converted = in_units(control, units)
        lines = converted.templates["program_end"].expand({}, Printing(converted.number_formats(three_axis=True)))
        assert lines[1] == text


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("[control.templates]\nsubprogram_start = '''\n%\nO{subprogram}\nG21 G17\n'''\n", "says G21: millimetres"),
        ("[control.templates]\nsubprogram_start = '''\n%\nO{subprogram}\nG17\n'''\n", "in which unit"),
        ('[[control.word]]\nname = "primary"\nformat = "coordinate"\n', "word primary is no length"),
        ('[[control.word]]\nname = "X"\nformat = "angle"\n', "word X has no format for inches"),
        (TEMPLATE.replace("{line}", "(Z{home_z:angle})"), "is a length, and its format is in mm"),
        (TEMPLATE.replace("{line}", "(S{spindle_speed:coordinate})"), "is no length, and has one's format"),
    ],
)
def test_formats_that_would_print_the_wrong_unit_are_refused(text: str, what: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="".join(rf"\{c}" if c in "{}:()" else c for c in what)):
        in_units(own_machine(tmp_path, text), "inch")


def test_a_definition_may_count_in_inches_by_default(tmp_path: Path) -> None:
    control = own_machine(tmp_path, '[control.settings]\nunits = "inch"\n')
    assert control.settings["units"] == "inch"
    with pytest.raises(InputError, match="mm or inch"):
        own_machine(tmp_path, '[control.settings]\nunits = "feet"\n')
