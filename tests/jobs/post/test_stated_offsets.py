"""The work offset that an operation of a CL file states: posted and proven on every family, and what a setting does."""

import re
from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError

HEAD = "$$-> TRUNNION / 1\nUNITS/MM\n"
CUT = (
    "LOADTL/4\nSPINDL/RPM,5000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,500\nGOTO/0,0,0\nGOTO/20,0,0\nRAPID\nGOTO/20,0,50\n"
)


def job(folder: Path, *offsets: int, names: tuple[str, ...] = ("TOP", "SIDE")) -> Path:
    """A CL file with an operation for each number, which it states unless it is 0."""
    text = HEAD
    for name, number in zip(names, offsets, strict=False):
        stated = f"$$-> WORK-OFFSET / {number}\n" if number else ""
        text += f"TOOL PATH/{name},TOOL,D10\n$$-> TOOL / MILL,DIAMETER,10,LENGTH,60\n{stated}{CUT}END-OF-PATH\n"
    path = folder / "job.apt"
    path.write_text(text + "FINI\n", encoding="utf-8")
    return path


#: Machines of each family, and what selects the first and another work offset there.
WORDS = {
    "yl569": ("G54", 5, "G505"),
    "dmu65": ("Q339=+1", 12, "Q339=+12"),
    "matsuura_mx330": ("G54", 7, "G54.1 P1"),
    "haas_umc750": ("G54", 8, "G154 P2"),
    "xyzac_trt": ("G54", 9, "G59.3"),
    "hs664rt": ("G55 O1", 3, "G55 O3"),
}


@pytest.mark.parametrize("machine", WORDS)
def test_each_control_selects_its_own_and_the_proof_asks_for_it(machine: str, tmp_path: Path) -> None:
    first, number, second = WORDS[machine]
    cl, program = job(tmp_path, number, 1), tmp_path / "out.nc"
    assert trunnion.post(cl, machine=machine, output=program).passed
    text = program.read_text(encoding="utf-8")
    words = re.findall(rf"{re.escape(second)}(?![\d.])|{re.escape(first)}(?![\d.]| P)", text)
    assert list(dict.fromkeys(words)) == [second, first]
    assert trunnion.verify(program, machine=machine, cl=cl).passed
    other = trunnion.verify(program, machine=machine, cl=job(tmp_path, number, number))
    assert "offset" in {check.key for check in other.checks if check.passed is False}
    with pytest.raises(InputError, match="has none of that number"):
        trunnion.post(job(tmp_path, 10_000, 1), machine=machine)


def test_a_setting_takes_its_place_and_says_so(tmp_path: Path) -> None:
    cl = job(tmp_path, 2, 3)
    for setting, told in {"TOP:G54": [4], "TOP:G55": [], "G54": [3, 17], "SIDE:G57,G55": [17]}.items():
        found = trunnion.post(cl, machine="yl569", output=tmp_path / "a.mpf", settings={"work_offset": setting})
        remarks = [each for each in found.problems if each.code == "CL495"]
        assert found.passed
        assert len(remarks) == len(told), setting
    text = (tmp_path / "a.mpf").read_text(encoding="utf-8")
    assert "G55" in text
    assert "G57" in text
    assert "G56" not in text


def test_two_of_one_name_that_differ_are_refused(tmp_path: Path) -> None:
    same = ("TOP", "TOP")
    assert trunnion.post(job(tmp_path, 2, 2, names=same), machine="yl569").passed
    with pytest.raises(InputError, match="operations called TOP state work offsets 2 and 3"):
        trunnion.post(job(tmp_path, 2, 3, names=same), machine="yl569")


def test_without_a_statement_the_setting_decides(tmp_path: Path) -> None:
    trunnion.post(job(tmp_path, 0, 0), machine="yl569", output=tmp_path / "a.mpf", settings={"work_offset": "G56"})
    assert "G56" in (tmp_path / "a.mpf").read_text(encoding="utf-8")
