"""What matters only with a tool length or a zero is found, or told, where nobody has stated them."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569

CL = """TOOL PATH/TOP,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,2500.0000,CLW
RAPID
GOTO/0.0,0.0,300.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,10.0
GOTO/50.0,0.0,10.0
RAPID
GOTO/50.0,0.0,300.0
END-OF-PATH
"""


def own_machine(folder: Path, base: str, place: str) -> Path:
    file = folder / "own.toml"
    text = f'schema = 1\nextends = "{base}"\nname = "Own"\n[control.templates]\n{place} = """\nG18\n"""\n'
    file.write_text(text, encoding="utf-8")
    return file


def cl_file(folder: Path) -> Path:
    file = folder / "top.cls"
    file.write_text(CL, encoding="utf-8")
    return file


def test_a_plane_in_which_the_length_counts_aside_is_refused_and_is_a_fault_of_a_program(tmp_path: Path) -> None:
    cl, machine = cl_file(tmp_path), own_machine(tmp_path, "yl569", "after_approach")
    with pytest.raises(trunnion.RefusedError, match="template after_approach writes G18"):
        trunnion.post(cl, machine=machine)
    program = tmp_path / "p.mpf"
    trunnion.post(cl, machine="yl569", output=program)
    first = next(line for line in program.read_text(encoding="utf-8").splitlines() if "G1 " in line)
    found = trunnion.verify(changed(program, first, f"G18\n{first}"), machine="yl569", cl=cl)
    tip = next(check for check in found.checks if check.key == "tip")
    assert not tip.passed
    assert "its length counts along Y here, and the tool lies along Z" in tip.places[0].text


def test_a_plane_after_the_length_that_is_put_back_is_none(tmp_path: Path) -> None:
    machine = tmp_path / "own.toml"
    text = 'schema = 1\nextends = "yl569"\nname = "Own"\n[control.templates]\nafter_approach = """\nG18\nG17\n"""\n'
    machine.write_text(text, encoding="utf-8")
    assert trunnion.post(cl_file(tmp_path), machine=machine).passed


def changed(program: Path, old: str, new: str, count: int = 1) -> Path:
    text = program.read_text(encoding="utf-8")
    assert old in text
    program.write_text(text.replace(old, new, count), encoding="utf-8")
    return program


def test_a_length_across_another_plane_is_a_fault_on_a_fanuc(tmp_path: Path) -> None:
    cl, program = cl_file(tmp_path), tmp_path / "p.nc"
    machine = tmp_path / "own.toml"
    machine.write_text('schema = 1\nextends = "yl569"\nname = "Own"\n[control]\nextends = "fanuc_31i"\n', "utf-8")
    trunnion.post(cl, machine=machine, output=program)
    assert trunnion.verify(program, machine=machine, cl=cl).passed
    found = trunnion.verify(changed(program, "G54", "G54 G18"), machine=machine, cl=cl)
    tip = next(check for check in found.checks if check.key == "tip")
    assert not tip.passed
    assert "its length counts along Y or Z, as a parameter of the control says" in tip.places[0].text


def test_points_that_stand_on_a_zero_nobody_stated_are_not_checked(tmp_path: Path) -> None:
    cl, program = YL569 / "3_blade_finish.cls", tmp_path / "p.mpf"
    trunnion.post(cl, machine="yl569", output=program, settings={"tcp": "off", "zero": (0, 0, 0), "tool_length": 100})
    found = trunnion.verify(program, machine="yl569", cl=cl, tool_length=100)
    tip = next(check for check in found.checks if check.key == "tip")
    assert (tip.state, tip.told.split("; ")[0]) == ("not checked", "no workpiece zero stated")


def test_largest_and_rms_are_of_the_same_quantity(tmp_path: Path) -> None:
    cl, program = cl_file(tmp_path), tmp_path / "p.mpf"
    trunnion.post(cl, machine="yl569", output=program)
    text = program.read_text(encoding="utf-8").replace("X0.0 Y0.0 Z300.", "X0.3 Y0.4 Z300.")
    program.write_text(text.replace(" X50.", " X50.3"), encoding="utf-8")
    tip = next(check for check in trunnion.verify(program, machine="yl569", cl=cl).checks if check.key == "tip")
    assert tip.worst == pytest.approx(0.4)
    assert "largest 0.400000 mm in X, Y or Z, rms 0.400000, allowed" in tip.summary


def test_a_fanuc_whose_length_counts_along_z_in_every_plane(tmp_path: Path) -> None:
    cl, program = cl_file(tmp_path), tmp_path / "p.nc"
    machine = tmp_path / "own.toml"
    base = 'schema = 1\nextends = "{}"\nname = "Own"\n'
    machine.write_text(base.format("matsuura_mx330"), "utf-8")
    trunnion.post(cl, machine=machine, output=program)
    changed(program, "G54", "G54 G18")
    own = base.format("matsuura_mx330") + "[control.reading]\nlength_along_z = true\n"

    def failed() -> list[str]:
        return [check.key for check in trunnion.verify(program, machine=machine, cl=cl).checks if check.state == "FAIL"]

    # No line needs the plane, which is a fault of its own.
    assert failed() == ["tip", "modal"]
    machine.write_text(own, "utf-8")
    assert failed() == ["modal"]
