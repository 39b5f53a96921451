"""Faults that a hand makes in a program of each family, one at a time: each is caught, with the block."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import trunnion
from tests.support.two_tools import JOBS
from trunnion import verify
from trunnion.cli import main

#: Machine, what is written, what it becomes (nothing: the block goes), and the check that fails.
FAULTS = [
    # Sinumerik
    ("yl569", "-36.8698976,0.,0.,0,0,0,1,0,1)", "-36.8698976,0.,0.,0,0,0,-1,0,1)", "words"),
    ("yl569", "CYCLE832(0.01,", "CYCLE832(1,", "modal"),
    ("yl569", "CYCLE832(_camtolerance,", "CYCLE832(100*_camtolerance,", "modal"),
    ("yl569", "G1 Z10. F500.", "G1 Z10. F500. CTOL=2", "modal"),
    ("yl569", "G1 Z10. F500.", "G1 Z10. F500. TOFFL=-5", "tool"),
    ("yl569", "G1 Z10. F500.", "G1 Z10. F500. TOFF[Z]=-5", "tool"),
    ("yl569", "G1 Z10. F500.", "G1 Z10. F500. TOFFR=.5", "tool"),
    ("yl569", "G0 X0.0 Y0.0 Z60. S4000 D1 M3", "G0 X0.0 Y0.0 Z60. S4000 D2 M3", "tool"),
    ("yl569", "CYCLE84(16.,11.,5.,-1.,", "CYCLE84(16.,11.,5.,1.,", "holes"),
    ("yl569", ",3,,1.5,0,500,500)", ",3,,-1.5,0,500,500)", "holes"),
    ("yl569", " TRAORI\n", "\n", "turns"),
    ("yl569", "G1 Z10. F500.", "SPOS=90\nG1 Z10. F500.", "spindle"),
    ("yl569", "G1 Z10. F500.", "G1 Z10. F500. M19", "spindle"),
    ("yl569", "G1 Z10. F500.", "M70\nG1 Z10. F500.", "spindle"),
    # In and out at a feed is no thread, along another axis no hole, and M99 no end.
    ("yl569", "CYCLE84(16.,11.,5.,-1.,,,3,,1.5,0,500,500)", "CYCLE85(16.,11.,5.,-1.,,,750,750)", "holes"),
    ("yl569", ",3,,1.5,0,500,500)", ",3,,1.5,0,500,500,1)", "words"),
    ("matsuura_mx330", " G84 ", " G85 ", "words"),
    ("hs664rt", " G84 ", " G85 ", "holes"),
    ("matsuura_mx330", "M30", "M99", "modal"),
    # A spindle that is oriented stands, and so does one that waits for a thread.
    ("dmu65", " F500", " F500 M19", "spindle"),
    ("matsuura_mx330", " F500.", " F500. M19", "spindle"),
    ("matsuura_mx330", " F500.", " F500. M29", "words"),
    ("hs664rt", " F500", " F500 M19", "spindle"),
    ("xyzac_trt", " F500.", " F500. M19", "spindle"),
    ("yl569", "CYCLE84(16.,11.,5.,-1.,,,3,,1.5,0,500,500)", "CYCLE85(16.,11.,5.,-1.,,,750,750)", "holes"),
    ("yl569", "CYCLE84(16.,11.,5.,-1.,,,3,,1.5,0,500,500)", "CYCLE840(16.,11.,5.,-1.,,,3,3,0,,1.5)", "words"),
    ("yl569", ",3,,1.5,0,500,500)", ",4,,1.5,0,500,500)", "holes"),
    ("yl569", ",3,,1.5,0,500,500)", ",5,,1.5,0,500,500)", "holes"),
    ("yl569", ",3,,1.5,0,500,500)", ",3,,1.5,0,500,500,1)", "words"),
    ("yl569", ",3,,1.5,0,500,500)", ",3,,1.5,0,500,500,,,,,,,,,,,2)", "words"),
    ("yl569", "CYCLE84(16.,11.,5.,-1.,,,3,", "CYCLE84(16.,11.,5.,-1.,,9,3,", "holes"),
    # Klartext
    ("dmu65", "TOOL CALL 2 Z S4000", "TOOL CALL 2 Z S4000 DL-5", "tool"),
    ("dmu65", "TOOL CALL 2 Z S4000", "TOOL CALL 2 Z S4000 DR+0.5", "tool"),
    ("dmu65", "TOOL CALL 2 Z S4000", "TOOL CALL 2 X S4000", "words"),
    ("dmu65", "CYCL DEF 32.1 T0.02", "CYCL DEF 32.1 T2", "modal"),
    ("dmu65", "TURN FMAX SEQ-", "TURN FMAX SEQ+", "words"),
    ("dmu65", "CYCL DEF 7.2 Y+0", "CYCL DEF 7.2 Y+5", "tip"),
    ("dmu65", "BEGIN PGM PART MM", "BEGIN PGM PART", "words"),
    ("dmu65", " M128\n", " M3\n", "turns"),
    ("dmu65", " PLANE SPATIAL SPA-36.87 SPB+0.0 SPC+0.0 TURN FMAX SEQ-", " M3", "turns"),
    ("dmu65", "END PGM PART MM", "END PGM OTHER MM", "words"),
    # Fanuc
    ("matsuura_mx330", " G53.1\n", "\n", "words"),
    ("matsuura_mx330", "G43.4 H2", "G43.5 H2", "words"),
    ("matsuura_mx330", "G43 H1", "G44 H1", "words"),
    ("matsuura_mx330", "G43 H1 ", "", "holes"),
    ("matsuura_mx330", "N10 G21 G17", "N10 G17", "modal"),
    ("matsuura_mx330", "N10 G21 G17", "N10 G20 G17", "tip"),
    ("matsuura_mx330", "T2 M6", "T2", "tool"),
    ("matsuura_mx330", "S4000 M3", "\u017f4000 M3", "words"),
    ("matsuura_mx330", "S4000 M3", "S4000\u00a0M3", "words"),
    ("xyzac_trt", "S4000 M3", "\u017f4000 M3", "words"),
    ("xyzac_trt", "S4000 M3", "S4000\u00a0M3", "words"),
    ("hs664rt", "S4000 M3", "\u017f4000 M3", "words"),
    ("dmu65", "TOOL CALL 2 Z S4000", "TOOL CALL 2 Z \u017f4000", "words"),
    ("dmu65", "TOOL CALL 2 Z S4000", "TOOL CALL 2 Z\u00a0S4000", "words"),
    ("yl569", "S4000 D1 M3", "\u017f4000 D1 M3", "words"),
    ("dmu65", "Q239=+1.5", "Q239=-1.5", "holes"),
    ("matsuura_mx330", " G84 ", " G74 ", "holes"),
    ("matsuura_mx330", " G84 ", " G85 ", "holes"),
    ("matsuura_mx330", " G84 ", " G89 ", "holes"),
    ("matsuura_mx330", " G84 ", " G86 ", "holes"),
    ("matsuura_mx330", " M29 S500", "", "holes"),
    ("matsuura_mx330", " G84 ", " G84 Q3. ", "holes"),
    ("matsuura_mx330", " G84 ", " G84 J3 ", "words"),
    ("matsuura_mx330", "G05.1 Q1", "G05.1 Q3", "words"),
    ("matsuura_mx330", "\nN210 G69", "\nN210", "turns"),
    # Where G30 and M92 go only the machine knows; each word of contour control is ended by its own.
    ("matsuura_mx330", " G49 G53 G0 Z0.", " G49\nG91 G30 P2 Z0.\nG90", "home"),
    ("dmu65", "L Z+560 R0 FMAX M91", "L Z+560 R0 FMAX M92", "home"),
    ("matsuura_mx330", "G05.1 Q1", "G05 P10000", "words"),
    ("matsuura_mx330", "G05.1 Q1", "G08 P1", "words"),
    # Haas
    ("haas_umc750", " F500.", " F500.\nM71", "stops"),
    ("haas_umc750", " F500.", " F500.\nM80", "stops"),
    ("haas_umc750", " F500.", " F500.\nM21", "stops"),
    ("haas_umc750", " F500.", " F500.\nM46", "words"),
    ("yl569", "G0 B30. C90.", "G0 B30. C=DC(450)", "words"),
    ("yl569", 'CYCLE800(0,"",0,57', 'CYCLE800(5,"",0,57', "words"),
    ("dmu65", " M129\n", " L M94 X R0 FMAX\n", "words"),
    ("dmu65", " M128\n", " FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\n", "words"),
    # Fidia
    ("hs664rt", "M306 T.2", "M306 T2", "words"),
    ("hs664rt", "M306 T.2", "M306 T.2.", "words"),
    ("hs664rt", "N360 M306", "N355 G4 H2.\nN360 M306", "words"),
    ("hs664rt", " R16. F750", " R16. HD1. F750", "words"),
    ("hs664rt", "N170 G55 O1", "N170", "words"),
    ("hs664rt", "N380 G55 O1", "N380", "words"),
    ("hs664rt", "N380 G55 O1", "N380 G55 O2", "offset"),
    ("hs664rt", " G71\n", "\n", "modal"),
    ("hs664rt", "N190 G154", "N190", "turns"),
    ("hs664rt", " G196\n", "\n", "turns"),
    ("hs664rt", "N360 M306 T.2", "N360 T.2", "tool"),
    ("hs664rt", " G84 ", " G85 ", "holes"),
    ("hs664rt", " G84 ", " G89 ", "holes"),
    # LinuxCNC
    ("xyzac_trt", "G64 P0.02", "G64 P2", "modal"),
    ("xyzac_trt", "G64 P0.02", "G64", "modal"),
    ("xyzac_trt", "G64 P0.02", "G64 P0.02 Q1", "modal"),
    ("xyzac_trt", "T2 M6", "M61 Q2", "words"),
    ("xyzac_trt", "T2 M6", "T3 M6\nM61 Q2", "words"),
    ("xyzac_trt", "G43 H2", "G43 H1", "tool"),
    ("xyzac_trt", "T2 M6", "T2", "tool"),
    ("xyzac_trt", "G21 ", "", "modal"),
    ("xyzac_trt", "M428", "", "turns"),
]

Posted = Callable[[str], tuple[Path, Path]]


@pytest.fixture(scope="module")
def posted(tmp_path_factory: pytest.TempPathFactory) -> Posted:
    """CL file and program of a machine's job; written once."""
    folder = tmp_path_factory.mktemp("faults")
    done: dict[str, tuple[Path, Path]] = {}

    def post(machine: str) -> tuple[Path, Path]:
        if machine not in done:
            cl, program = folder / f"{machine}.cls", folder / f"{machine}.nc"
            cl.write_text(JOBS[machine], encoding="utf-8")
            assert main(["post", str(cl), "--machine", machine, "--output", str(program), "--set", "part=PART"]) == 0
            done[machine] = cl, program
        return done[machine]

    return post


