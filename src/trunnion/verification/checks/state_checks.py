"""What is in force in a program against what the CL file asks for: spindle, tool, coolant, offset, home."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.machines import Machine
from trunnion.model.run import Run, RunEvent, offset_name
from trunnion.model.toolpath import Kind
from trunnion.readers import uses_length_numbers
from trunnion.verification.context import MAX_PLACES, Context, check_from_places
from trunnion.verification.expected.path import ExpectedSpindle, ExpectedTool, Stretch, names_tool
from trunnion.verification.matching.path_matching import CHUNK, Matching
from trunnion.verification.matching.row_ranges import RowRanges
from trunnion.verification.results import Check, Place

#: How a CL coolant shows in a run; others are words of the machine builder, which nobody but him can read.
_COOLANT = {"OFF": "off", "ON": "flood", "FLOOD": "flood", "TAP": "flood", "MIST": "mist"}

#: A spindle speed is printed without decimals.
_RPM = 0.5 + 1e-6

#: Home is met within this, mm or degrees.
_HOME = 1e-6


def _part(context: Context, stretch: Stretch) -> tuple[int, int]:
    """Which pairs belong to a stretch of CL rows."""
    assert context.matching is not None
    return context.matching.cl.before(stretch.first), context.matching.cl.before(stretch.end)


def _first_wrong(matching: Matching, first: int, end: int, wrong: Callable[[Ints], Flags]) -> tuple[int, int] | None:
    """The first pair of some, as rows of run and CL files, whose rows of the run are wrong."""
    for nc, cl in matching.pair_chunks(first, end):
        found = wrong(nc)
        if found.any():
            k = int(np.argmax(found))
            return int(nc[k]), int(cl[k])
    return None


def spindle(context: Context) -> Check:
    """Speed and sense at every point, and no other ones anywhere."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    places: list[Place] = []
    asked: set[ExpectedSpindle] = set()
    for stretch in expected.spindle():
        want = stretch.value
        first, end = _part(context, stretch)
        if not isinstance(want, ExpectedSpindle) or first == end:
            continue
        asked.add(want)
        if want.sense == 0 and _stops_after(context, matching.nc[first]):
            first += 1
        bad = _first_wrong(matching, first, end, partial(_turns_otherwise, run, want))
        if bad is not None:
            row, cl = bad
            rpm = run.state.rpm[row]
            has, should = _turning(rpm, run.state.spindle[row]), _turning(want.rpm, want.sense)
            places.append(context.place(row, rpm, f"{has}; the CL file wants {should}", cl))
    senses = {"clockwise": 1, "counter-clockwise": -1}
    for event in run.events if asked else ():
        if event.kind == "spindle":
            sense = senses.get(str(event.value), event.value)
            if isinstance(sense, int | float) and sense and not any(want.sense == sense for want in asked):
                places.append(context.at(event, 0.0, "starts the spindle in a sense that the CL file never asks for"))
        elif event.kind == "speed" and isinstance(event.value, float):
            rpm = event.value
            if not any(abs(want.rpm - rpm) <= _RPM for want in asked):
                places.append(context.at(event, rpm, f"S{rpm:g} is no speed that the CL file asks for"))
    good = ", ".join(_turning(want.rpm, want.sense) for want in sorted(asked, key=lambda w: (w.rpm, w.sense)))
    places.sort(key=lambda place: place.nc_line)
    return check_from_places(
        "spindle", "spindle as the CL file says", places, good or "the CL file says nothing of a spindle"
    )


def _stops_after(context: Context, row: int) -> bool:
    """Whether the spindle stands after a row: M5 acts after the motion of its block."""
    after = context.after(row)
    return after != row and context.run.state.spindle[after] == 0


def _turns_otherwise(run: Run, want: ExpectedSpindle, nc: Ints) -> Flags:
    wrong = run.state.spindle.at(nc) != want.sense
    if want.sense:
        wrong |= np.abs(run.state.rpm.at(nc) - want.rpm) > _RPM
    return np.asarray(wrong)


def _turning(rpm: float, sense: int) -> str:
    if sense == 0:
        return "spindle off"
    return f"{rpm:g} rev/min {'clockwise' if sense > 0 else 'counterclockwise'}"


