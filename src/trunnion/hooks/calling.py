"""Hooks of a user: Python files that change what CL files ask for, before anything is planned.

In:     files that the user has named, and toolpaths.
Out:    toolpaths that are checked as strictly as those of CL files, with a remark for each operation that was changed.
        They are what the program is proven against.
"""

import sys
import types
from collections.abc import Iterable, Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import fields, is_dataclass, replace
from typing import TypeVar, cast

import numpy as np

from trunnion.cl import unknown_statement_remarks
from trunnion.controls.definition import Control
from trunnion.controls.vocabulary import HOOKS_NOTICE
from trunnion.errors import InputError, Problem, warning
from trunnion.hooks import Block, Context
from trunnion.hooks.checks import fingerprint, operation_fault, value_fault
from trunnion.hooks.files import HookFile, function_failure
from trunnion.hooks.functions import RunOf, with_functions
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Decision, DecisionTopic
from trunnion.model.splines import Splines
from trunnion.model.toolpath import (
    Arcs,
    Event,
    Frame,
    Insert,
    Kind,
    Moves,
    Operation,
    Phase,
    ShopStatement,
    Tool,
    Toolpath,
)

_Kind = TypeVar("_Kind", Operation, Event)

_T = TypeVar("_T")


class Hooks:
    """Calls the functions of hook files for toolpaths, with what ``Context`` says of the run.

    changed_motion  names of the operations whose motion is another one than in their CL file, in order
    decisions       what was changed, for reports
    """

    def __init__(self, files: Sequence[HookFile], machine: str, control: str, settings: Mapping[str, str]) -> None:
        self._files, self._run_of = files, RunOf(machine, control, types.MappingProxyType({**settings}))
        self.changed_motion: list[str] = []
        self.decisions: list[Decision] = []

    @property
    def notices(self) -> tuple[str, ...]:
        """Comments for the head of the program."""
        if not self.changed_motion:
            return ()
        files = ", ".join(file.path.name for file in self._files)
        return (f"{HOOKS_NOTICE} {files}: {', '.join(dict.fromkeys(self.changed_motion))}",)

    def at_places(self, control: Control, encoding: str) -> Control:
        """Return a control that writes what the functions at places of output return, in letters of an encoding."""
        return with_functions(control, self._files, replace(self._run_of, encoding=encoding))

    def change(self, toolpaths: Iterable[Toolpath]) -> list[Toolpath]:
        """Return what hooks make of toolpaths, with remarks on what they changed.

        Raises ``InputError`` if a hook fails, or returns what no CL file could say.
        """
        given = list(toolpaths)
        found = [self._changed(toolpath) for toolpath in given]
        if _moves(given) and not _moves(found):
            path, function = self._files[-1].path, next(iter(self._files[-1].functions))
            raise InputError(
                Problem(str(path), self._files[-1].line_of(function), Wording("HOK160", "hooks_leave_out"))
            )
        return found

    def _changed(self, toolpath: Toolpath) -> Toolpath:
        if not self._files:
            return toolpath
        operations, remarks = list(toolpath.operations), list[Problem]()
        for file in self._files:
            found: list[Operation] = []
            for number, operation in enumerate(operations, 1):
                new = self._run(file, toolpath.file, operation, number)
                remarks += self._remarks(file, operation, new)
                found += new
            operations = found
        told = frozenset(unknown_statement_remarks(toolpath))
        new_toolpath = replace(toolpath, operations=tuple(operations))
        remarks += [remark for remark in toolpath.remarks if remark not in told]
        remarks += unknown_statement_remarks(new_toolpath)
        return replace(new_toolpath, remarks=tuple(remarks))

    def _run(self, file: HookFile, cl_file: str, operation: Operation, number: int) -> list[Operation]:
        call = _Caller(file, cl_file, self._run_of, number)
        found = [operation]
        if "on_operation" in file.functions:
            given = call.given(operation)
            returned = call("on_operation", given, given)
            made = [given] if returned is None else call.listed("on_operation", returned, Operation)
            call.refuse_changes("on_operation")
            found = [_plain_operation(call, operation, given, each) for each in made]
        for name, change in (("on_event", call.events), ("on_block", call.block_events)):
            if name in file.functions:
                found = [replace(each, events=change(each, call.given(each))) for each in found]
                call.refuse_changes(name)
        return found

    def _remarks(self, file: HookFile, before: Operation, after: Sequence[Operation]) -> list[Problem]:
        """Return what a file of hooks has changed in an operation, as warnings."""
        if len(after) == 1 and after[0] is before:
            return []
        what = _motion_change(before, after)
        if what:
            self.changed_motion += [each.name for each in after] or [before.name]
        old, new = list(before.events), [event for each in after for event in each.events]
        if after and old != new:
            what.append(phrase("hooks_changed_events", before=len(old), after=len(new)))
        if len(after) == 1 and (before.name, before.tool) != (after[0].name, after[0].tool):
            what.append(phrase("hooks_changed_name"))
        if not what:
            return []
        said = Wording("decision", "hooks", file=file.path.name, operation=before.name, changes=tuple(what))
        self.decisions.append(Decision(before.file, before.name, before.line, -1, DecisionTopic.HOOKS, said))
        name = next(iter(file.functions))
        return [
            warning(
                str(file.path),
                file.line_of(name),
                Wording("HOK140", "operation_hooks_program", before=before.name, subject=tuple(what)),
            )
        ]


