"""The pole of circles lies in the plane of the tool axis: a coordinate across it would be lost."""

import pytest

from tests.support.reading import Runner


@pytest.mark.parametrize(
    ("blocks", "lines"),
    [
        ("CC X+37 Z+3\nCP IPA+90 DR+ F500", [2, 3]),
        ("CC IX+1 IZ+3\nC X+1 Y+1 DR+ F500", [2, 3]),
        ("CC X+1 Y+1\nCP IPA+90 DR+ F500", []),
        ("TOOL CALL 1 Y S100\nCC X+1 Y+1\nLP PR+5 PA+90 F500", [3, 4]),
    ],
)
def test_a_pole_outside_its_plane_is_refused(blocks: str, lines: list[int], run: Runner) -> None:
    found = run(f"L X+2 Y+1 Z+0 R0 FMAX\n{blocks}\n")
    assert [error.line for error in found.errors if error.code in ("NC220", "NC210")] == lines
