"""What F counts without TCP, against the way written out axis by axis, and against the times that follow from it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.klartext_reading import dmu65, run
from tests.support.reading import Runner
from trunnion.machines import forward, load_machine
from trunnion.model.feed_path import FeedPath, feed_path_lengths, row_feed_path_lengths
from trunnion.verification import verify

__all__ = ["dmu65", "run"]

MACHINE = load_machine("mikron_600u")
PLACES = st.lists(st.floats(-90.0, 90.0), min_size=5, max_size=5)


@given(before=PLACES, after=PLACES, still=st.sets(st.integers(0, 4)))
def test_each_rule_counts_what_it_says(before: list[float], after: list[float], still: set[int]) -> None:
    after = [before[k] if k in still else value for k, value in enumerate(after)]
    steps = [b - a for a, b in zip(before, after, strict=True)]
    slides = math.sqrt(sum(steps[k] ** 2 for k in MACHINE.linear))
    turned = max(abs(steps[k]) for k in MACHINE.rotary)
    there = np.array([before] * 3), np.array([after] * 3)
    way = feed_path_lengths(MACHINE, *there, np.array([FeedPath.SLIDES, FeedPath.AXES, FeedPath.TIP], np.uint8))
    assert way[0] == pytest.approx(slides if slides > 1e-9 else turned, abs=1e-9)
    assert way[1] == pytest.approx(math.sqrt(sum(step**2 for step in steps)), abs=1e-9)
    ends = [np.array(before) + h * np.array(steps) for h in (-1e-4, 1e-4)]
    tips = forward(MACHINE, np.array(ends))[0]
    assert way[2] == pytest.approx(np.linalg.norm(tips[1] - tips[0]) / 2e-4, rel=2e-3, abs=1e-3)


LINES = """0 BEGIN PGM P MM
1 TOOL CALL 1 Z S100
2 M3
3 L X+100 Y+0 Z+0 A-90 C+0 FMAX{more}
{blocks}9 M30
10 END PGM P MM
"""


@pytest.mark.parametrize(
    ("block", "more", "seconds"),
    [
        ("L C+30 F600", "", 3.0),  # 30 degrees at 600 degrees a minute
        ("L X+140 C+30 F600", "", 5.0),  # 40 mm and 30 degrees: 50 together
        ("L A-80 C+24 F600", "", 2.6),
        ("L X+140 F600", "", 4.0),
        ("L A-60 F600", " M116", 100.0 * math.radians(30.0) / 10.0),  # 100 mm from A
        ("L X+140 F600", " M116", 4.0),
    ],
)
def test_a_block_takes_what_the_control_makes_of_its_f(block: str, more: str, seconds: float, run: Runner) -> None:
    text = LINES.format(blocks=f"4 {block}\n", more=more)
    found = run(text.replace("Y+0 Z+0", "Y+100 Z+0") if more else text)
    assert verify(found).seconds[1] == pytest.approx(seconds, rel=1e-4)


def test_only_blocks_that_turn_without_tcp_count_something_else(run: Runner) -> None:
    blocks = "4 L X+140 F600\n5 L X+150 C+20\n6 M128\n7 L C+40\n8 M129\n"
    found = run(LINES.format(blocks=blocks, more=""))
    way = row_feed_path_lengths(found, np.arange(len(found)))
    assert np.isnan(way).tolist() == [True, True, False, True]
    assert way[2] == pytest.approx(math.hypot(10.0, 20.0))
    assert row_feed_path_lengths(found, np.array([2, 0])).tolist()[0] == way[2]


def test_m116_leaves_out_the_axes_of_a_head(run: Runner) -> None:
    found = run(LINES.format(blocks="4 L Z+1 F100\n", more=" M116"), load_machine("generic_head_head_ca"))
    assert [str(f.severity) for f in found.diagnostics if "M116" in f.text] == ["warning"]