@pytest.mark.third
@pytest.mark.parametrize(("machine", "written", "becomes", "check"), FAULTS)
def test_a_fault_made_by_hand_is_caught(
    machine: str, written: str, becomes: str, check: str, posted: Posted, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = posted(machine)
    text = program.read_text(encoding="utf-8")
    assert written in text
    changed = program.with_name(f"changed_{machine}.nc")
    changed.write_text(text.replace(written, becomes, 1), encoding="utf-8")
    capsys.readouterr()
    arguments = ["verify", str(changed), "--machine", machine, "--cl", str(cl), "--tolerance", "0.005"]
    assert main(arguments) == 1
    lines = capsys.readouterr().out.splitlines()
    failed = [line.split()[0] for line in lines if line.split()[1:2] == ["FAIL"]]
    assert check in failed
    places = [int(match[1]) for line in lines if (match := re.match(rf"[^:]*:(\d+)\b.*\[{check}\]$", line))]
    line = text[: text.index(written)].count("\n") + 1
    assert any(line - 1 <= place <= line + 40 for place in places), (line, places)


def test_a_tool_change_that_lost_the_retract_of_the_others_is_found(posted: Posted, tmp_path: Path) -> None:
    """Also where the program retracts to another machine position than the home of the definition."""
    cl, program = posted("dmu65")
    text = program.read_text(encoding="utf-8").replace("L X+0 Y+0 R0 FMAX M91", "L X+1 Y+1 R0 FMAX M91")
    lines = text.replace("L Z+560 R0 FMAX M91", "L Z+555 R0 FMAX M91").splitlines()

    def home(blocks: list[str]) -> tuple[bool, str]:
        changed = tmp_path / "changed.h"
        changed.write_text("\n".join(re.sub(r"^\d+ ", f"{k} ", block) for k, block in enumerate(blocks)) + "\n")
        found = verify(changed, machine="dmu65", cl=cl, tolerance=0.005)
        return next((each.passed, each.summary) for each in found.checks if each.key == "home")

    assert home(lines)[0]
    change = next(k for k, line in enumerate(lines) if "TOOL CALL 2" in line)
    cut = max(k for k, line in enumerate(lines[:change]) if "M99" in line)
    lost = [line for line in lines[cut:change] if "L Z+555" not in line]
    passed, text = home([*lines[:cut], *lost, *lines[change:]])
    assert not passed
    assert "changes the tool without the retract" in text


def test_where_rotary_axes_were_positioned_is_named_only_if_no_point_behind_it_is_right(tmp_path: Path) -> None:
    cl, program = tmp_path / "p.cls", tmp_path / "p.nc"
    cl.write_text(
        "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
        "RAPID\nGOTO/10,0,30,0,0,1\nFEDRAT/MMPM,500\nGOTO/10,0,5\nGOTO/10,20,5\nGOTO/30,20,5\nRAPID\nGOTO/30,20,30\n"
        "END-OF-PATH\n",
        encoding="utf-8",
    )
    for machine, turned in (("matsuura_mx330", "A0. C0.:A0. C5."), ("yl569", "C0 B0:C5 B0")):
        text = trunnion.post(cl, machine=machine).text or ""
        right, wrong = turned.split(":")
        at = next(k for k, line in enumerate(text.splitlines()) if " Y20" in line)
        lines = text.splitlines()
        lines[at] = lines[at].replace("Y20", "Y21")
        program.write_text("\n".join([*lines, ""]), encoding="utf-8")
        tip = next(each for each in trunnion.verify(program, machine=machine, cl=cl).checks if each.key == "tip")
        assert not tip.passed
        assert not any("were positioned" in place.text for place in tip.places)
        assert tip.places[0].nc_line == at + 1
        if right not in text:
            continue
        begin = text.rindex(right, 0, text.index("Y20"))
        program.write_text(text[:begin] + wrong + text[begin + len(right) :], encoding="utf-8")
        tip = next(each for each in trunnion.verify(program, machine=machine, cl=cl).checks if each.key == "tip")
        assert any("were positioned" in place.text for place in tip.places)
