"""The page about CL files and the reader do not drift apart."""

import re

from tests.support.locations import DOCS
from trunnion.cl.arcs import RADIUS_TOLERANCE
from trunnion.cl.phases import COLOUR_PHASES
from trunnion.cl.statements import HANDLERS

PAGE = (DOCS / "cl.md").read_text(encoding="utf-8")


def test_every_statement_that_is_read_is_in_the_page() -> None:
    named = set(re.findall(r"`([A-Z-]+(?: PATH)?)", PAGE))
    assert {major.replace("TOOLPATH", "TOOL PATH") for major in HANDLERS} <= named


def test_every_colour_and_the_tolerance_are_in_the_page() -> None:
    assert all(re.search(rf"\| {colour} \|", PAGE) for colour in COLOUR_PHASES)
    assert f"{RADIUS_TOLERANCE} mm" in PAGE
