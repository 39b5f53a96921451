"""Circles and helices in Klartext, as the independent reader finds them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, OWN, Post, motion, proven, toolpath_of
from tests.support.operations import moves_of
from tests.support.posting import FOOT, HEAD
from trunnion.arrays import Floats
from trunnion.controls import Control, load_control
from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.model.toolpath import Arcs, Kind, Moves


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


ARC = "CIRCLE/{centre},0.0,0.0,{sense},10.0,0.06,0.5,10.0,0.0{turns}\nGOTO/{end}\n"


@pytest.mark.parametrize(
    ("arc", "blocks"),
    [
        ({"end": "0.0,10.0,5.0", "sense": "1.0"}, ["CC X+0 Y+0", "C X+0 Y+10 DR+"]),
        ({"end": "10.0,0.0,5.0", "sense": "-1.0"}, ["CC X+0 Y+0", "C X+10 Y+0 DR-"]),
        ({"end": "0.0,10.0,2.5", "sense": "1.0"}, ["CC X+0 Y+0", "CP IPA+90 IZ-2.5 DR+"]),
        ({"end": "0.0,10.0,2.5", "sense": "-1.0"}, ["CC X+0 Y+0", "CP IPA-270 IZ-2.5 DR-"]),
        ({"end": "10.0,0.0,2.5", "sense": "-1.0", "turns": ",TIMES,3"}, ["CC X+0 Y+0", "CP IPA-1080 IZ-2.5 DR-"]),
    ],
)  # fmt: skip
def test_arcs_have_their_centre_before_them_and_rise_as_polar_ones(
    arc: dict[str, str], blocks: list[str], post: Post
) -> None:
    text = ARC.format(**{"centre": "0.0,0.0,5.0", "turns": "", **arc})
    after = post(HEAD + text + "GOTO/10.0,20.0,2.5\n" + FOOT)
    at = after.index(blocks[0])
    assert after[at : at + 2] == blocks
    rises = blocks[1].startswith("CP")
    assert after[at + 2].startswith("L X+10 Y+20" if rises else "L ")
    assert ("Z+2.5" in after[at + 2]) is True, "nothing is left out that the polar block has not said"


def test_a_height_that_a_helix_has_left_is_written_again_behind_a_flat_arc(post: Post) -> None:
    rise = ARC.format(centre="0.0,0.0,5.0", sense="1.0", end="0.0,10.0,2.5", turns="")
    flat = ARC.format(centre="0.0,0.0,2.5", sense="1.0", end="-10.0,0.0,2.5", turns="")
    after = post(HEAD + rise + flat + "GOTO/-10.0,0.0,5.0\n" + FOOT)
    at = after.index("CP IPA+90 IZ-2.5 DR+")
    assert after[at + 1 : at + 4] == ["CC X+0 Y+0", "C X-10 Y+0 DR+", "L Z+5"]


def test_an_arc_in_another_plane_becomes_lines(post: Post) -> None:
    text = "CIRCLE/0.0,0.0,5.0,0.0,1.0,0.0,10.0,0.06,0.5,10.0,0.0\nGOTO/0.0,0.0,-5.0\n"
    blocks = post(HEAD + text + FOOT)
    assert not any(block.startswith(("CC", "C ", "CP")) for block in blocks)
    assert len(blocks) > 40


@st.composite
def circles(draw: st.DrawFn, flat: bool = False) -> tuple[Moves, Arcs]:
    """Arcs about the tool axis that follow one another: parts of circles, whole ones, helices, several turns."""
    n = draw(st.integers(1, 5))
    tip, centre, radius, sense, turns = [np.array([30.0, -20.0, 4.0])], [], [], [], []
    for _ in range(n):
        r, at, side = draw(st.floats(0.5, 200.0)), draw(st.floats(-np.pi, np.pi)), draw(st.sampled_from([-1.0, 1.0]))
        sweep = draw(st.one_of(st.floats(0.05, 6.2), st.just(2.0 * np.pi)))
        rise = draw(st.integers(-500, 500)) / 100.0 if not flat and draw(st.booleans()) else 0.0
        middle = tip[-1] - r * np.array([np.cos(at), np.sin(at), 0.0])
        angle = at + side * sweep
        end = middle + r * np.array([np.cos(angle), np.sin(angle), 0.0]) + [0.0, 0.0, rise]
        tip.append(tip[-1] + [0.0, 0.0, rise] if sweep == 2.0 * np.pi else end)
        centre.append(middle)
        radius.append(r)
        sense.append([0.0, 0.0, side])
        turns.append(0 if flat else draw(st.integers(0, 3)))
    rows = np.arange(1, n + 1)
    points = np.round([*tip, tip[-1] + [1.0, 0.0, 0.0]], 4)  # as CL files print them
    kind = np.full(n + 2, Kind.ARC, np.uint8)
    kind[[0, -1]] = Kind.LINEAR
    moves = replace(moves_of(points, np.tile([0.0, 0.0, 1.0], (len(points), 1))), kind=kind)
    return moves, Arcs(rows, np.array(centre), np.array(sense), np.array(radius), np.array(turns))


@settings(max_examples=examples(30))
@given(path=circles())
def test_arcs_and_helices_are_proven(path: tuple[Moves, Arcs], folder: Path) -> None:
    machine = OWN["ucp800"]  # whose slides have no limits
    proven(toolpath_of(*path), machine, CONTROLS["ucp800"], folder)


# By radius


def by_radius(control: Control) -> Control:
    return replace(control, arcs=replace(control.arcs, by_radius=True))


@settings(max_examples=examples(40))
@given(path=circles() | circles(flat=True))
def test_circles_by_radius_are_those_that_were_planned(path: tuple[Moves, Arcs], folder: Path) -> None:
    """The reader finds the centre by the radius; where it would be off, the writer gives the centre."""
    machine = OWN["ucp800"]
    found = proven(toolpath_of(*path), machine, by_radius(CONTROLS["ucp800"]), folder)
    moves, arcs = path
    text = (folder / "part.h").read_text(encoding="utf-8")
    said = re.findall(r" CR X[-+][\d.]+ Y[-+][\d.]+ R([-+])[\d.]+ DR([-+])", text)
    event(f"by radius: {len(said) > 0}")
    event(f"over half a turn: {any(sign == '-' for sign, _ in said)}")
    ran = found.run.arcs
    # Far from half a turn, and not from where a helix has ended, a radius says every flat arc.
    flat = (moves.tip[arcs.row, 2] == moves.tip[arcs.row - 1, 2]) & (arcs.full_turns == 0)
    sweep = swept(moves, arcs)
    clear = (np.abs(sweep - 180.0) > 60.0) & (sweep > 60.0) & (sweep < 300.0)
    behind = np.concatenate(([False], ~flat[:-1]))
    assert len(said) >= int((flat & clear & ~behind).sum())
    if len(ran.row) == len(arcs.row):
        assert np.abs(ran.centre[:, :2] - arcs.centre[:, :2])[flat & ~behind].max(initial=0.0) < 3.1e-4
        assert (ran.normal[:, 2] == arcs.normal[:, 2]).all()
        assert (ran.full_turns == arcs.full_turns).all()


def swept(moves: Moves, arcs: Arcs) -> Floats:
    """Degrees, from 0 to 360."""
    a, b = moves.tip[arcs.row - 1] - arcs.centre, moves.tip[arcs.row] - arcs.centre
    turned = np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0])
    return np.asarray(np.degrees(turned * arcs.normal[:, 2]) % 360.0)


ROUND = "CIRCLE/0.0,0.0,5.0,0.0,0.0,{sense},10.0,0.06,0.5,10.0,0.0\nGOTO/{end},5.0\n"


@pytest.mark.parametrize(
    ("end", "sense", "blocks"),
    [
        ("0.0,10.0", "1.0", ["CR X+0 Y+10 R+10 DR+"]),
        ("0.0,10.0", "-1.0", ["CR X+0 Y+10 R-10 DR-"]),
        ("8.0,-6.0", "-1.0", ["CR X+8 Y-6 R+10 DR-"]),
        ("8.0,-6.0", "1.0", ["CR X+8 Y-6 R-10 DR+"]),
        ("-10.0,0.0", "1.0", ["CC X+0 Y+0", "C X-10 Y+0 DR+"]),
        ("10.0,0.0", "-1.0", ["CC X+0 Y+0", "C X+10 Y+0 DR-"]),
    ],
)
def test_a_radius_is_negative_over_half_a_turn_and_says_no_half_or_whole_circle(
    end: str, sense: str, blocks: list[str], post: Post
) -> None:
    machine = post.folder / "radius.toml"
    machine.write_text('extends = "dmu65"\n[control.arcs]\nby = "radius"\n', encoding="utf-8")
    text = HEAD + ROUND.format(end=end, sense=sense) + "GOTO/20,20,5\n" + FOOT
    after = motion(post(text, machine=str(machine)))
    assert after[2:-1] == blocks
    assert after[-1].startswith("L X+20 Y+20")


def test_only_families_that_have_words_for_it_say_circles_by_radius(tmp_path: Path) -> None:
    machine = tmp_path / "radius.toml"
    machine.write_text('extends = "yl569"\n[control.arcs]\nby = "radius"\n', encoding="utf-8")
    with pytest.raises(InputError, match="no words for that"):
        load_control(load_machine(str(machine)).control)
