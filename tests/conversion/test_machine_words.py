"""Words of the machine builder: only what means the same on the other machine goes over."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import RefusedError
from trunnion.jobs.convert.result import ConvertResult

FANUC = """%
O0001
G21 G90 G94
T5 M6
G53 G0 Z0.
G54 S500 M3
G43 H5 G0 X0. Y0. Z50.
{word}
G1 Z5. F100.
G0 Z50.
G53 G0 Z0.
G49
M30
%
"""


def machine(folder: Path, base: str, *known: str) -> Path:
    """A machine of its own whose definition declares words."""
    path = folder / f"our_{base}.toml"
    path.write_text("\n".join([f'extends = "{base}"', "[control.known]", *known, ""]))
    return path


def converted(folder: Path, word: str, one: Path | str, two: Path | str, *, force: bool = False) -> ConvertResult:
    program = folder / "part.nc"
    program.write_text(FANUC.format(word=word))
    return trunnion.convert(program, machine=one, to_machine=two, force=force)


@pytest.mark.parametrize("word", ["M60", "M13", "M10", "M131"])
def test_a_word_that_nobody_declares_is_refused_for_another_machine(word: str, tmp_path: Path) -> None:
    with pytest.raises(RefusedError, match=f"{word} is a word of the machine's builder"):
        converted(tmp_path, word, "matsuura_mx330", "mikron_600u")
    forced = converted(tmp_path, word, "matsuura_mx330", "mikron_600u", force=True)
    assert f" {word}\n" not in (forced.text or "")
    own = converted(tmp_path, word, "matsuura_mx330", "matsuura_mx330").text or ""
    assert word in own, "on the same machine it means the same"


def test_a_word_without_effect_is_left_out_by_name(tmp_path: Path) -> None:
    ours = machine(tmp_path, "matsuura_mx330", 'M60 = "no effect: chip conveyor on"')
    found = converted(tmp_path, "M60", ours, "mikron_600u")
    assert "M60" not in (found.text or "")
    (said,) = [problem for problem in found.problems if "M60" in problem.what]
    assert said.what == "M60 (chip conveyor on) is not carried over: mikron_600u has no word with this meaning"


def test_a_word_with_the_same_meaning_becomes_the_other_machines_word(tmp_path: Path) -> None:
    ours = machine(tmp_path, "matsuura_mx330", 'M60 = "no effect: chip conveyor on"')
    theirs = machine(tmp_path, "mikron_600u", 'M71 = "no effect: chip conveyor on"')
    text = converted(tmp_path, "M60", ours, theirs).text or ""
    assert "M71" in text
    assert "M60" not in text


@pytest.mark.parametrize(
    ("effect", "written"), [("stop", "M0"), ("spindle counter-clockwise, coolant flood", "M4"), ("optional stop", "M1")]
)
def test_a_word_with_an_effect_becomes_what_the_other_control_has_for_it(
    effect: str, written: str, tmp_path: Path
) -> None:
    ours = machine(tmp_path, "matsuura_mx330", f'M60 = "{effect}"')
    words = (converted(tmp_path, "M60", ours, "yl569").text or "").split()
    assert written in words
    assert "M60" not in words


def test_a_cl_file_keeps_the_words_and_says_for_which_machine(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(FANUC.format(word="M60"))
    found = trunnion.convert(program, machine="matsuura_mx330", to_cl=True)
    assert "INSERT/M60" in (found.text or "")
    assert [problem.what for problem in found.problems] == [
        "M60: words of the builder of matsuura_mx330, kept as INSERT"
    ]
