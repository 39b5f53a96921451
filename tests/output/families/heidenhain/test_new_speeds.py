"""A new speed in a cut with TCP: the manuals of Klartext want TCP off at TOOL CALL."""

from pathlib import Path

import pytest

from tests.support.klartext import SIMULTANEOUS, TCP, Post


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.mark.parametrize("way", TCP)
def test_tcp_is_off_where_the_speed_changes(way: str, post: Post) -> None:
    lines = SIMULTANEOUS.split("\n")
    last = max(k for k, line in enumerate(lines) if line.startswith("GOTO/"))
    text = "\n".join([*lines[:last], "SPINDL/RPM,7000,CLW", *lines[last:]])
    code, out, err = post.all(text, "--set", f"tcpm={way}")
    assert code == 0
    blocks = [line.split(" ", 1)[1] for line in out.splitlines() if not line.startswith(" ")]
    assert "behind a cut: TCP is off at its TOOL CALL, and the tool stands where the cut ends" in err
    on, off = {"m128": ("M128", "M129")}.get(way, ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "FUNCTION RESET TCPM"))
    call = blocks.index("TOOL CALL Z S7000")
    assert blocks[call - 1 : call + 3] == [off, "TOOL CALL Z S7000", on, "M3"]
    # What X, Y and Z mean has changed between: all words are there again.
    assert all(f" {letter}" in blocks[call + 3] for letter in "XYZ")
    assert not any("M137" in block for block in blocks[call:])


def test_a_new_speed_away_from_the_part_is_no_warning(post: Post) -> None:
    lines = SIMULTANEOUS.split("\n")
    last = max(k for k, line in enumerate(lines) if line.startswith("GOTO/"))
    text = "\n".join([*lines[:last], "RAPID", "GOTO/0,0,150", "SPINDL/RPM,7000,CLW", *lines[last:]])
    assert "CTL470" not in post.all(text)[2]