def tool(context: Context) -> Check:
    """The tool at every point, its edge, and no other tool changed to."""
    expected, matching, run, settings = context.expected, context.matching, context.run, context.settings
    assert expected is not None
    assert matching is not None
    places: list[Place] = []
    known: list[tuple[str, ...]] = []
    for stretch in expected.tools():
        call = stretch.value
        assert isinstance(call, ExpectedTool)
        names = (settings.tool,) if settings.tool else call.names
        first, end = _part(context, stretch)
        if (call.number is None and not settings.tool) or first == end:
            continue
        known.append(names)
        right = [k for k, text in enumerate(run.tools) if names_tool(text, names)]
        bad = _first_wrong(matching, first, end, partial(_holds_another, run, right))
        if bad is not None:
            row, cl = bad
            has = run.tools[run.state.tool[row]] or "no tool"
            text = f"tool {has} is in the spindle; the CL file wants {names[0]}"
            places.append(context.place(row, 0.0, text, cl))
            calls = [e for e in run.events if e.kind in ("tool", "tool_change") and e.before_row <= row]
            if calls:
                places.append(context.at(calls[-1], 0.0, f"{text}: this is the last word on it"))
    if settings.edge is not None:
        places += _edges(context, matching, settings.edge)
    if uses_length_numbers(run.machine):
        places += _lengths(context)
    for event in run.events if known else ():
        if event.kind == "tool_change":
            text = str(event.value or "")
            if text and text != "0" and not any(names_tool(text, names) for names in known):
                places.append(context.at(event, 0.0, f"changes to tool {text}, which the CL file never asks for"))
    good = ", ".join(dict.fromkeys(f"tool {names[0]}" for names in known)) or "the CL file names no tool"
    return check_from_places("tool", "tools as the CL file says", sorted(places, key=lambda p: p.nc_line), good)


def _holds_another(run: Run, right: list[int], nc: Ints) -> Flags:
    wrong: Flags = np.ones(len(run.tools), np.bool_)
    wrong[right] = False
    return np.asarray(wrong[run.state.tool.at(nc)])


def _edges(context: Context, matching: Matching, asked: int) -> list[Place]:
    """The first motion under another cutting edge, and the first one home under one that is neither none nor it."""
    used = context.run.state.edge
    places: list[Place] = []
    bad = _first_wrong(matching, 0, len(matching.nc), lambda nc: used.at(nc) != asked)
    if bad is not None:
        row, cl = bad
        places.append(context.place(row, 0.0, f"works with D{used[row]}, not with D{asked}", cl))
    rows = context.run.state.machine_frame.rows_with(True)
    edges = used.at(rows)
    strange = rows[(edges > 0) & (edges != asked)]
    if len(strange):
        row = int(strange[0])
        places.append(context.place(row, 0.0, f"D{used[row]} is not the edge of this tool, D{asked}"))
    return places


def allowed_length_numbers(tool: str, numbers: tuple[int, ...]) -> tuple[int, ...]:
    """Numbers that the length of a tool may have; ``tool`` is the one that a setting names, or empty."""
    return (int(tool),) if tool.isdigit() else numbers


def length_fault_text(number: int, numbers: tuple[int, ...]) -> str:
    """What is wrong with working with a length: its number, -1 for none."""
    has = "without a tool length" if number < 0 else f"with the length of H{number}"
    return f"works {has}; the CL file wants H{numbers[0]}"


