"""Cures of messages about plans: rewinds, limits of axes, feeds, holes in many pecks."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

from tests.support.cures.cure import Outcome, Trial, marked, post
from tests.support.cures.posting.rows import by_definition, by_lines, by_settings
from tests.support.posting import CLEAR, FOOT, HEAD, LEANING


def _limited(name: str, most: int, on: str = "yl569") -> Trial:
    """Return what posts a CL file where fewer rows are planned."""

    def limited(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch(f"trunnion.planning.{name}", most):
            return post(on)(text, settings, folder)

    return limited


def _winding(turns: int) -> list[str]:
    """A cut in which the tool leans by 30 degrees and goes round."""
    directions = ("0.5,0,0.8660254", "0,0.5,0.8660254", "-0.5,0,0.8660254", "0,-0.5,0.8660254")
    return [f"GOTO/{20 + k},0,5,{directions[k % 4]}" for k in range(4 * turns + 1)]


_PECKS: Final = "CYCLE/DRILL,DEEP,FEDTO,-{},RAPTO,3,STEP,{},MMPM,100"

CURES: Final = (
    by_lines("PLN620 hole_more_pecks", "- " + _PECKS.format(200, ".01,.0000001,0"), "+ " + _PECKS.format(200, "5"),
           "GOTO/50,0,0", "CYCLE/OFF", head=CLEAR, cycles="off"),
    marked("PLN620 holes_motions", _limited("holes.hole_motion._MOST_ROWS", 50),
           "- " + _PECKS.format(20, "1"), "+ " + _PECKS.format(20, "10"), "GOTO/50,0,0", "CYCLE/OFF",
           head=CLEAR, foot=FOOT, cycles="off"),
    by_settings("PLN330 changes", {"mode": None}, LEANING + "GOTO/20,0,5,0,0,1\n", mode="tilted"),
    by_lines("PLN240 axis_ends_turns_from_home", *(f"- {line}" for line in _winding(2)), "+ GOTO/20,0,5",
           on="generic_head_table_bc"),
    by_lines("PLN435 faster_than_cl_file", "GOTO/20,0,5", feed="fastest", feed_limit="900"),
    by_definition("PLN425 accelerations_not_stated", 'extends = "yl569"',
                *(f'+ [[axis]]\nname = "{name}"\nacceleration_mm_s2 = 3000' for name in "XYZ"),
                *(f'+ [[axis]]\nname = "{name}"\nacceleration_deg_s2 = 900' for name in "BC"),
                text=HEAD + "GOTO/20,0,5\n", feed="fastest", feed_limit="900"),
)  # fmt: skip
