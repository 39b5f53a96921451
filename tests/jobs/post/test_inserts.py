"""Raw text (INSERT) that ends or bends a program is refused at its line; harmless text goes into it as it is."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD, LEANING

#: For each family of controls: texts that change something with a part of what they do, and harmless ones.
BENDING = {
    "yl569": {
        "M30": "ends the program", "M2": "ends the program", "G91": "elsewhere", "X99999": "moves the machine",
        "G0 Z-20": "moves the machine", "G55": "work offset", "G700": "", "TRAORI": "TCP",
        "TRANS X10": "elsewhere", "M5": "spindle", "S100": "spindle speed", "G41": "compensation", "G999": "G999",
        "GOTOF NOWHERE": "", "M8": "coolant", "SUPA G0 Z=100": "moves the machine", "T=7": "",
        "SPOS=90": "spindle", "M19": "spindle", "M70": "spindle", "OFFN=2": "OFFN=2", "G26 S100": "G26",
        "OVR=10": "OVR",
        "CUT3DC": "CUT3DC", "FL[X]=5": "FL[X]", "LIMS=100": "LIMS", "M61 G64": "G64", "M41": "M41", "M2=3": "M2=3",
        "$TC_DP3[5,1]=0": "$TC_DP3", "F=IC(5)": "", "_camtolerance=5": "_camtolerance", "H1=5 OVR=10": "OVR",
    },
    "dmu65": {
        "M30": "ends the program", "L Z-20 F100": "moves the machine", "CYCL DEF 7.1 X+5": "", "M5": "spindle",
        "M128": "TCP", "TOOL CALL 9 Z S100": "", "CALL PGM X": "missing program", "L M140 MB MAX": "moves",
        "M19": "spindle", "FN 17: SYSWRITE ID 50 NR1 IDX5 = +0": "FN 17", "CYCL DEF 9.0 DWELL TIME": "",
        "CYCL DEF 8.0 MIRROR IMAGE": "", "BEGIN PGM A MM": "", "M103 F10": "M103", "M126": "M126", "M89": "M89",
        "FN 0: Q202 = +1": "Q202", "BLK FORM 0.1 Z X-1 Y-1 Z-1": "BLK FORM",
    },
    "matsuura_mx330": {
        "M30": "ends the program", "G91": "elsewhere", "X99.": "moves the machine", "G20": "", "M98 P100": "O0100",
        "G55": "work offset", "G68 X0 Y0 R30.": "", "G92 X0": "", "G52 X5.": "elsewhere",
        "M19": "spindle", "M29": "stands", "G10 L10 P5 R50": "G10", "G10 L12 P5 R3": "G10", "G10 L20 P1 X50": "",
        "#10005=3": "#10005", "#2005=0": "#2005", "#3006=1": "#3006", "G64": "G64", "M48": "M48", "G98": "G98",
        "/M8": "",
    },
    "hs664rt": {
        "M02": "ends the program", "G91": "elsewhere", "X99": "moves the machine", "M5": "spindle", "G999": "G999",
        "M19": "spindle", "HD5": "",
    },
    "xyzac_trt": {
        "M2": "ends the program", "G91": "elsewhere", "X99": "moves the machine", "G20": "", "G92 X0": "",
        "o100 call": "", "G43 H9": "", "M19": "spindle", "G10 L1 P5 Z0": "G10", "G10 L10 P5 Z0": "G10", "M50 P0": "M50",
        "G64 P5": "", "#<_hal[x]>=1": "", "(PROBEOPEN,x)": "PROBEOPEN", "(ABORT,x)": "ABORT",
        "(LOGCLOSE)": "LOGCLOSE", "(PROBEOPEN x)": "PROBEOPEN",
    },
}  # fmt: skip
HARMLESS = {
    "yl569": ["H1=5", "M61", ";LOOK", 'MSG("LOOK")', "R5=2", "G90", "M1", "STOPRE", "G4 F0.5", "G95"],
    "dmu65": ["M61", "; LOOK", "Q5=+3", "M1"],
    "matsuura_mx330": ["M61", "(LOOK)", "#100=5", "G90"],
    "hs664rt": ["M61", "(LOOK)", "G90"],
    "xyzac_trt": ["M64 P1", "(LOOK)", "#100=5", "G90"],
}


def part(folder: Path, *texts: str, head: str = HEAD) -> Path:
    """A CL file with texts from its line 12 on."""
    file = folder / "part.cls"
    file.write_text(head + "".join(f"INSERT/{text}\n" for text in texts) + "GOTO/10.0,9.0,5.0\n" + FOOT)
    return file


@pytest.mark.third
@pytest.mark.parametrize(
    ("machine", "text", "effect"),
    [(machine, text, effect) for machine, texts in BENDING.items() for text, effect in texts.items()],
)
def test_text_that_ends_or_bends_the_program_is_refused_with_its_line_and_what_it_does(
    tmp_path: Path, machine: str, text: str, effect: str
) -> None:
    target = tmp_path / "part.nc"
    with pytest.raises(trunnion.RefusedError) as caught:
        trunnion.post(part(tmp_path, text), machine=machine, output=target)
    problem = caught.value.problems[0]
    assert (problem.line, problem.what.startswith(f"INSERT/{text}: ")) == (12, True)
    assert effect in problem.what
    assert not isinstance(caught.value, trunnion.ProofFailedError)
    assert list(tmp_path.iterdir()) == [tmp_path / "part.cls"]


@pytest.mark.parametrize("machine", HARMLESS)
def test_harmless_text_goes_into_the_program_letter_by_letter(tmp_path: Path, machine: str) -> None:
    result = trunnion.post(part(tmp_path, *HARMLESS[machine]), machine=machine)
    assert result.passed
    assert result.text is not None
    assert all(text in result.text for text in HARMLESS[machine])


def test_one_text_among_harmless_ones_is_found_and_said_once(tmp_path: Path) -> None:
    texts = [*(f"R{k}=1" for k in range(40)), "G91", "G90", "M61", "G91"]
    with pytest.raises(trunnion.RefusedError) as caught:
        trunnion.post(part(tmp_path, *texts), machine="yl569")
    assert [problem.line for problem in caught.value.problems if problem.line] == [52]


def test_an_open_structure_is_found_where_it_begins(tmp_path: Path) -> None:
    with pytest.raises(trunnion.RefusedError) as caught:
        trunnion.post(part(tmp_path, "IF R1==5", "R2=1"), machine="yl569")
    assert caught.value.problems[0].line == 12


def test_a_text_is_judged_in_the_mode_of_its_operation(tmp_path: Path) -> None:
    with pytest.raises(trunnion.RefusedError, match="it switches TCP"):
        trunnion.post(part(tmp_path, "TRAFOOF", head=LEANING), machine="yl569")
    assert trunnion.post(part(tmp_path, "TRAFOOF"), machine="yl569").passed


def test_force_writes_it_and_its_head_says_so(tmp_path: Path) -> None:
    result = trunnion.post(part(tmp_path, "M30"), machine="yl569", force=True)
    assert not result.passed
    assert result.text is not None
    assert "MUST NOT RUN AS IT IS, written by --force: INSERT/M30: it ends the program" in result.text