def _lengths(context: Context) -> list[Place]:
    """The first motion of each tool without the length of that tool: its own number, or the register of LOAD/TOOL."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    places: list[Place] = []
    for stretch in expected.tools():
        call = stretch.value
        assert isinstance(call, ExpectedTool)
        numbers = allowed_length_numbers(context.settings.tool, call.lengths)
        first, end = _part(context, stretch)
        if not numbers or first == end:
            continue
        bad = _first_wrong(matching, first, end, partial(_has_none_of, run, numbers))
        if bad is not None:
            row, cl = bad
            places.append(context.place(row, 0.0, length_fault_text(int(run.state.edge[row]), numbers), cl))
    return places


def _has_none_of(run: Run, numbers: tuple[int, ...], nc: Ints) -> Flags:
    return ~np.isin(run.state.edge.at(nc), numbers)


def coolant(context: Context) -> Check:
    """Coolant at every point, as far as its words are the control's own."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    places: list[Place] = []
    changes = [(event.before_row, str(event.value), event) for event in run.events if event.kind == "coolant"]
    rows = np.array([row for row, _, _ in changes], np.int64)
    own = np.array([event.before_row for event in run.events if event.kind == "m"], np.int64)
    asked: set[str] = set()
    unread: set[str] = set()
    before = ""
    for stretch in expected.coolant():
        first, end = _part(context, stretch)
        if first == end:
            continue
        word = str(stretch.value)
        want = _COOLANT.get(word)
        begin, stop = matching.nc[first], matching.nc[end - 1]
        since = matching.nc[first - 1] if first else -1
        said = bool(((own > since) & (own <= begin)).any())  # a word of the machine builder
        if want is None or (want == "mist" and said):
            unread.add(word)
            if not said and not (word == before and not ((rows > since) & (rows <= begin)).any()):
                text = f"the CL file wants coolant {word} from here on, and no word of the machine builder stands here"
                places.append(context.place(begin, 0.0, text, matching.cl[first]))
            before = word
            continue
        before = word
        asked.add(want)
        if want == "off":
            begin += 1  # M9 acts after the motion of its block
            if begin > stop and not _switched_off(changes, begin):
                text = "coolant is still on; the CL file wants it off"
                places.append(context.place(stop, 0.0, text, matching.cl[first]))
        k = int(np.searchsorted(rows, begin, "right"))
        now = changes[k - 1][1] if k else "off"
        inside = [state for row, state, _ in changes[k:] if row <= stop]
        if begin > stop:
            continue
        if _differs(now, want, unread):
            text = f"coolant is {now}; the CL file wants {want}"
            places.append(context.place(begin, 0.0, text, matching.cl[first]))
        elif any(_differs(state, want, unread) for state in inside):
            row = next(r for r, state, _ in changes[k:] if r <= stop and _differs(state, want, unread))
            text = f"coolant changes; the CL file wants {want}"
            places.append(context.place(min(row, len(run) - 1), 0.0, text))
    for _, state, event in changes:
        if not unread and state not in asked | {"off"}:
            places.append(context.at(event, 0.0, f"coolant {state}, which the CL file never asks for"))
    good = ", ".join(sorted(asked | {word.lower() + " (not read)" for word in unread}))
    places.sort(key=lambda place: place.nc_line)
    return check_from_places("coolant", "coolant as the CL file says", places, good)


def _switched_off(changes: Sequence[tuple[int, str, RunEvent]], row: int) -> bool:
    """Whether coolant is off right before a row, or was at any time between the row before it and it."""
    now = "off"
    for at, state, _ in changes:
        if at > row:
            break
        if at == row and now == "off":
            return True
        now = state
    return now == "off"


def _differs(state: str, want: str, unread: set[str]) -> bool:
    return state != want and not (unread and state != "off" and want != "off")


def compensation(context: Context) -> Check:
    """To which side of its path the tool's radius is compensated, at every point; and off on the way home."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    side = run.state.compensation
    title = "radius compensation as the CL file says"
    stretches = expected.compensation()
    asked = {stretch.value for stretch in stretches} - {0}
    if not asked and set(side.distinct().tolist()) <= {0}:
        return Check("compensation", title, True, "the CL file asks for none")
    names = {1: "left of the path", -1: "right of the path", 0: "off"}
    places: list[Place] = []
    for stretch in stretches:
        want = stretch.value
        assert isinstance(want, int)
        bad = _first_wrong(matching, *_part(context, stretch), partial(_on_another_side, run, want))
        if bad is not None:
            row, cl = bad
            text = f"radius compensation is {names[int(side[row])]}; the CL file wants it {names[want]}"
            places.append(context.place(row, 0.0, text, cl))
    home = run.state.machine_frame.rows_with(True)
    still_on = home[side.at(home) != 0]
    if len(still_on):
        places.append(context.place(int(still_on[0]), 0.0, "moves home with radius compensation on"))
    good = ", ".join(names[value] for value in sorted(value for value in asked if isinstance(value, int)))
    return check_from_places("compensation", title, sorted(places, key=lambda p: p.nc_line), good or "off")


def _on_another_side(run: Run, side: int, nc: Ints) -> Flags:
    return np.asarray(run.state.compensation.at(nc) != side)


def offset(context: Context) -> Check:
    """One work offset wherever the tool works, and the one that was asked for."""
    run, settings = context.run, context.settings
    used, tcp = run.state.work_offset, run.state.tcp
    rows = context.matching.nc if context.matching is not None else _at_the_part(run)
    title = "one work offset throughout"
    if not len(rows):
        return Check("offset", title, True, "nothing moves")
    want = settings.work_offset
    if want is None:
        want = used[rows[-1]] if context.matching is None else used[rows[0]]
    places: list[Place] = []
    count = 0
    for start in range(0, len(rows), CHUNK):
        part = rows.part(start, start + CHUNK)
        here = used.at(part)
        if (here == want).all():
            continue
        wrong = (here != want) & ~((here == 0) & ~tcp.at(part) & (context.matching is None))
        if wrong.any():
            bad = part[wrong]
            count += len(bad)
            places += [
                context.place(row, 0.0, f"works in {_offset(used[row])}, not in {_offset(want)}")
                for row in bad[: max(MAX_PLACES - len(places), 0)].tolist()
            ]
    others = set(used.distinct().tolist()) - {0, want}
    if others and not places:
        row = min(int(used.rows_with(code)[0]) for code in others)
        places.append(context.place(row, 0.0, f"{_offset(used[row])} is not the offset of this program"))
    return check_from_places("offset", title, places, f"{_offset(want)} throughout", count or None)


def _at_the_part(run: Run) -> RowRanges:
    """Rows that are not in the machine's frame."""
    frame = run.state.machine_frame
    pieces = range(0, len(run), CHUNK)
    return RowRanges.where((start, ~frame.part(start, min(start + CHUNK, len(run)))) for start in pieces)


