"""Rotary axes that are positioned at a feed, away from the part, are no cuts: in programs of every control."""

from pathlib import Path

import pytest

from tests.support.verifying import check
from trunnion import post, verify

CORNER = Path(__file__).parents[1] / "golden" / "dmu65" / "corner.cls"

#: Of programs for each machine what a shop changes: a block that positions rotary axes at rapid, and the same at feed.
AT_FEED = {
    "dmu65": [
        ("TURN FMAX SEQ-", "TURN F5000 SEQ-"),
        ("L A-54.7356 C-135 R0 FMAX", "L A-54.7356 C-135 R0 F5000"),
        ("L A+0 C+0 R0 FMAX", "L A+0 C+0 R0 F5000"),
    ],
    "yl569": [
        ("G0 B54.73561 C315.\n", "G1 F5000 B54.73561 C315.\n"),
        ("CYCLE800(0,\"\",0,57", "G1 F5000 CYCLE800(0,\"\",0,57"),
    ],
    "matsuura_mx330": [("G0 A-54.736 C225.", "G1 F5000. A-54.736 C225."), ("G53.1", "G1 F5000. G53.1")],
    "haas_umc750": [("G0 B54.736 C-45.", "G1 F5000. B54.736 C-45.")],
    "hs664rt": [("G01 C45. A54.736 F3000", "G01 C45. A54.736 F2000"), ("G1 C0. A0. F3000", "G1 C0. A0. F2000")],
    "xyzac_trt": [("G0 A-54.73561 C-45.", "G1 F1000. A-54.73561 C-45.")],
}  # fmt: skip

#: What turns at the part, on the DMU 65: behind its last cut, within it, and without the retract before the way home.
AT_THE_PART = [
    ("37 L Z+88.1766 FMAX", "37 L Z+88.1766 FMAX\n L C-100 F2000\n L C-135 F2000"),
    ("33 L Y+19.4948", "33 L Y+19.4948\n L C-134\n L C-135"),
    ("40 L Z+560 R0 FMAX M91\n", ""),
]


@pytest.mark.parametrize("machine", AT_FEED)
def test_away_from_the_part_rotary_axes_may_be_positioned_at_feed(machine: str, tmp_path: Path) -> None:
    """The half-way point of such a turn is on no path of the tool."""
    program = tmp_path / "part.nc"
    assert post(CORNER, machine=machine, output=program).passed
    text = program.read_text(encoding="utf-8")
    for rapid, feed in AT_FEED[machine]:
        changed = tmp_path / "changed.nc"
        changed.write_text(text.replace(rapid, feed), encoding="utf-8")
        found = verify(changed, machine=machine, cl=CORNER)
        assert rapid in text
        assert found.passed, [each.summary for each in found.checks if not each.passed]
        assert (check(found, "span").worst or 0.0) < 1e-3


def test_at_the_part_a_turn_at_feed_stays_a_fault(tmp_path: Path) -> None:
    program = tmp_path / "part.h"
    post(CORNER, machine="dmu65", output=program)
    text = program.read_text(encoding="utf-8").replace("L A+0 C+0 R0 FMAX", "L A+0 C+0 R0 F5000")
    for sound, harmful in AT_THE_PART:
        (tmp_path / "changed.h").write_text(text.replace(sound, harmful), encoding="utf-8")
        found = verify(tmp_path / "changed.h", machine="dmu65", cl=CORNER)
        assert sound in text
        assert not found.passed, harmful
