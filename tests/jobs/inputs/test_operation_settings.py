"""Settings of single operations, and the machining method that follows the operation."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD

#: Two operations with tools of their own.
TWO = (
    HEAD.replace("OP1", "TOPOP")
    + FOOT
    + HEAD.replace("OP1", "SIDES").replace("D10", "D8").replace("LOAD/TOOL,1,ADJUST,1", "LOAD/TOOL,2,ADJUST,2")
    + FOOT
)

#: For each family of controls: settings, and what the program must have in its two operations.
CASES = {
    "yl569": [
        ({"work_offset": "SIDES:G55"}, "G54", "G55"),
        ({"work_offset": "G56,SIDES:G57"}, "G56", "G57"),
        ({"method": "SIDES:FINISH"}, 'MSG("METHOD")', 'MSG("FINISH")'),
        ({"method": "ROUGH,SIDES:FINISH"}, "_ORI_ROUGH", "_ORI_FINISH"),
        ({"edge": "SIDES:2"}, " D1 M3", " D2 M3"),
        ({"tool": "SIDES:7"}, "T=1", "T=7"),
        ({"three_axis_tolerance": "SIDES:0.005"}, "CYCLE832(0.01", "CYCLE832(0.005"),
    ],
    "dmu65": [
        ({"work_offset": "SIDES:2"}, "Q339=+1", "Q339=+2"),
        ({"tolerance": "SIDES:0.05"}, "CYCL DEF 32.1 T0.02", "CYCL DEF 32.1 T0.05"),
        ({"delta_length": "SIDES:0.2"}, "TOOL CALL 1 Z S4000\n", "TOOL CALL 2 Z S4000 DL+0.2"),
        ({"tool": "SIDES:7"}, "TOOL CALL 1", "TOOL CALL 7"),
    ],
    "matsuura_mx330": [
        ({"work_offset": "SIDES:G54.1 P3"}, "G54\n", "G54.1 P3"),
        ({"contour": "SIDES:none"}, "G05.1 Q1", ""),
        ({"tool": "SIDES:7"}, "T1 M6", "T7 M6"),
    ],
    "hs664rt": [({"work_offset": "SIDES:G55 O2"}, "G55 O1", "G55 O2"), ({"tool": "SIDES:7"}, "T.1", "T.7")],
    "xyzac_trt": [({"work_offset": "SIDES:G55"}, "G54", "G55"), ({"tool": "SIDES:7"}, "T1 M6", "T7 M6")],
}


@pytest.fixture
def cl(tmp_path: Path) -> Path:
    """The file of the two operations."""
    file = tmp_path / "part.cls"
    file.write_text(TWO)
    return file


def halves(text: str) -> tuple[str, str]:
    """The program without block numbers, up to its second operation and from there on."""
    plain = "\n".join(line.lstrip("0123456789N ") if line[:1] in "N0123456789" else line for line in text.splitlines())
    at = plain.index("SIDES" if "SIDES" in plain else "(T.2" if "(T.2" in plain else "(T.7")
    return plain[:at] + "\n", plain[at:] + "\n"


@pytest.mark.parametrize(
    ("machine", "settings", "first", "second"),
    [(machine, *case) for machine, cases in CASES.items() for case in cases],
)
def test_a_setting_of_one_operation_is_its_own(
    cl: Path, machine: str, settings: dict[str, str], first: str, second: str
) -> None:
    result = trunnion.post(cl, machine=machine, settings=settings)
    assert result.passed
    assert result.text is not None
    top, sides = halves(result.text)
    assert first in top
    assert second in sides
    assert first not in sides
    assert not second or second not in top


def test_the_proof_wants_each_operation_in_its_own_work_offset(cl: Path, tmp_path: Path) -> None:
    text = trunnion.post(cl, machine="yl569", settings={"work_offset": "SIDES:G55"}).text
    assert text is not None
    both = trunnion.post(cl, machine="yl569", settings={"work_offset": "SIDES:G55"})
    assert next(check for check in both.checks if check.key == "offset").summary == "G54, G55"
    file = tmp_path / "part.mpf"
    file.write_text(text)
    found = trunnion.verify(file, machine="yl569", cl=cl)
    assert [check.key for check in found.checks if not check.passed] == ["offset"]


@pytest.mark.parametrize(
    ("settings", "what"),
    [
        (
            {"method": "BLADE_FIN:FINISH"},
            "method is set for operation BLADE_FIN, and the program has none of that name",
        ),
        ({"work_offset": "TOP:G55"}, "work_offset is set for operation TOP"),
        ({"mode": "TOP:tcp"}, "mode is set for operation TOP"),
        ({"work_offset": "G54,G55,SIDES:G56"}, "work_offset has two values for all operations"),
        ({"work_offset": "SIDES:G55,SIDES:G56"}, "work_offset has two values for operation SIDES"),
        ({"title": "SIDES:FINISH"}, "title is 'SIDES:FINISH', and it cannot differ by operation"),
        ({"orientation": "SIDES:vector"}, "orientation is 'SIDES:vector'"),
        ({"restart": "SIDES:on"}, "restart is 'SIDES:on'"),
        ({"tool_list": "SIDES:on"}, "tool_list is 'SIDES:on'"),
        ({"edge": "SIDES:x"}, "edge is 'x'"),
    ],
)
def test_a_setting_of_an_unknown_operation_or_value_is_an_error(cl: Path, settings: dict[str, str], what: str) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(cl, machine="yl569", settings=settings)
    assert what in str(caught.value)


def test_a_text_of_the_whole_program_may_have_a_colon(cl: Path) -> None:
    result = trunnion.post(cl, machine="yl569", settings={"title": "FLANGE: REV B", "date": "12:30"})
    assert result.text is not None
    assert ";FLANGE: REV B" in result.text


@pytest.mark.parametrize(
    ("name", "tolerances", "mode"),
    [
        ("OP1", (0.03, 0.03), "_ORI_ROUGH"),
        ("BLADE_FINISH", (0.03, 0.03), "_ORI_ROUGH"),
        ("BLADE_FINISH", (0.01, 0.01), "_ORI_FINISH"),
        ("BLADE_SEMI_FINISH", (0.015, 0.015), "_ORI_SEMIFIN"),
        ("HUB_ROUGH", (0.005, 0.005), "_ORI_ROUGH"),
        ("HUB", (0.01, 0.01), "_ORI_SEMIFIN"),
        ("HUB", (0.005, 0.005), "_ORI_FINISH"),
        ("HUB", None, "_ORI_ROUGH"),
        ("HUB_FINISH", None, "_ORI_FINISH"),
    ],
)
def test_the_mode_of_smoothing_follows_tolerances_and_name_of_the_operation(
    tmp_path: Path, name: str, tolerances: tuple[float, float] | None, mode: str
) -> None:
    lines = "" if tolerances is None else "INTOL/{}\nOUTTOL/{}\n".format(*tolerances)
    text = HEAD.replace("OP1", name).replace("INTOL/0.01\nOUTTOL/0.01\n", lines)
    (tmp_path / "part.cls").write_text(text + FOOT)
    result = trunnion.post(tmp_path / "part.cls", machine="yl569")
    assert result.text is not None
    assert f"CYCLE832(0.01, {mode},1)" in result.text
    assert 'MSG("METHOD")' in result.text
    given = trunnion.post(tmp_path / "part.cls", machine="yl569", settings={"method": "MILL_FINISH"})
    assert given.text is not None
    assert "CYCLE832(0.01, _ORI_FINISH,1)" in given.text
