"""Feeds that a control's digits make others of are told; those that it cannot be told are refused, with their lines."""

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

HOLE = PATH.replace("GOTO/0,0,5\nGOTO/5,0,5", "CYCLE/DRILL,RAPTO,3,FEDTO,-9,{cycle}\nGOTO/0,0,0\nCYCLE/OFF")


@pytest.mark.parametrize(
    ("machine", "feed", "told"),
    [
        ("yl569", "MMPR,0.0143", "warning: a feed of 0.0143 prints as 0.01; write it in mm/min (MMPM)"),
        (
            "yl569",
            "MMPR,0.004",
            "error: a feed of 0.004 is below the least that the control reads; write it in mm/min (MMPM)",
        ),
        ("yl569", "MMPR,0.25", ""),
        ("matsuura_mx330", "MMPR,0.0143", "warning: a feed of 0.0143 prints as 0.014; write it in mm/min (MMPM)"),
        ("hs664rt", "MMPM,0.2", "error: a feed of 0.2 is below the least that the control reads; raise it"),
        ("hs664rt", "MMPM,2.5", "warning: a feed of 2.5 prints as 2; raise it"),
        ("hs664rt", "MMPM,333.333", ""),
    ],
)
@pytest.mark.parametrize("in_a_cycle", [False, True])
def test_feeds_are_held_against_their_digits(
    in_a_cycle: bool, machine: str, feed: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "part.cls"
    text = HOLE.format(feed="MMPM,100", cycle=feed) if in_a_cycle else PATH.format(feed=feed)
    path.write_text(text, encoding="utf-8")
    code = main(["post", str(path), "--machine", machine, "--output", str(tmp_path / "part.nc")])
    err = capsys.readouterr().err
    assert code == (2 if "error" in told else 0), err
    assert (f"part.cls:10: {told}\n" in err) if told else "a feed of" not in err
