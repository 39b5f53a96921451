"""From every control to every other and back: the tool follows the same path, as far as the programs' digits go."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.conversion import Site, converted, losses, made, paths, posted, roomy, same
from tests.support.examples import examples
from tests.support.machines import five_axis_machines
from trunnion.arrays import Floats
from trunnion.controls import load_control
from trunnion.conversion import convert, transfer_settings
from trunnion.errors import InputError, warning
from trunnion.machines import load_machine
from trunnion.messages import Wording
from trunnion.model.motion import MachiningMode
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import (
    Arcs,
    CycleOff,
    CycleOn,
    Frame,
    Kind,
    LoadTool,
    Moves,
    Operation,
    Phase,
    Sense,
    SpindleOn,
    Tool,
    Toolpath,
)
from trunnion.readers.program.settings import family_of, reading_of
from trunnion.verification import Tolerances, failures, verify
from trunnion.verification.block_names import block_name_of


def sites() -> Iterator[tuple[str, Site]]:
    """The first shipped machine of each family with a writer and TCP, and of each control with words of its own."""
    for name in five_axis_machines():
        machine = roomy(load_machine(name))
        try:
            control = load_control(machine.control)
        except InputError:
            continue
        if control.tcp and "approach_five_axis" in control.templates:
            formats = control.number_formats(three_axis=False)
            digits = (0.5 * 10.0 ** -formats[key].decimals for key in ("coordinate", "angle"))
            own_words = bool(reading_of(machine).table("words").keys())
            yield control.name if own_words else family_of(machine), Site(machine, control, *digits)


SITES: dict[str, Site] = {}
for _family, _site in sites():
    SITES.setdefault(_family, _site)


@pytest.mark.parametrize("others", ["later", pytest.param("earlier", marks=pytest.mark.nightly)])
@pytest.mark.parametrize("source", sorted(SITES))
@settings(max_examples=examples(3))
@given(path=paths())
def test_every_other_control_makes_the_tool_go_the_same_way_and_back_again(
    tmp_path_factory: pytest.TempPathFactory, source: str, others: str, path: Toolpath
) -> None:
    """With itself and the controls after it: there and back is both ways of a pair."""
    folder = tmp_path_factory.getbasetemp()
    one = SITES[source]
    run = posted(path, one, {}, folder / f"one{one.control.extension}")
    for two in (SITES[name] for name in SITES if (name >= source) == (others == "later")):
        there = converted(run, one, two, folder / f"two{two.control.extension}")
        same(run, one, there, two)
        back = converted(there, two, one, folder / f"back{one.control.extension}")
        same(there, two, back, one)


def circle(tip: Floats, plane: Floats, random: np.random.Generator) -> tuple[Floats, Floats, Floats, float]:
    """End, centre, normal and radius of an arc or helix from a tip in a plane, whose Z is the last column."""
    radius, start, sweep = random.uniform(1.0, 30.0), *random.uniform(0.3, 5.8, 2)
    sense, rise = random.choice([-1.0, 1.0]), random.choice([0.0, 0.0, 3.0])
    arm = plane @ [np.cos(start), np.sin(start), 0.0]
    end = plane @ [np.cos(start + sense * sweep), np.sin(start + sense * sweep), 0.0]
    centre = tip - radius * arm
    return centre + radius * end + rise * plane[:, 2], centre, sense * plane[:, 2], radius


def upright_or_tilted(draw: st.DrawFn) -> Floats:
    """(3, 3): a plane that every machine reaches, with X of the part in it."""
    lean = np.radians(draw(st.sampled_from([0.0, draw(st.floats(8.0, 40.0))])))
    turn = np.radians(draw(st.floats(5.0, 80.0)))
    z = np.array([np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)])
    y = np.cross(z, [1.0, 0.0, 0.0])
    y /= np.linalg.norm(y)
    return np.column_stack((np.cross(y, z), y, z))


@st.composite
def level_paths(draw: st.DrawFn) -> Toolpath:
    """Operations with a constant tool axis, upright or tilted: lines and arcs about it, or holes."""
    made = []
    for number in range(draw(st.integers(1, 2))):
        plane = upright_or_tilted(draw)
        random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
        holes = draw(st.booleans())
        first = plane @ np.append(random.uniform(-30.0, 30.0, 2), 60.0)
        tips, kinds, arcs = [first], [Kind.RAPID], []
        for row in range(1, draw(st.integers(3, 8))):
            if holes:
                tips.append(plane @ np.append(random.uniform(-30.0, 30.0, 2), 0.0))
                kinds.append(Kind.LINEAR)
            elif random.uniform() < 0.5 and row > 1:
                end, *arc = circle(tips[-1], plane, random)
                tips.append(end)
                kinds.append(Kind.ARC)
                arcs.append((row, *arc))
            else:
                tips.append(tips[-1] + plane @ random.uniform(-15.0, 15.0, 3))
                kinds.append(Kind.LINEAR)
        tips.append(plane @ np.append((plane.T @ tips[-1])[:2], 70.0))
        kinds.append(Kind.RAPID)
        n = len(tips)
        kind = np.array(kinds, np.uint8)
        moves = Moves(
            tip=np.array(tips),
            axis=np.tile(plane[:, 2], (n, 1)),
            kind=kind,
            phase=np.where(kind == Kind.RAPID, np.uint8(Phase.RAPID), np.uint8(Phase.CUT)),
            feed=np.where(np.arange(n) > 0, 400.0, np.nan),
            per_rev=np.zeros(n, bool),
            line=np.arange(1, n + 1, dtype=np.int32),
        )
        events = [LoadTool(0, 1, 3), SpindleOn(0, 1, 2000.0, Sense.CLW)]
        if holes:
            heights = (("RAPTO", (3.0,)), ("FEDTO", (-12.0,)), ("RTRCTO", (30.0,)), ("MMPM", (90.0,)))
            events += [CycleOn(1, 1, ("DRILL",), heights), CycleOff(n - 1, 1)]
        rows, centres, normals, radii = zip(*arcs, strict=True) if arcs else ([], [], [], [])
        columns = np.array(rows, np.int64), np.array(centres), np.array(normals), np.array(radii)
        curves = Arcs(*columns, np.zeros(len(arcs), np.int64)) if arcs else Arcs.empty()
        tool = Tool("MILL", "D10", 10.0, 5.0, 80.0)
        made.append(Operation(f"OP{number}", tool, Frame(), moves, curves, tuple(events), 1, 0.01, 0.01))
    return Toolpath("made.cls", tuple(made))


@pytest.mark.third
@pytest.mark.parametrize("source", sorted(SITES))
@settings(max_examples=examples(3))
@given(path=level_paths())
def test_arcs_holes_and_tilted_planes_are_on_every_other_control_what_the_cl_file_asks_for(
    tmp_path_factory: pytest.TempPathFactory, source: str, path: Toolpath
) -> None:
    folder = tmp_path_factory.getbasetemp()
    one = SITES[source]
    try:
        run, expected = made(path, one, {}, folder / f"level{one.control.extension}")
    except InputError:
        assume(False)  # no room, or no words
    curved = any(operation.moves.axis[0, 2] < 1.0 and len(operation.arcs.row) for operation in path.operations)
    for two in SITES.values():
        if curved and MachiningMode.TILTED not in two.control.modes({}):
            continue  # lines for circles that are rounded already: the proof may find their ends beyond the tolerance
        found = convert(run, one.control)
        assert losses(found) == one_remark_about_cycles(run)
        carried = transfer_settings(found.settings, one.control, two.control)
        there, other = made(found.toolpath, two, carried, folder / f"two{two.control.extension}")
        each_operation = zip(expected.tolerances, other.tolerances, path.operations, strict=True)
        both = [added(*each) for each in each_operation]
        milled = [(k, each) for k, each in enumerate(path.operations) if not drills(each)]
        if len(milled) == len(path.operations):
            checks = failures(verify(there, [path], tolerances=both, settings=other.settings))
            assert not checks, [(check.key, check.summary) for check in checks]
        for k, operation in enumerate(path.operations):
            if drills(operation):
                drilled(there, operation, both[k].tip)


def one_remark_about_cycles(run: Run) -> list[str]:
    """What the conversion says of a program with cycles: one warning, at the first; nothing of holes as motion."""
    holes = [event for event in run.events if event.kind == "hole"]
    if not holes:
        return []
    first = block_name_of(run, holes[0].before_row)
    wording = Wording("CNV163", "cycles_become_motion", count=len(holes), first=first)
    return [str(warning(run.files[0], holes[0].line, wording))]


def drills(operation: Operation) -> bool:
    return any(isinstance(event, CycleOn) for event in operation.events)


def drilled(run: Run, operation: Operation, allowed: float) -> None:
    """The tool reaches the depth of each hole, its clearance height and its retract height."""
    tips = run.tip
    for tip, axis in zip(operation.moves.tip[1:-1], operation.moves.axis[1:-1], strict=True):
        for height in (-12.0, 3.0, 30.0):
            assert np.abs(tips - tip - height * axis).max(axis=1).min() <= 2.0 * allowed + 1e-6


def added(one: Tolerances, other: Tolerances, operation: Operation) -> Tolerances:
    """The tolerances of a program that was posted from another one.

    Between its ends an arc of the first program is off by more than these: its start is rounded by half a digit in two
    coordinates, e, and the centre from there by as much, d. A point at the angle a is off by e + d - d turned by a.
    """
    along = 3.0 * np.sqrt(2.0) - np.sqrt(3.0) if len(operation.arcs.row) else 0.0
    tip = one.tip * (1.0 + along / np.sqrt(3.0)) + other.tip
    return Tolerances(tip, one.angle + other.angle, one.chord + other.chord, one.feed + other.feed)


@pytest.mark.parametrize("source", ["Haas NGC", "fanuc_30i"])
def test_a_rounded_helix_is_as_near_as_its_digits_go_where_it_is_written_as_lines(source: str, tmp_path: Path) -> None:
    """The start, and the centre from there, of this one are rounded to opposite sides."""
    tips = [[-25.24725057, 9.25101732, 60.0], [-26.80076763, 15.36705854, 53.27815375]]
    tips += [[-55.41282035, 22.62015342, 56.27815375], [-55.41282035, 22.62015342, 70.0]]
    kind = np.array([Kind.RAPID, Kind.LINEAR, Kind.ARC, Kind.RAPID], np.uint8)
    phase = np.where(kind == Kind.RAPID, np.uint8(Phase.RAPID), np.uint8(Phase.CUT))
    feed = np.array([np.nan, 400.0, 400.0, 400.0])
    axis, lines = np.tile([0.0, 0.0, 1.0], (4, 1)), np.arange(1, 5, dtype=np.int32)
    moves = Moves(np.array(tips), axis, kind, phase, feed, np.zeros(4, bool), lines)
    centre = np.array([[-37.15827446, 34.56974978, 53.27815375]])
    arcs = Arcs(np.array([2]), centre, axis[:1], np.array([21.81791234]), np.zeros(1, np.int64))
    events = LoadTool(0, 1, 3), SpindleOn(0, 1, 2000.0, Sense.CLW)
    tool = Tool("MILL", "D10", 10.0, 5.0, 80.0)
    operation = Operation("OP", tool, Frame(), moves, arcs, events, 1, 0.01, 0.01)
    path = Toolpath("made.cls", (operation,))
    one, two = SITES[source], SITES["heidenhain_itnc530"]
    run, expected = made(path, one, {}, tmp_path / "one.nc")
    found = convert(run, one.control)
    carried = transfer_settings(found.settings, one.control, two.control)
    there, other = made(found.toolpath, two, carried, tmp_path / "two.h")
    allowed = added(expected.tolerances[0], other.tolerances[0], operation)
    assert failures(verify(there, [path], tolerances=[allowed], settings=other.settings)) == []
    tighter = replace(allowed, tip=expected.tolerances[0].tip + other.tolerances[0].tip)
    checks = failures(verify(there, [path], tolerances=[tighter], settings=other.settings))
    assert [check.key for check in checks] == ["tip"]


@pytest.mark.third
@pytest.mark.parametrize("source", sorted(SITES))
def test_turns_at_the_pole_are_no_points_and_come_back_once(tmp_path: Path, source: str) -> None:
    site = SITES[source]
    lean = np.array([[0.0, -0.2], [0.0, -0.1], [0.0, 0.0], [0.0, 0.0], [0.1, 0.0], [0.2, 0.0]])
    axis = np.column_stack((lean, np.sqrt(1.0 - (lean**2).sum(axis=1))))
    n = len(axis)
    kind = np.array([Kind.RAPID] + [Kind.LINEAR] * (n - 1), np.uint8)
    tip = np.column_stack((10.0 * np.arange(n), np.full(n, 5.0), np.full(n, 20.0)))
    phase = np.where(kind == Kind.RAPID, np.uint8(Phase.RAPID), np.uint8(Phase.CUT))
    feed = np.array([np.nan] + [400.0] * (n - 1))
    moves = Moves(tip, axis, kind, phase, feed, np.zeros(n, bool), np.arange(1, n + 1, dtype=np.int32))
    tool = Tool("MILL", "D10", 10.0, 5.0, 80.0)
    events = LoadTool(0, 1, 3), SpindleOn(0, 1, 2000.0, Sense.CLW)
    path = Toolpath("made.cls", (Operation("OP1", tool, Frame(), moves, Arcs.empty(), events, 1, 0.01, 0.01),))
    run = posted(path, site, {}, tmp_path / "one")
    turns = np.abs(np.diff(run.rotary, axis=0)).max(axis=1) > 1e-9
    at_rest = np.abs(np.diff(run.tip, axis=0)).max(axis=1) < 1e-9
    assert (turns & at_rest & run.tcp[1:] & run.tcp[:-1]).any()
    found = convert(run, site.control)
    (operation,) = found.toolpath.operations
    again = posted(
        found.toolpath, site, transfer_settings(found.settings, site.control, site.control), tmp_path / "two"
    )
    assert np.linalg.norm(np.diff(operation.moves.tip, axis=0), axis=1).min() > 1e-6
    assert len(again) == len(run)


VECTORS = sorted(
    key
    for key, site in SITES.items()
    if "orientation" in site.control.settings
    and not site.control.family.validate_settings({**site.control.settings, "orientation": "vector"})
)


@pytest.mark.parametrize("key", VECTORS)
@settings(max_examples=examples(5))
@given(path=paths())
def test_orientations_by_vectors_stay_vectors_on_the_same_family(
    tmp_path_factory: pytest.TempPathFactory, key: str, path: Toolpath
) -> None:
    folder, site = tmp_path_factory.getbasetemp(), SITES[key]
    try:
        run = posted(path, site, {"orientation": "vector"}, folder / "vector.nc")
    except InputError:
        assume(False)  # vectors that lead elsewhere
    again = converted(run, site, site, folder / "again.nc")
    said = [run.programmed & int(ProgrammedWord.VECTOR) != 0 for run in (run, again)]
    assert said[0].any()
    assert said[0].tolist() == said[1].tolist()
    same(run, site, again, site)


def test_vectors_are_known_to_more_than_one_family() -> None:
    assert {"sinumerik_840d", "heidenhain_tnc640"} <= set(VECTORS)


def test_every_family_that_can_be_written_is_among_them() -> None:
    assert {
        "sinumerik_840d",
        "heidenhain_itnc530",
        "heidenhain_tnc640",
        "fidia_nc15",
        "linuxcnc",
        "Haas NGC",
    } <= SITES.keys()