def _moves(toolpaths: Iterable[Toolpath]) -> bool:
    return any(len(operation.moves) for toolpath in toolpaths for operation in toolpath.operations)


def _motion_change(before: Operation, after: Sequence[Operation]) -> list[Wording]:
    """How operations move the tool otherwise than the one in whose place they stand, in words; none if they do not."""
    if len(after) != 1:
        return [phrase("hooks_made", count=len(after)) if after else phrase("hooks_left_out")]
    old, new = before.moves, after[0].moves
    if len(old) != len(new):
        return [phrase("hooks_changed_points", count=len(old), after=len(new))]
    differs = np.zeros(len(old), np.bool_)
    for one, other in ((old.tip, new.tip), (old.axis, new.axis), (old.kind, new.kind), (old.per_rev, new.per_rev)):
        differs |= (one != other).reshape(len(old), -1).any(axis=1)
    differs |= ~((old.feed == new.feed) | (np.isnan(old.feed) & np.isnan(new.feed)))
    if differs.any():
        return [phrase("hooks_changed_motion", changed=int(differs.sum()), count=len(old))]
    arcs, frame = (before.arcs, after[0].arcs), before.frame == after[0].frame
    names = ("row", "centre", "normal", "radius", "full_turns")
    same = frame and all(np.array_equal(*(getattr(each, name) for each in arcs)) for name in names)
    return [] if same else [phrase("hooks_changed_circles")]


class _Caller:
    """Calls the functions of one file for one operation, and checks what they return."""

    def __init__(self, file: HookFile, cl_file: str, run: RunOf, number: int) -> None:
        self._file, self._cl_file, self._run, self._number = file, cl_file, run, number
        self._watched: list[tuple[Operation, bytes]] = []

    def given(self, operation: Operation) -> Operation:
        """Return the operation as a function gets it: a copy of its own, that is watched."""
        copy = _detached(operation)
        self._watched.append((copy, fingerprint(copy)))
        return copy

    def refuse_changes(self, name: str) -> None:
        """Refuse what a function has changed without returning it: nobody would be told, and nothing would check it."""
        if any(fingerprint(operation) != before for operation, before in self._watched):
            raise InputError(
                Problem(
                    str(self._file.path),
                    self._file.line_of(name),
                    Wording("HOK135", "changes_operation_place", name=name),
                )
            )

    def __call__(self, name: str, given: object, operation: Operation) -> object:
        """Call a function with an operation, an event or a block."""
        run = self._run
        context = Context(self._cl_file, operation, self._number, run.machine, run.control, run.settings)
        try:
            with redirect_stdout(sys.stderr):  # the program may go to standard output
                return self._file.functions[name](given, context)
        except (Exception, SystemExit) as error:
            raise InputError(function_failure(self._file.path, error, name, operation.name)) from error

    def refuse(self, name: str, wording: Wording) -> InputError:
        """Return the error for what a function has returned."""
        return InputError(
            Problem(str(self._file.path), self._file.line_of(name), wording.within("returned", name=name))
        )

    def listed(self, name: str, returned: object, kind: type[_Kind]) -> list[_Kind]:
        """Return what a function has returned, as a list."""
        found = [returned] if isinstance(returned, kind) else returned
        if isinstance(found, Sequence) and not isinstance(found, str) and all(isinstance(each, kind) for each in found):
            return list(found)
        word = kind.__name__.lower()
        raise self.refuse(name, Wording("HOK130", "value_type", name=type(returned).__name__, word=word))

    def events(self, operation: Operation, given: Operation) -> tuple[Event, ...]:
        """Return the events of an operation as ``on_event`` leaves them, which gets those of its copy ``given``."""
        found: list[Event] = []
        for event, copy in zip(operation.events, given.events, strict=True):
            returned = self("on_event", copy, given)
            if returned is None:
                found.append(event)
                continue
            for new in self.listed("on_event", returned, Event):
                if new is copy:
                    found.append(event)
                    continue
                self._check_types("on_event", new)
                new = replace(new, row=event.row, line=event.line)
                found.append(self._checked("on_event", new, len(operation.moves)))
        return tuple(found)

    def block_events(self, operation: Operation, given: Operation) -> tuple[Event, ...]:
        """Return the events of an operation with those that ``on_block`` adds, behind the others of their rows."""
        added: list[Event] = []
        for block in _blocks(operation.moves):
            returned = self("on_block", block, given)
            for new in [] if returned is None else self.listed("on_block", returned, Event):
                self._check_types("on_block", new)
                if new.row not in (block.row, block.row + 1):
                    raise self.refuse(
                        "on_block", Wording("HOK132", "event_row_block", row=new.row, block_row=block.row)
                    )
                new = replace(new, line=block.line) if new.line < 1 else new
                added.append(self._checked("on_block", new, len(operation.moves)))
        return tuple(sorted((*operation.events, *added), key=lambda event: event.row))

    def checked_events(self, events: Iterable[Event], rows: int) -> tuple[Event, ...]:
        """Return the events of an operation that ``on_operation`` has returned."""
        found = []
        for event in events:
            self._check_types("on_operation", event)
            found.append(self._checked("on_operation", event, rows))
        return tuple(sorted(found, key=lambda event: event.row))

    def _check_types(self, name: str, event: Event) -> None:
        """Refuse an event of which no CL file could have made the values."""
        if not isinstance(event, Event) or type(event) in (Event, ShopStatement):
            raise self.refuse(name, Wording("HOK130", "no_event"))
        fault = value_fault(event)
        if fault:
            raise self.refuse(name, Wording("HOK132", "with", name=type(event).__name__, fault=fault))

    def _checked(self, name: str, event: Event, rows: int) -> Event:
        if not 0 <= event.row <= rows:
            raise self.refuse(name, Wording("HOK132", "event_row", row=event.row, rows=rows))
        return replace(event, template="") if isinstance(event, Insert) and event.template else _detached(event)


