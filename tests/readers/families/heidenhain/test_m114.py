"""M114 of an iTNC 530: the tip is placed at the ends of blocks, and the axes go straight between them."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.support.reading import Runner, close
from trunnion.errors import Severity
from trunnion.machines import Machine, forward, load_machine
from trunnion.model.run import Run

PLACED = replace(load_machine("mikron_600u"), workpiece_zero=(3.0, -4.0, 20.0), tool_length=100.0)


@pytest.fixture
def mikron(run: Runner) -> Callable[[str], Run]:
    return lambda text: run(text, machine=PLACED)


def errors(found: Run) -> list[tuple[int, str]]:
    """Line and code of each error."""
    return [(each.line, each.code) for each in found.diagnostics if each.severity is Severity.ERROR]


def test_ends_are_tips_and_the_way_between_them_is_that_of_the_axes(mikron: Callable[[str], Run]) -> None:
    blocks = "L X+10 Y+5 Z+3 B-20 C+30 F500\nL X+25 Y-5 Z+8 B-60 C+90\nL B-30\nL X+1\n"
    at_ends, tcp, free = (mikron(f"{on}L X+0 Y+0 Z+50 FMAX\n{blocks}") for on in ("M114\n", "M128\n", ""))
    assert at_ends.diagnostics == ()
    close(at_ends.tip, tcp.tip, atol=1e-9)
    close(at_ends.joints, tcp.joints, atol=1e-9)
    assert np.abs(free.tip[1] - at_ends.tip[1]).max() > 1.0
    assert not at_ends.tcp.any()
    assert at_ends.state.at_ends.column().all()
    assert not tcp.state.at_ends.column().any()
    close(at_ends.tip[3], [25, -5, 8], atol=1e-9)  # a rotary word alone: the linear axes follow


def test_it_acts_before_its_block_and_ends_behind_it(mikron: Callable[[str], Run]) -> None:
    found = mikron("L X+10 Y+0 Z+0 B-90 FMAX M114\nL X+20 M115\nL X+20\nL Z+5")
    assert found.state.at_ends.column().tolist() == [True, True, False, False]
    close(found.tip[1], [20, 0, 0], atol=1e-9)
    assert np.abs(found.tip[2] - found.tip[1]).max() > 1.0  # the same number is a position of the axes now


def test_switching_it_moves_nothing(mikron: Callable[[str], Run]) -> None:
    found = mikron("L X+10 Y+2 Z+3 B-40 FMAX\nM114\nL IX+0 FMAX\nM115\nL IX+0 FMAX")
    close(found.joints[1], found.joints[0], atol=1e-9)
    close(found.joints[2], found.joints[0], atol=1e-9)


def test_f_is_the_feed_of_the_tip(mikron: Callable[[str], Run]) -> None:
    """Written by hand: 60 mm at 600 mm/min take 6 seconds, however far the axes go."""
    from trunnion.timing.row_feeds import RowFeeds

    found = mikron("M114\nL X+0 Y+0 Z+0 FMAX\nL X+60 B-50 C+20 F600\nM115\nL X+0 B+0 C+0\n")
    length, rate = RowFeeds(found).part(0, len(found), found.chunk(0, len(found)))[:2]
    close(60.0 * length[1] / rate[1], 6.0, rtol=1e-6)
    assert length[2] > 60.1  # without M114 all axes count, a degree as a millimetre


@pytest.mark.parametrize(
    ("blocks", "line"),
    [
        ("M114\nL X+1 FMAX\nTOOL CALL 2 Z S500", 3),
        ("M114\nL X+1 FMAX\nTOOL CALL Z S500", 3),
        ("M114\nL X+1 FMAX\nL Z+100 FMAX M91", 3),
        ("M114\nL X+1 FMAX\nPLANE SPATIAL SPA+0 SPB-20 SPC+0 TURN FMAX", 3),
        ("M114\nL X+1 FMAX\nCYCL DEF 19.0 TILT\nCYCL DEF 19.1 A+0 B-20 C+0", 4),
        ("PLANE SPATIAL SPA+0 SPB-20 SPC+0 TURN FMAX\nM114", 2),
        ("M128\nM114", 2),
        ("M114\nM128", 2),
        ("M114\nFUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", 2),
        ("M114\nL X+1 RL F100", 2),
        ("L X+1 RL F100\nM114", 2),
        ("M114\nL X+10 Y+0 FMAX\nCC X+5 Y+0\nC X+0 Y+0 DR+ F100", 4),
        ("M114\nL X+0 Y+0 FMAX\nL X+10 F100\nRND R2\nL Y+10", 4),
        ("M114\nL X+0 Y+0 Z+0 FMAX\nLN X+1 Y+0 Z+0 TX+0 TY+0 TZ+1 F100", 3),
        ("M114 B+45\nL X+1 FMAX", 1),
    ],
)
def test_what_no_manual_allows_with_it_is_an_error(blocks: str, line: int, mikron: Callable[[str], Run]) -> None:
    assert any(each[0] == line for each in errors(mikron(blocks))), blocks


@pytest.mark.parametrize("end", ["M30", "M2"])
def test_the_end_of_the_program_cancels_it(end: str, mikron: Callable[[str], Run]) -> None:
    """Manual of the iTNC 530: it is cancelled at the end of the program."""
    assert mikron(f"0 BEGIN PGM A MM\nM114\nL X+1 Y+0 Z+0 FMAX\n{end}\n1 END PGM A MM").diagnostics == ()


@pytest.mark.parametrize("code", [114, 115])
def test_other_controls_have_none(code: int, run: Runner, dmu65: Machine) -> None:
    assert errors(run(f"M{code}\nL X+1 FMAX", machine=dmu65)) == [(1, "NC220")]


def test_the_tip_leaves_its_line_between_the_ends(mikron: Callable[[str], Run]) -> None:
    found = mikron("M114\nL X-50 Y+0 Z+0 B-90 FMAX\nL X-43.3013 Z+25 B-60 F500")
    half_way = forward(found.machine, found.joints.mean(axis=0)[None])[0][0]
    off = math.dist(half_way, found.tip.mean(axis=0))
    assert 0.3 < off < 5.0
