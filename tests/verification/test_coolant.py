"""Coolant through words of the machine's builder: where they stand, and what switches off behind them."""

import re
from pathlib import Path

import pytest

import trunnion

_CL = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
COOLNT/{kind}
SPINDL/RPM,3000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
RAPID
GOTO/0.0,0.0,2.0
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,-1.0
GOTO/10.0,0.0,-1.0
GOTO/20.0,0.0,-1.0
GOTO/20.0,0.0,2.0
COOLNT/OFF
SPINDL/OFF
END-OF-PATH
"""

#: The machine, what its definition adds, the CL file's word, and the word of the program.
_CASES = {
    "haas": ("haas_umc750", "THRU = 88", "THRU", "M88"),
    "klartext": ("dmu65", "", "MIST", "M25"),
    "sinumerik": ("yl569", "", "THRU", "M26"),
    "fanuc": ("matsuura_mx330", "THRU = 51", "THRU", "M51"),
}


def _posted(case: str, folder: Path) -> tuple[str, Path, list[str]]:
    """The machine, the CL file, and the lines of its program, whose proof passes."""
    base, coolant, kind, _ = _CASES[case]
    machine = folder / "shop.toml"
    machine.write_text(f'schema = 1\nextends = "{base}"\nname = "Shop"\n[control.coolant]\n{coolant}\n')
    source = folder / "part.cls"
    source.write_text(_CL.format(kind=kind))
    result = trunnion.post(source, machine=machine)
    assert result.passed
    assert result.text is not None
    return str(machine), source, result.text.splitlines()


def _coolant(lines: list[str], machine: str, source: Path) -> str:
    """The line of the check, where it fails; else empty."""
    program = source.with_name("part.nc")
    program.write_text("\n".join(lines) + "\n")
    found = trunnion.verify(program, machine=machine, cl=source)
    check = next(check for check in found.checks if check.key == "coolant")
    return check.summary if check.state == "FAIL" else ""


@pytest.mark.parametrize("case", _CASES)
def test_coolant_that_is_switched_off_in_the_cut_is_a_fault(case: str, tmp_path: Path) -> None:
    machine, source, lines = _posted(case, tmp_path)
    assert _coolant(lines, machine, source) == ""
    cut = next(k for k, line in enumerate(lines) if "X20" in line or "X+20" in line)
    assert "coolant" in _coolant([*lines[:cut], "M9", *lines[cut:]], machine, source)
    # Its word is read: coolant changes, and is not only restated.
    assert "coolant" in _coolant([*lines[:cut], "M9", _CASES[case][3], *lines[cut:]], machine, source)


@pytest.mark.parametrize("case", _CASES)
def test_coolant_that_is_not_switched_on_is_a_fault(case: str, tmp_path: Path) -> None:
    machine, source, lines = _posted(case, tmp_path)
    word = _CASES[case][3]
    assert any(word in line for line in lines)
    assert "coolant" in _coolant([line.replace(word, "") for line in lines], machine, source)


def test_a_haas_stops_the_spindle_for_coolant_through_it(tmp_path: Path) -> None:
    """M88 stands before M3, as the page of the control says; behind it the spindle would stand."""
    machine, source, lines = _posted("haas", tmp_path)
    place = {word: next(k for k, line in enumerate(lines) if word in line) for word in ("M88", "M3")}
    assert place["M88"] < place["M3"]
    lines[place["M88"]], lines[place["M3"]] = lines[place["M3"]], lines[place["M88"]]
    program = source.with_name("part.nc")
    program.write_text("\n".join(lines) + "\n")
    found = trunnion.verify(program, machine=machine, cl=source)
    assert "spindle" in {check.key for check in found.checks if check.state == "FAIL"}


@pytest.mark.parametrize("case", _CASES)
def test_words_that_the_definition_states_are_read(case: str, tmp_path: Path) -> None:
    machine, source, lines = _posted(case, tmp_path)
    program = source.with_name("part.nc")
    program.write_text("\n".join(lines) + "\n")
    name = {"THRU": "through", "MIST": "mist"}[_CASES[case][2]]
    checks = {check.key: check for check in trunnion.verify(program, machine=machine, cl=source).checks}
    assert (checks["coolant"].state, checks["coolant"].summary) == ("ok", name)
    # What another word of the builder does is not known.
    program.write_text("\n".join(line.replace(_CASES[case][3], "M67") for line in lines) + "\n")
    checks = {check.key: check for check in trunnion.verify(program, machine=machine, cl=source).checks}
    assert checks["coolant"].state == "not checked"


def test_a_word_that_no_definition_states_is_not_checked(tmp_path: Path) -> None:
    _, source, lines = _posted("fanuc", tmp_path)
    program = source.with_name("part.nc")
    program.write_text("\n".join(lines) + "\n")
    checks = {check.key: check for check in trunnion.verify(program, machine="matsuura_mx330", cl=source).checks}
    assert checks["coolant"].state == "not checked"
    assert "THRU" in checks["coolant"].told


#: How a program changes its tool, and whether coolant is said before it.
_CHANGES = {
    "yl569": r"(N\d+ T=1\n)", "dmu65": r"(\d+ TOOL CALL 1 .*\n)", "haas_umc750": r"(N\d+ T1 M6\n)",
    "matsuura_mx330": r"(N\d+ T1 M6\n)", "xyzac_trt": r"(N\d+ T1 M6\n)", "hs664rt": r"(N\d+ M306 T\.1\n)",
}  # fmt: skip


@pytest.mark.third
@pytest.mark.parametrize("machine", _CHANGES)
def test_coolant_that_is_only_said_before_the_tool_change_is_not_checked(machine: str, tmp_path: Path) -> None:
    source, program = tmp_path / "part.cls", tmp_path / ("part.h" if machine == "dmu65" else "part.nc")
    source.write_text(_CL.format(kind="FLOOD"))
    text = trunnion.post(source, machine=machine, settings={"part": "PART"}).text or ""
    before = re.sub(r"(?m)^N?\d* ?M8\n| M8\b", "", text)
    for changed, said in ((text, ()), (re.sub(_CHANGES[machine], r"M8\n\1", before), ("turned off coolant",))):
        lines = changed.splitlines()
        if machine == "dmu65":
            numbers = iter(range(len(lines)))
            lines = [line if line[0] == " " else re.sub(r"^(\d+ )?", f"{next(numbers)} ", line) for line in lines]
        program.write_text("\n".join(lines) + "\n")
        check = next(
            each for each in trunnion.verify(program, machine=machine, cl=source).checks if each.key == "coolant"
        )
        if said and machine == "haas_umc750":  # whose tool change is known to switch it off
            assert not check.passed
            continue
        assert check.passed, check.summary
        assert len(check.missing) == len(said)
        assert all(text in each.what for text, each in zip(said, check.missing, strict=True))