def _offset(code: int) -> str:
    return "no work offset" if code == 0 else offset_name(code)


def _only_turns(run: Run, machine: Machine, first: int, end: int) -> bool:
    """Whether rows ``first`` to ``end`` turn rotary axes alone, and the slides stay where they are at home."""
    if (run.programmed[first:end] & 7).any():
        return False
    slides = list(machine.linear)
    apart = run.positions(np.arange(first, end)).joints[:, slides] - machine.home[slides]
    return bool((np.abs(apart) <= _HOME).all())


def home(context: Context) -> Check:
    """Motions in the machine's frame: at rapid, back along one slide first, and to the machine's home positions.

    A program that never goes to the home of the machine's definition has positions of its own, which nobody can judge.
    """
    run, machine = context.run, context.run.machine
    title = "retreats to the machine's home"
    rows = run.state.machine_frame.rows_with(True)
    rows = rows[~np.isin(rows, [event.before_row for event in run.events if event.kind == "retract"])]
    if not len(rows):
        return Check("home", title, True, "the program does not go home")
    joints, before = run.positions(rows).joints, run.positions(rows - 1).joints
    apart = joints - machine.home
    for k, axis in enumerate(machine.axes):
        if axis.endless:
            apart[:, k] -= 360.0 * np.rint(apart[:, k] / 360.0)
    there = np.abs(apart) <= _HOME
    if not there.any():
        return Check("home", title, True, "goes to machine positions of its own, not to the home of the definition")
    bits = np.zeros((len(rows), 5), np.bool_)
    named = {"X": 1, "Y": 2, "Z": 4}
    for k, axis in enumerate(machine.axes):
        bit = named.get(axis.name, 0)
        if axis.is_rotary:
            bit = 8 if k == machine.rotary[0] else 16
        bits[:, k] = (run.programmed[rows] & bit) != 0
    places: list[Place] = []
    before_retreat = True
    last = -2
    for k, row in enumerate(rows.tolist()):
        axes = [machine.axes[c].name for c in np.flatnonzero(bits[k])]
        away = [machine.axes[c].name for c in np.flatnonzero(bits[k] & ~there[k])]
        if away:
            text = f"moves {' and '.join(away)} to a machine position that is not its home"
            places.append(context.place(row, 0.0, text))
        if run.kind[row] != Kind.RAPID:
            places.append(context.place(row, 0.0, "moves home at feed, not at rapid"))
        if row != last + 1:
            before_retreat = True
        moved = np.abs(joints[k] - before[k]) > _HOME
        if before_retreat and len(axes) > 1 and (moved.any() or row == 0):
            text = f"moves {' and '.join(axes)} home before the tool has been drawn back along one slide"
            places.append(context.place(row, 0.0, text))
        before_retreat = False
        last = row
    slides = list(machine.linear)
    for event in run.events:
        if event.kind not in ("tool_change", "end") or not 0 < event.before_row <= len(run):
            continue
        row = event.before_row - 1
        k = int(np.searchsorted(rows, row, "right")) - 1
        stands = k >= 0 and there[k, slides].all() and _only_turns(run, machine, int(rows[k]) + 1, row + 1)
        if not stands:
            what = "changes the tool" if event.kind == "tool_change" else "ends"
            text = f"{what} in line {event.line} while the slides are not at home; this is the last motion before"
            places.append(context.place(row, 0.0, text))
    return check_from_places(
        "home", title, places, "slides and rotary axes at home before, after and at every tool change"
    )
