"""Motions to the machine's home positions."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.model.run import ProgrammedWord, Run, RunEvent
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.checks.passages import without_retract
from trunnion.verification.checks.rotary_moves_at_part import stands_away
from trunnion.verification.context import Context, check_from_places
from trunnion.verification.kinematics.home_tolerance import HOME_TOLERANCE, home_tolerance
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.results import Check, Place

#: Where axes must be at home, by the kinds of events: how it is said where there are none, and with their names.
_PLACES: Final = {
    "tool_change": ("no_axis_at_change", "axes_at_change"),
    "end": ("no_axis_at_end", "axes_at_end"),
}

#: A rotary axis is at home within this, degrees: programs print no less.
_ROTARY_HOME: Final = 5e-4

#: Notes of positions that count from a place which only the machine knows: they are read as if it were the home.
_PLACES_OF_BUILDER: Final = frozenset({"m92_counts_set_machine_taken", "second_reference"})

_SLIDE_WORDS: Final = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z


@dataclass(frozen=True, slots=True, eq=False)
class _HomeMotions:
    """Rows in the machine frame, other than retracts along the tool axis.

    rows            (k,) int64
    joints, before  (k, 5) positions at their ends and starts
    named           (k, 5) bool  the axes that their blocks name
    at_home         (k, 5) bool  the axes that machine coordinates have put at home at their ends, endless ones whatever
                                 their turn
    of_builder      (k,) bool    they count from a place that only the machine knows (M92, G30)
    """

    rows: Ints
    joints: Floats
    before: Floats
    named: Flags
    at_home: Flags
    of_builder: Flags

    @staticmethod
    def of(run: Run) -> "_HomeMotions":
        rows = run.state.machine_frame.rows_with(True)
        rows = rows[~np.isin(rows, [event.before_row for event in run.events if event.kind == "retract"])]
        joints, before = run.positions(rows).joints, run.positions(rows - 1).joints
        off = joints - run.machine.home
        for k, axis in run.machine.own_columns:
            if axis.endless:
                off[:, k] -= 360.0 * np.rint(off[:, k] / 360.0)
        words = np.array(_axis_words(run.machine))
        named = (run.programmed[rows][:, None] & words) != 0
        at_home = (np.abs(off) <= home_tolerance(run, rows)) & MachinePositions.of(run).at(rows)
        of_builder = _counts_from_builder(run, rows)
        return _HomeMotions(rows, joints, before, named, at_home & ~(named & of_builder[:, None]), of_builder)

    def only_of_builder(self, machine: Machine) -> bool:
        """Whether all that move linear axes count from a place that only the machine knows, and there are such."""
        linear = self.named[:, list(machine.linear)].any(axis=1)
        return bool(linear.any() and self.of_builder[linear].all())


def _counts_from_builder(run: Run, rows: Ints) -> Flags:
    """Which rows of the machine frame go to places that only the machine knows, (k,) bool."""
    noted = [each for each in run.diagnostics if each.wording.variant in _PLACES_OF_BUILDER]
    blocks = {(each.file, each.line) for each in noted}
    if not blocks:
        return np.zeros(len(rows), np.bool_)
    return np.array(
        [(run.files[run.state.file[row]], int(run.lines[row])) in blocks for row in rows.tolist()], np.bool_
    )


def _axis_words(machine: Machine) -> list[int]:
    """Return the bit of ``Run.programmed`` of each axis."""
    slides = {"X": ProgrammedWord.X, "Y": ProgrammedWord.Y, "Z": ProgrammedWord.Z}
    words = [int(slides.get(axis.name, 0)) for axis in machine.axes]
    first, second = machine.rotary
    words[first], words[second] = int(ProgrammedWord.FIRST), int(ProgrammedWord.SECOND)
    return words


def check_home(context: Context) -> Check:
    """Motions in the machine frame: at rapid, back along one linear axis first, and to the machine's home positions.

    A program that never goes to the home of the machine's definition has positions of its own, which are not checked.
    Between two operations of the CL files every program that retracts at all does so.
    """
    check = _with_rotary_end(context, _check_motions(context))
    if any(each.wording.variant in _PLACES_OF_BUILDER for each in context.run.diagnostics):
        check = replace(check, missing=(*check.missing, phrase("place_of_words")))
    others = [*_turned_from_home(context), *without_retract(context)]
    return check_from_places("home", [*check.places, *others], None) if others else check


def _turned_from_home(context: Context) -> Iterator[Place]:
    """Yield the last motion before each tool change and end at which rotary axes are not at home that the definition
    names for it.
    """
    run, machine = context.run, context.run.machine
    variants = {"tool_change": "changes_turned", "end": "ends_turned"}
    for event in run.events:
        names = machine.home_at.get(event.kind, ())
        columns = [column for column in machine.rotary if machine.names[column] in names]
        if not columns or not 0 < event.before_row <= len(run):
            continue
        row = event.before_row - 1
        if away := _rotary_off_home(run, row, columns):
            axes = tuple(machine.axes[column].name for column in away)
            yield context.place(row, 0.0, Wording("home", variants[event.kind], line=event.line, axes=axes))


def _rotary_off_home(run: Run, row: int, columns: Iterable[int]) -> dict[int, float]:
    """Return where those of some rotary axes stand that are not at home, degrees; endless ones have whole turns."""
    rows = np.array([row])
    joints, allowed = run.positions(rows).joints[0], home_tolerance(run, rows)[0]
    found = dict[int, float]()
    for column in columns:
        off = float(joints[column] - run.machine.home[column])
        off -= 360.0 * round(off / 360.0) if run.machine.axes[column].endless else 0.0
        if abs(off) > max(float(allowed[column]), _ROTARY_HOME):
            found[column] = float(joints[column])
    return found


def _with_rotary_end(context: Context, check: Check) -> Check:
    """Return the check with where rotary axes stand at the end of the program, if that is not at home: nothing says
    where they should.
    """
    run, machine = context.run, context.run.machine
    if check.places or check.answer is None or not len(run):
        return check
    off = _rotary_off_home(run, len(run) - 1, machine.rotary)
    left = [f"{machine.axes[column].name}{at:g}" for column, at in off.items()]
    if not left:
        return check
    return replace(check, answer=Wording("home", "rotary_end", home=check.answer, axes=tuple(left)))


def _check_motions(context: Context) -> Check:
    motions = _HomeMotions.of(context.run)
    if not len(motions.rows):
        return _check_retracts_by_word(context)
    if not (motions.at_home & motions.named).any() or motions.only_of_builder(context.run.machine):
        return _check_other_positions(context)
    places = [*_wrong_motions(context, motions), *_changes_away_from_home(context, motions)]
    stated = context.run.machine.home_at
    which = tuple(Wording("home", _PLACES[at][bool(names)], axes=tuple(names)) for at, names in stated.items())
    good = Wording("home", "as_defined", places=which) if which else Wording("home", "good")
    return check_from_places("home", places, good)


def _needed(machine: Machine, *places: str) -> list[int]:
    """Return the linear axes that must be at home at one of some places."""
    needed = {name for place in places for name in machine.home_at.get(place, machine.names)}
    return [column for column in machine.linear if machine.names[column] in needed]


def _wrong_motions(context: Context, motions: _HomeMotions) -> Iterator[Place]:
    """Motions to other positions, at feed, or along several axes before the tool was retracted along one."""
    run, machine = context.run, context.run.machine
    free = set(machine.linear) - set(_needed(machine, *_PLACES))
    for k, row in enumerate(motions.rows.tolist()):
        axes = [machine.axes[c].name for c in np.flatnonzero(motions.named[k])]
        elsewhere = np.flatnonzero(motions.named[k] & ~motions.at_home[k]).tolist()
        away = [machine.axes[c].name for c in elsewhere if c not in free]
        if away:
            said = "place_of_builder" if motions.of_builder[k] else "elsewhere"
            yield context.place(row, 0.0, Wording("home", said, axes=tuple(away)))
        if run.kind[row] != Kind.RAPID:
            yield context.place(row, 0.0, Wording("home", "at_feed"))
        not_retracted = k == 0 or row != motions.rows[k - 1] + 1
        moves = bool((np.abs(motions.joints[k] - motions.before[k]) > HOME_TOLERANCE).any())
        if not_retracted and len(axes) > 1 and (moves or row == 0):
            yield context.place(row, 0.0, Wording("home", "not_retracted", axes=tuple(axes)))


def _changes_away_from_home(context: Context, motions: _HomeMotions) -> Iterator[Place]:
    """Yield the last motion before each tool change and end of program for which the linear axes are not at home."""
    run = context.run
    for event in run.events:
        if event.kind not in ("tool_change", "end") or not 0 < event.before_row <= len(run):
            continue
        slides = _needed(run.machine, event.kind)
        if not slides:
            continue
        row = event.before_row - 1
        k = int(np.searchsorted(motions.rows, row, "right")) - 1
        was_home = k >= 0 and motions.at_home[k, slides].all()
        if not (was_home and _slides_stay_home(run, slides, int(motions.rows[k]) + 1, row + 1)):
            what = "changes_away" if event.kind == "tool_change" else "ends_away"
            yield context.place(row, 0.0, Wording("home", what, line=event.line))


def _slides_stay_home(run: Run, slides: list[int], first: int, end: int) -> bool:
    """Whether no word of rows ``first`` to ``end`` moves some linear axes, and they stay at home."""
    words = np.array(_axis_words(run.machine))[slides]
    if (run.programmed[first:end] & int(np.bitwise_or.reduce(words))).any():
        return False
    rows = np.arange(first, end)
    off = run.positions(rows).joints[:, slides] - run.machine.home[slides]
    return bool((np.abs(off) <= home_tolerance(run, rows)[:, slides]).all())


def _check_other_positions(context: Context) -> Check:
    """Return a program that retracts to machine positions other than home before a tool change does so before all."""
    run, away = context.run, stands_away(context)
    changes = [(place, event) for place, event in enumerate(run.events) if event.kind == "tool_change"]
    changes = [(place, event) for place, event in changes if event.before_row > 0]
    lost = [event for place, event in changes if not away(place)]
    if len(lost) == len(changes):
        return Check("home", True, Wording("home", "other_positions"), missing=(phrase("no_home"),))
    check = check_from_places("home", _unretracted(context, lost), Wording("home", "retracts_elsewhere"))
    return replace(check, missing=() if check.places else (phrase("height_of_positions"),))


def _unretracted(context: Context, events: Iterable[RunEvent]) -> list[Place]:
    """Return the places of tool changes, and the end, before which no retract stands."""
    variants = {"tool_change": "change_unretracted", "end": "end_unretracted"}
    return [context.place_of_event(each, 0.0, Wording("home", variants[each.kind])) for each in events]


def _check_retracts_by_word(context: Context) -> Check:
    """Return a program without machine positions that retracts by a word (M242) before a tool change does so before
    all.

    And at its end.
    """
    run = context.run
    retracted_at: int | None = None
    changes = 0
    lost: list[RunEvent] = []
    for event in run.events:
        if event.kind == "retract":
            # The motion that the word makes, if the travel is known, is none of the program.
            makes_motion = event.before_row < len(run) and bool(run.state.machine_frame[event.before_row])
            retracted_at = event.before_row + makes_motion
        elif event.kind in ("tool_change", "end"):
            changes += event.kind == "tool_change"
            since = run.programmed[retracted_at : event.before_row] if retracted_at is not None else None
            if since is None or (since & int(_SLIDE_WORDS)).any():
                lost.append(event)
    if sum(event.kind == "tool_change" for event in lost) == changes:
        return Check("home", True, None, missing=(phrase("no_home"),))
    return check_from_places("home", _unretracted(context, lost), Wording("home", "retracts_by_word"))
