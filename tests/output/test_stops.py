"""Program stops: what a machine may switch off there is said again, on every control, and its absence is found."""

import re
from itertools import groupby
from pathlib import Path

import pytest

import trunnion

MACHINES = ["yl569", "dmu65", "mikron_600u", "matsuura_mx330", "xyzac_trt", "hs664rt", "haas_umc750"]

CL = """UNITS/MM
TOOL PATH/A,TOOL,EM
TLDATA/MILL,10,0,80,0,0
LOAD/TOOL,1
SPINDL/RPM,8000,CLW
COOLNT/FLOOD
RAPID
GOTO/20,0,10
FEDRAT/MMPM,500
GOTO/20,0,0
STOP
GOTO/10,0,0
OPSTOP
GOTO/-10,0,0
STOP
SPINDL/RPM,5000,CCLW
COOLNT/OFF
GOTO/-20,0,0
STOP
STOP
OPSTOP
GOTO/-30,0,0
RAPID
GOTO/-30,70,50
END-OF-PATH
"""


@pytest.fixture(scope="module", params=MACHINES)
def posted(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path, str]:
    """The machine, the CL file and the program."""
    cl = tmp_path_factory.mktemp("stops") / "part.cls"
    cl.write_text(CL)
    result = trunnion.post(cl, machine=request.param, settings={"numbers": "off"})
    assert result.passed
    return request.param, cl, result.text or ""


def words_before(text: str, x: str, after: str) -> list[str]:
    """M words between the blocks to two positions, with those of the second; of the first without its own."""
    blocks = text.splitlines()
    last = next(k for k, block in enumerate(blocks) if re.search(rf"X\+?{x}\b", block))
    first = next(k for k, block in enumerate(blocks) if re.search(rf"X\+?{after}\b", block) and k < last)
    return re.findall(r"\bM0*(\d+)", "\n".join(blocks[first + 1 : last + 1]))


def switches(text: str) -> list[str]:
    """M words of stops, spindle and coolant; one that is said twice, once."""
    return [word for word, _ in groupby(re.findall(r"\bM0*[0134589]\b", text))]


def test_what_ran_at_a_stop_is_said_again(posted: tuple[str, Path, str]) -> None:
    text = posted[2]
    assert words_before(text, "10", "20") == ["5", "0", "3", "8"]
    assert words_before(text, "-10", "10") == ["1", "3", "8"]
    assert sorted(words_before(text, "-20", "-10")) == ["0", "4", "5", "9"]
    assert words_before(text, "-30", "-20") == ["5", "0", "0", "1", "4"]


def test_what_is_not_said_again_is_found(posted: tuple[str, Path, str], tmp_path: Path) -> None:
    machine, cl, text = posted
    program = tmp_path / "part.nc"
    for word in ("3", "8"):
        for stop in ("0", "1"):
            head, found, rest = re.split(rf"(\bM0*{stop}\b)", text, maxsplit=1)
            program.write_text(head + found + re.sub(rf" ?\bM0*{word}\b", "", rest, count=1))
            checks = trunnion.verify(program, cl=cl, machine=machine).checks
            finder = "spindle" if word + stop == "30" else "stops"
            assert finder in [check.key for check in checks if not check.passed], (word, stop)


def test_stops_come_back_from_a_conversion(posted: tuple[str, Path, str], tmp_path: Path) -> None:
    machine, _, text = posted
    program = tmp_path / "part.nc"
    program.write_text(text)
    again = trunnion.convert(program, machine=machine, to_machine=machine, settings={"numbers": "off"}).text or ""
    assert switches(again) == switches(text)


def test_a_stop_or_a_tool_change_of_its_own_is_away_from_the_part(
    posted: tuple[str, Path, str], tmp_path: Path
) -> None:
    machine, cl, text = posted
    program, lines = tmp_path / "part.nc", text.splitlines()
    at_part = max(k for k, block in enumerate(lines) if re.search(r"(X.?-30|Y\+?70|Z\+?50)\.?\b", block)) + 1
    away = next(k for k in range(at_part, len(lines)) if re.search(r"SUPA.*Z|Z.*M91|G53|M242", lines[k])) + 1
    for word, line, passes in [
        ("M0", at_part, False),
        ("M1", at_part, False),
        ("M6", at_part, False),
        ("M0", away, True),
    ]:
        program.write_text("\n".join([*lines[:line], word, *lines[line:]]))
        failed = [check.key for check in trunnion.verify(program, cl=cl, machine=machine).checks if not check.passed]
        assert bool(failed) is not passes, (word, failed)
        assert passes or word == "M6" or "stops" in failed, (word, failed)
