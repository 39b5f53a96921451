"""The setting ``feed_rapid_from``: feeds of a CL file that stand for rapids, because its CAM writes no RAPID."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.errors import InputError, setting_problem, warning
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_by_operation
from trunnion.messages import Wording
from trunnion.model.toolpath import CutterComp, CycleOff, CycleOn, Kind, Operation, Sense, SpindleOn, Toolpath

_KEY: Final = "feed_rapid_from"

#: The feeds that it takes, mm/min.
_BOUNDS: Final = (1.0, 1e6)


def with_stated_rapids(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> list[Toolpath]:
    """Make lines at a feed that the setting states, or above it, rapids; holes, arcs and splines stay what they are.

    Raises ``InputError`` for an operation that is not there, that has no such line, that has one within radius
    compensation, or that would have no cut left.
    """
    feeds, found = stated_by_operation(_KEY, settings, _feed), [*toolpaths]
    if not feeds:
        return found
    check_operations(_KEY, feeds, found)
    changed = [_changed(path, feeds) for path in found]
    rapid = {name for _, names in changed for name in names}
    named = sorted({*feeds} - {""} - rapid)
    if named or not rapid:
        said = [setting_problem(_KEY, Wording("ARG230", "no_such_feed", operation=name)) for name in named]
        raise InputError(said or [setting_problem(_KEY, Wording("ARG230", "no_such_feed_at_all"))])
    return [path for path, _ in changed]


def stated_notices(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> tuple[str, ...]:
    """Return comments for the head of a program on speeds and rapids that settings state and its CL files do not, and
    on speeds that were computed from surface speeds.
    """
    notices = dict[str, None]()
    for operation in (each for path in toolpaths for each in path.operations):
        for event in operation.events:
            if isinstance(event, SpindleOn) and event.stated:
                sense = "COUNTER-CLOCKWISE" if event.sense is Sense.CCLW else "CLOCKWISE"
                notices[f"SPINDLE OF {operation.name} BY SETTING, {event.rpm:g} REV/MIN {sense}"] = None
            elif isinstance(event, SpindleOn) and event.surface is not None:
                speed, diameter = event.surface
                found = f"{event.rpm:.0f} REV/MIN OF {speed:g} M/MIN AT {diameter:g} MM"
                notices[f"SPINDLE OF {operation.name} CONVERTED, {found}"] = None
    for name, feed in stated_by_operation(_KEY, settings, _feed).items():
        notices[f"LINES{f' OF {name}' if name else ''} FROM {feed:g} MM/MIN ON ARE RAPIDS, BY SETTING"] = None
    return tuple(notices)


def _feed(text: str) -> float | None:
    try:
        feed = float(text)
    except ValueError:
        return None
    return feed if _BOUNDS[0] <= feed <= _BOUNDS[1] else None


def _changed(path: Toolpath, feeds: Mapping[str, float]) -> tuple[Toolpath, list[str]]:
    """Return a toolpath with its rapids, and the names of the operations that have some."""
    operations, names, remarks = list[Operation](), list[str](), list(path.remarks)
    for operation in path.operations:
        feed = feeds.get(operation.name, feeds.get(""))
        rows = np.zeros(0, np.bool_) if feed is None else _rows(operation, feed)
        if not rows.any():
            operations.append(operation)
            continue
        moves, first = operation.moves, int(operation.moves.line[int(np.argmax(rows))])
        if not ((moves.kind != Kind.RAPID) & ~rows).any() and not _has_holes(operation):
            raise InputError(
                setting_problem(_KEY, Wording("ARG230", "no_cut_left", operation=operation.name, feed=feed))
            )
        if (rows & _compensated(operation)).any():
            said = Wording("ARG230", "rapid_in_compensation", operation=operation.name)
            raise InputError(setting_problem(_KEY, said))
        kind = np.where(rows, np.uint8(Kind.RAPID), moves.kind).astype(np.uint8)
        operations.append(replace(operation, moves=replace(moves, kind=kind)))
        names.append(operation.name)
        said = Wording("CTL315", "feeds_as_rapids", count=int(rows.sum()), feed=feed, operation=operation.name)
        remarks.append(warning(path.file, first, said))
    return replace(path, operations=tuple(operations), remarks=tuple(remarks)), names


def _rows(operation: Operation, feed: float) -> Flags:
    """Return the lines of an operation at a feed or above it, (n,) bool, outside of cycles and splines."""
    moves = operation.moves
    rows = (moves.kind == Kind.LINEAR) & ~moves.per_rev & (moves.feed >= feed)
    for first, last in zip(operation.splines.first.tolist(), operation.splines.last.tolist(), strict=True):
        rows[first : last + 1] = False
    for event in operation.events:
        if isinstance(event, CycleOn):
            rows[event.row :] = False
        elif isinstance(event, CycleOff):
            later = (moves.kind == Kind.LINEAR) & ~moves.per_rev & (moves.feed >= feed)
            rows[event.row :] = later[event.row :]
    return np.asarray(rows)


def _has_holes(operation: Operation) -> bool:
    return any(isinstance(event, CycleOn) for event in operation.events)


def _compensated(operation: Operation) -> Flags:
    """Return the rows within CUTCOM, (n,) bool."""
    inside = np.zeros(len(operation.moves), np.bool_)
    for event in operation.events:
        if isinstance(event, CutterComp):
            inside[event.row :] = event.side != "OFF"
    return inside
