"""Cures of messages about plans: rewinds, limits of axes, feeds, holes in many pecks."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial, marked, post
from tests.support.posting import CLEAR, FOOT, HEAD, LEANING


def _lines(message: str, *lines: str, on: str = "yl569", head: str = HEAD, **settings: str) -> Cure:
    """Lines behind the first cut."""
    return marked(message, post(on), *lines, head=head, foot=FOOT, **settings)


def _settings(message: str, change: Mapping[str, str | None], text: str, on: str = "yl569", **settings: str) -> Cure:
    """Settings with which an operation is posted, and the one that the cure gives."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, post(on), text + FOOT, (change,), settings)


def _defined(text: str, **given: str) -> Trial:
    """Return what posts a CL file on the machine of a definition."""

    def posted(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        machine = folder / "ours.toml"
        machine.write_text('schema = 1\nname = "Ours"\n' + definition, encoding="utf-8")
        return post(str(machine))(text, {**given, **settings}, folder)

    return posted


def _definition(message: str, *lines: str, text: str = HEAD, **settings: str) -> Cure:
    """Lines of the definition of the machine."""
    return marked(message, _defined(text + FOOT, **settings), *lines)


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
    _lines("PLN620 hole_more_pecks", "- " + _PECKS.format(200, ".01,.0000001,0"), "+ " + _PECKS.format(200, "5"),
           "GOTO/50,0,0", "CYCLE/OFF", head=CLEAR, cycles="off"),
    marked("PLN620 holes_motions", _limited("holes.hole_motion._MOST_ROWS", 50),
           "- " + _PECKS.format(20, "1"), "+ " + _PECKS.format(20, "10"), "GOTO/50,0,0", "CYCLE/OFF",
           head=CLEAR, foot=FOOT, cycles="off"),
    _settings("PLN330 changes", {"mode": None}, LEANING + "GOTO/20,0,5,0,0,1\n", mode="tilted"),
    _lines("PLN240 axis_ends_turns_from_home", *(f"- {line}" for line in _winding(2)), "+ GOTO/20,0,5",
           on="generic_head_table_bc"),
    _lines("PLN435 faster_than_cl_file", "GOTO/20,0,5", feed="fastest", feed_limit="900"),
    _definition("PLN425 accelerations_not_stated", 'extends = "yl569"',
                *(f'+ [[axis]]\nname = "{name}"\nacceleration_mm_s2 = 3000' for name in "XYZ"),
                *(f'+ [[axis]]\nname = "{name}"\nacceleration_deg_s2 = 900' for name in "BC"),
                text=HEAD + "GOTO/20,0,5\n", feed="fastest", feed_limit="900"),
)  # fmt: skip
