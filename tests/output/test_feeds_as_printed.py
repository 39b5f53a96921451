"""Feeds that a control's digits make others of are told or refused, with their lines; those that it can print are."""

import re
from pathlib import Path

import pytest

from trunnion.cli import main

PATH = """TOOL PATH/ONE,TOOL,D10
TLDATA/MILL,10,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/{feed}
GOTO/0,0,5
GOTO/5,0,5
END-OF-PATH
"""

HOLE = PATH.replace("GOTO/0,0,5\nGOTO/5,0,5", "CYCLE/{cycle}\nGOTO/0,0,0\nCYCLE/OFF")
DRILL = "DRILL,RAPTO,3,FEDTO,-9,"

REV = "write it in mm/min (MMPM)"
PRINT = "write a feed that the control can print"

ONE_DIGIT_TOO_FEW = [
    ("matsuura_mx330", "MMPR,0.0143", f"error: a feed of 0.0143 prints as 0.014, which is 2.1 % off; {REV}"),
    ("matsuura_mx330", "MMPR,0.1254", f"warning: a feed of 0.1254 prints as 0.125, which is 0.32 % off; {REV}"),
    ("yl569", "MMPR,0.000004", f"error: a feed of 4e-06 is below the least that the control reads; {REV}"),
    ("yl569", "MMPR,0.0014321", f"warning: a feed of 0.0014321 prints as 0.00143, which is 0.15 % off; {REV}"),
    ("xyzac_trt", "MMPR,0.0001", f"error: a feed of 0.0001 is below the least that the control reads; {REV}"),
    ("hs664rt", "MMPM,0.2", f"error: a feed of 0.2 is below the least that the control reads; {PRINT}"),
    ("hs664rt", "MMPM,2.5", f"error: a feed of 2.5 prints as 2, which is 20 % off; {PRINT}"),
    ("hs664rt", "MMPM,9.4", f"warning: a feed of 9.4 prints as 9, which is 4.3 % off; {PRINT}"),
    ("hs664rt", "MMPM,8.5", f"error: a feed of 8.5 prints as 8, which is 5.9 % off; {PRINT}"),
    ("hs664rt", "MMPM,77.4", f"warning: a feed of 77.4 prints as 77, which is 0.52 % off; {PRINT}"),
    ("hs664rt", "MMPM,333.333", ""),
]


def post(folder: Path, capsys: pytest.CaptureFixture[str], text: str, machine: str) -> tuple[int, list[str], str]:
    """Exit code, blocks of the program (none if it was refused), and stderr."""
    path, program = folder / "part.cls", folder / "part.nc"
    path.write_text(text, encoding="utf-8")
    code = main(["post", str(path), "--machine", machine, "--output", str(program)])
    lines = program.read_text(encoding="utf-8").splitlines() if program.exists() else []
    return code, lines, capsys.readouterr().err


@pytest.mark.parametrize(("machine", "feed", "told"), ONE_DIGIT_TOO_FEW)
@pytest.mark.parametrize("in_a_cycle", [False, True])
def test_feeds_are_held_against_their_digits(
    in_a_cycle: bool, machine: str, feed: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = HOLE.format(feed="MMPM,100", cycle=DRILL + feed) if in_a_cycle else PATH.format(feed=feed)
    code, _, err = post(tmp_path, capsys, text, machine)
    assert code == (2 if "error" in told else 0), err
    assert (f"part.cls:10: {told} [CTL320]\n" in err) if told else "a feed of" not in err


@pytest.mark.third
@pytest.mark.parametrize("feed", ["0.025", "0.015", "0.005", "0.0143", "0.0125"])
@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "xyzac_trt", "dmu65", "hs664rt"])
@pytest.mark.parametrize("form", ["modal", "cycle", "modal in a cycle"])
def test_a_feed_per_revolution_is_printed_to_a_thousandth_or_refused(
    form: str, machine: str, feed: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if form == "modal":
        text = PATH.format(feed=f"MMPR,{feed}")
    else:
        own = form == "cycle"
        text = HOLE.format(
            feed="MMPM,100" if own else f"MMPR,{feed}", cycle=DRILL + f"MMPR,{feed}" if own else DRILL.rstrip(",")
        )
    code, lines, err = post(tmp_path, capsys, text, machine)
    if code:
        assert code == 2
        assert "feed per revolution" in err or f"a feed of {feed} prints as" in err
        assert machine in ("matsuura_mx330", "hs664rt") or (machine == "dmu65" and len(feed) > 5)
        return
    words = [float(text) for line in lines for text in re.findall(r"(?:\bF|Q206=\+?)([\d.]+)", line)]
    ratios = [word / float(feed) for word in words]
    assert any(abs(ratio - 1.0) <= 1e-3 or abs(ratio - 1000.0) <= 1.0 for ratio in ratios), lines


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "xyzac_trt", "dmu65"])
def test_feeds_per_minute_and_per_revolution_may_alternate(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cuts = "".join(
        f"FEDRAT/{feed}\nGOTO/{x},0,5\n"
        for x, feed in enumerate(["MMPR,0.125", "MMPM,250", "MMPR,0.125", "MMPR,0.25", "MMPM,250"], start=6)
    )
    text = PATH.format(feed="MMPM,250").replace("END-OF-PATH", cuts + "END-OF-PATH")
    code, lines, err = post(tmp_path, capsys, text, machine)
    assert code == 0, err
    feeds = [number.rstrip(".") for line in lines for number in re.findall(r"\bF(\d*\.?\d+\.?)(?= |$)", line)]
    assert [float(number) for number in feeds] == [250, 0.125, 250, 0.125, 0.25, 250]


def test_pitches_and_reaming_feeds_have_their_own_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for cycle, wanted in (
        ("TAP,RAPTO,3,FEDTO,-9,MMPR,0.3175", ",.3175,"),
        ("BORE,RAPTO,3,FEDTO,-9,MMPR,0.0125", ",.0125,.0125)"),
    ):
        code, lines, err = post(tmp_path, capsys, HOLE.format(feed="MMPM,100", cycle=cycle), "yl569")
        assert code == 0, err
        assert any(wanted in line for line in lines if "CYCLE8" in line), lines