def _plain_operation(call: _Caller, before: Operation, given: Operation, operation: Operation) -> Operation:
    """Return an operation that a hook has returned, checked as a reader's is by the way it is made.

    The hook may keep what it has got (``given``) and what it returns, and change it later: none of it goes on.
    """
    if operation is given:
        return before
    parts: dict[str, type | tuple[type, ...]] = {
        "moves": Moves,
        "arcs": Arcs,
        "tool": Tool,
        "frame": Frame,
        "events": (tuple, list),
    }
    for name, kind in parts.items():
        part = getattr(operation, name)
        if not isinstance(part, kind):
            raise call.refuse(
                "on_operation", Wording("HOK130", "operation_type", name=name, type_name=type(part).__name__)
            )
    keeps_events, keeps_moves = operation.events is given.events, operation.moves is given.moves
    own = {
        name: getattr(before, name) if getattr(operation, name) is getattr(given, name) else _detached(part)
        for name in parts
        for part in [getattr(operation, name)]
    }
    operation = replace(operation, **own)
    rows = len(operation.moves)
    fault = operation_fault(operation)
    if fault:
        raise call.refuse("on_operation", Wording("HOK132", "operation", operation=repr(operation.name), fault=fault))
    # A spline is about its points: whoever changes these wants lines.
    splines = before.splines if keeps_moves else Splines.empty()
    events = operation.events
    if not keeps_events or rows != len(before.moves):
        events = call.checked_events(events, rows)
    return replace(operation, events=events, splines=splines, file=before.file)


def _blocks(moves: Moves) -> Iterable[Block]:
    columns = (moves.tip, moves.axis, moves.kind, moves.phase, moves.feed, moves.per_rev, moves.line)
    for row, (tip, axis, kind, phase, feed, per_rev, line) in enumerate(
        zip(*(c.tolist() for c in columns), strict=True)
    ):
        yield Block(row, tuple(tip), tuple(axis), Kind(kind), Phase(phase), feed, per_rev, line)


def _detached(record: _T) -> _T:
    """Return a copy of a record, or of a value of one, with copies of all arrays and records in it."""
    return cast(_T, _copied(record))


def _copied(value: object) -> object:
    if isinstance(value, np.ndarray):
        column = np.array(value)
        column.setflags(write=False)
        return column
    if is_dataclass(value) and not isinstance(value, type):
        new = object.__new__(type(value))
        for each in fields(value):
            # Records are frozen, and a copy needs no check that the record has passed.
            object.__setattr__(new, each.name, _copied(getattr(value, each.name)))
        return new
    return tuple(map(_copied, value)) if type(value) is tuple else value
