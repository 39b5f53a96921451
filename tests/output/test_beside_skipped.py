"""What stands beside blocks that may be skipped is proven with the switch on and off, or refused with a cure."""

import re
from pathlib import Path

import pytest

from trunnion.cli import main

MACHINES = ["yl569", "dmu65", "hs664rt", "matsuura_mx330", "xyzac_trt", "generic_head_head_ca", "ucp800", "haas_umc750"]

HEAD = (
    "TOOL PATH/{name},TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,{tool}\n"
    "SPINDL/RPM,1000,CLW\n"
)

_ABOVE = "RAPID\nGOTO/0,0,60,0,0,1\n"
_HOLES = "CYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,40,MMPM,100\n"
_TILTED = "0.34202014332567,0,0.93969262078591"

#: Beside blocks that may be skipped: what follows HEAD up to its tool call, and whether it is refused.
_BESIDE = {
    "a plunge behind skipped cuts": (
        f"{_ABOVE}OPSKIP/ON\nFEDRAT/MMPM,200\nGOTO/0,0,5\nGOTO/20,0,5\nOPSKIP/OFF\nGOTO/30,0,5\n", True),
    "a circle behind skipped cuts": (
        f"{_ABOVE}FEDRAT/MMPM,200\nGOTO/0,0,5\nOPSKIP/ON\nGOTO/10,0,5\nOPSKIP/OFF\nCIRCLE/20,0,5,0,0,1,10\nGOTO/30,0,5\n",
        True),
    "a cut that rises": (
        f"{_ABOVE}FEDRAT/MMPM,200\nGOTO/0,0,5\nOPSKIP/ON\nGOTO/10,0,30\nOPSKIP/OFF\nRAPID\nGOTO/40,9,60\n", True),
    "a hole out of a cut": (
        f"{_ABOVE}FEDRAT/MMPM,200\nGOTO/0,0,5\nOPSKIP/ON\nRAPID\nGOTO/0,0,60\n{_HOLES}GOTO/10,0,0\nOPSKIP/OFF\nCYCLE/OFF\n"
        "RAPID\nGOTO/40,9,60\n", True),
    "a whole operation": (f"OPSKIP/ON\n{_ABOVE}FEDRAT/MMPM,200\nGOTO/0,0,5\nRAPID\nGOTO/0,0,60\nOPSKIP/OFF\n", True),
    "the first point before a hole": (f"OPSKIP/ON\n{_ABOVE}OPSKIP/OFF\n{_HOLES}GOTO/10,0,0\nCYCLE/OFF\n", True),
    "a repeated point": (
        f"{_ABOVE}FEDRAT/MMPM,200\nGOTO/0,0,5\nOPSKIP/ON\nGOTO/10,0,5\nRAPID\nGOTO/45,46,60\nOPSKIP/OFF\nRAPID\n"
        f"GOTO/45,46,60\n{_HOLES}GOTO/10,9,0\nGOTO/20,9,0\nCYCLE/OFF\n", False),
    "two cycles": (
        f"{_ABOVE}OPSKIP/ON\nCYCLE/BORE,RAPTO,3,FEDTO,-10,RTRCTO,40,MMPM,100\nGOTO/2,35,0\nOPSKIP/OFF\nCYCLE/OFF\n"
        f"OPSKIP/ON\nRAPID\nGOTO/2,35,60\n{_HOLES}GOTO/16,8,0\nOPSKIP/OFF\nGOTO/3,8,0\nCYCLE/OFF\n", False),
    "a rise of its own above a hole": (
        f"{_ABOVE}OPSKIP/ON\n{_HOLES}GOTO/10,0,0\nOPSKIP/OFF\nCYCLE/OFF\nOPSKIP/ON\nRAPID\nGOTO/10,0,60\nOPSKIP/OFF\n"
        "FEDRAT/MMPM,200\nGOTO/10,0,5\nGOTO/20,0,5\n", False),
    "coolant off": (
        f"COOLNT/FLOOD\n{_ABOVE}FEDRAT/MMPM,200\nGOTO/0,0,5\nGOTO/20,0,5\nRAPID\nGOTO/20,0,60\nOPSKIP/ON\nGOTO/25,0,60\n"
        "COOLNT/OFF\nRAPID\nGOTO/30,0,60\nOPSKIP/OFF\nRAPID\nGOTO/40,0,60\n", False),
    "a feed where it stands": (
        f"{_ABOVE}OPSKIP/ON\n{_HOLES}GOTO/18,40,0\nCYCLE/OFF\nRAPID\nGOTO/0,43,60\nOPSKIP/OFF\nFEDRAT/MMPM,300\n"
        "GOTO/0,43,60\nRAPID\nGOTO/9,43,60\n", False),
    "a turn into a cut": (
        f"{_ABOVE}FEDRAT/MMPM,300\nGOTO/0,0,5\nOPSKIP/ON\nRAPID\nGOTO/23,60,60\nOPSKIP/OFF\nFEDRAT/MMPM,300\n"
        f"GOTO/23,61,5,{_TILTED}\n", True),
}  # fmt: skip


@pytest.mark.third
@pytest.mark.parametrize("what", _BESIDE)
@pytest.mark.parametrize("machine", MACHINES)
def test_what_stands_beside_skipped_blocks_is_proven_or_refused(
    machine: str, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, is_refused = _BESIDE[what]
    cl, program = tmp_path / "skip.cls", tmp_path / "skip.nc"
    whole = HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n"
    other = HEAD.format(name="TWO", tool=2) + f"{_ABOVE}FEDRAT/MMPM,200\nGOTO/9,9,5\nRAPID\nGOTO/9,9,60\nEND-OF-PATH\n"
    cl.write_text(whole + other, encoding="utf-8")
    code = main(["post", str(cl), "--machine", machine, "--output", str(program)])
    said = capsys.readouterr()
    assert bool(code) == is_refused, said.out + said.err
    assert ("[CTL460]" in said.err) == is_refused


def test_verify_wants_the_tool_straight_down_into_cuts_behind_skipped_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head = HEAD.format(name="ONE", tool=1)
    cl, program = tmp_path / "skip.cls", tmp_path / "skip.nc"
    cl.write_text(head + _BESIDE["a plunge behind skipped cuts"][0] + "END-OF-PATH\n", encoding="utf-8")
    straight = cl.read_text(encoding="utf-8").replace("OPSKIP/ON\n", "").replace("OPSKIP/OFF\n", "")
    plain = tmp_path / "plain.cls"
    plain.write_text(straight, encoding="utf-8")
    assert main(["post", str(plain), "--machine", "yl569", "--output", str(program)]) == 0
    lines = program.read_text(encoding="utf-8").splitlines()
    rows = [k for k, line in enumerate(lines) if re.search(r" (G1 )?(Z5\.|X20\.)", line)]
    lines = [f"/{line}" if k in rows else line.replace("X30.", "G1 X30. Z5. F200.") for k, line in enumerate(lines)]
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", str(program), "--machine", "yl569", "--cl", str(cl)]) == 1
    assert "comes down aslant at a feed: OPSKIP of the CL file skips the way above" in capsys.readouterr().out
