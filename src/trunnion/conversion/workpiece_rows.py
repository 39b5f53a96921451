"""Which rows of a run move the tool at the workpiece; the others are moves of the machine and are left out.

Where the tool leaves the workpiece and comes back, the rows are divided: each stretch becomes an operation of its own,
and between operations every program goes home.
"""

from collections.abc import Collection

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.conversion.known_positions import behind_retracts
from trunnion.conversion.unsupported import Warnings
from trunnion.machines import forward
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind

_XY = ProgrammedWord.X | ProgrammedWord.Y
_XYZ = _XY | ProgrammedWord.Z
_POSITION = _XYZ | ProgrammedWord.VECTOR

#: Rotary positions within this, degrees, are the same.
_SAME_ANGLE = 1e-9

#: Tips, mm, and tool axes within this are the same.
_AT_REST = 1e-9

#: A tip that leaves its straight line by more than this half-way, mm, goes another way.
_SWING = 1.0


def workpiece_stretches(
    run: Run, known: Flags, first: int, end: int, level_approach: bool, warn: Warnings
) -> list[Ints]:
    """Rows from ``first`` up to ``end`` that move the tool at the workpiece; none before its first position there.

    known           (n,) bool: ``known_positions`` of the run
    first, end      rows of a section
    level_approach  the control approaches X and Y first, then Z, not only in planes (``Control.level_approach``)
    warn            receives the places where the rows are divided, and of cuts that would be lost

    list  row numbers of each stretch, in order; empty without a position at the workpiece
    """
    rows = np.arange(first, end)
    in_plane = _in_plane(run, rows)
    approach = _level_approaches(run, rows, in_plane) & (in_plane | level_approach)
    at_part = known[rows] & ~run.machine_frame[rows] & ~approach
    positions = at_part & ((run.programmed[rows] & _XYZ) != 0)
    begin = int(np.argmax(positions)) if positions.any() else len(rows)
    at_part &= (np.arange(len(rows)) >= begin) & ~_rotary_positioning(run, rows)
    _refuse_lost_cuts(run, rows[~known[rows] & ~run.machine_frame[rows]], rows, warn)
    _refuse_machine_cuts(run, rows, warn)
    kept = np.flatnonzero(at_part)
    left_out = np.cumsum(~(at_part | approach) | _swings(run, rows) | behind_retracts(run)[rows])
    stretches: list[Ints] = []
    for part in np.split(kept, np.flatnonzero(np.diff(left_out[kept])) + 1) if len(kept) else []:
        cuts = (run.kind[rows[part]] != Kind.RAPID) & ~(bool(stretches) & _turns_only(run, rows[part]))
        moved = np.flatnonzero(positions[part] | cuts)
        if not len(moved):
            continue  # only rotary axes that turn away from the part
        stretch = rows[part[moved[0] :]]
        if stretches:
            _warn_of_division(run, int(stretches[-1][-1]) + 1, int(stretch[0]), warn)
        stretches.append(_with_arc_start(run, known, stretch, warn))
    return stretches


def without_turns_in_place(run: Run, rows: Ints, blocks: Collection[tuple[int, int]]) -> Ints:
    """Return the ``rows`` (n,) of a stretch without those that turn rotary axes about the tool axis, at rest under TCP.

    They are moves of the machine (at the pole, for instance): posting plans its own. Those stay whose
    block switches something off after the motion.

    blocks   line and file of each block that switches off
    """
    before = np.maximum(rows - 1, 0)
    turns = (np.abs(run.rotary[rows] - run.rotary[before]) > _SAME_ANGLE).any(axis=1)
    here = np.flatnonzero(turns & run.tcp[rows] & run.tcp[before] & (run.kind[rows] != Kind.ARC) & (rows > rows[0]))
    if not len(here):
        return rows
    start, end = run.positions(before[here]), run.positions(rows[here])
    half_way = forward(run.machine, 0.5 * (start.joints + end.joints))[1]
    at_rest = np.abs(end.tip - start.tip).max(axis=1) < _AT_REST
    for axis in (end.axis, half_way):
        at_rest &= np.abs(axis - start.axis).max(axis=1) < _AT_REST
    resting = here[at_rest]
    bare = [(int(run.line[row]), int(run.file[row])) not in blocks for row in rows[resting]]
    return np.delete(rows, resting[np.array(bare, np.bool_)])


def _with_arc_start(run: Run, known: Flags, stretch: Ints, warn: Warnings) -> Ints:
    """Return the rows of a stretch, and the one before if the first is an arc: that needs its start point."""
    first = int(stretch[0])
    if run.kind[first] != Kind.ARC:
        return stretch
    if first == 0 or not known[first - 1]:
        _refuse_unknown(run, first, warn)
        return stretch
    return np.concatenate(([first - 1], stretch))


def _warn_of_division(run: Run, first: int, end: int, warn: Warnings) -> None:
    """Warn of the rows from ``first`` up to ``end`` that divide an operation."""
    warn(int(run.line[first]), Wording("CNV175", "tool_leaves_workpiece", run_line=run.line[end]), int(run.file[first]))


def _refuse_lost_cuts(run: Run, unknown: Ints, rows: Ints, warn: Warnings) -> None:
    """Refuse cuts whose position is not known; rotary axes that turn at feed away from the part are no cuts."""
    cuts = unknown[run.kind[unknown] != Kind.RAPID]
    if len(cuts):
        away = _latest(run.machine_frame[rows]) > _latest(~run.machine_frame[rows] & ~_turns_only(run, rows))
        cuts = cuts[~(_turns_only(run, cuts) & away[cuts - rows[0]])]
    if len(cuts):
        _refuse_unknown(run, int(cuts[0]), warn)


def _refuse_unknown(run: Run, row: int, warn: Warnings) -> None:
    warn.refuse(int(run.line[row]), Wording("CNV171", "cuts_where_tip"), int(run.file[row]))


def _refuse_machine_cuts(run: Run, rows: Ints, warn: Warnings) -> None:
    """Refuse motion at feed to positions of the machine, unless no cut follows it, and Z alone is drawn back or it
    begins above all cuts.
    """
    at_feed = rows[run.machine_frame[rows] & (run.kind[rows] != Kind.RAPID) & ((run.programmed[rows] & _XYZ) != 0)]
    for row in at_feed.tolist():
        following = np.flatnonzero(~run.machine_frame[row : rows[-1] + 1])
        cuts_then = len(following) > 0 and run.kind[row + int(following[0])] != Kind.RAPID
        leaves = int(run.programmed[row]) & int(_XYZ) == ProgrammedWord.Z or _is_above_cuts(run, rows, row)
        if not leaves or cuts_then:
            warn.refuse(int(run.line[row]), Wording("CNV170", "moves_feed_position"), int(run.file[row]))
            return


def _is_above_cuts(run: Run, rows: Ints, row: int) -> bool:
    """Whether the tool is away from the part when a row to a position of the machine begins: home, or at rapid to a
    height above those of all cuts.
    """
    before = np.flatnonzero(~run.machine_frame[rows[0] : row])
    if not len(before) or run.kind[last := int(rows[0] + before[-1])] != Kind.RAPID:
        return not len(before)
    cuts = rows[~run.machine_frame[rows] & (run.kind[rows] != Kind.RAPID)]
    away = run.positions(np.array([last]))
    heights = run.positions(cuts).tip @ away.axis[0]
    return bool((heights < float(away.tip[0] @ away.axis[0]) - _AT_REST).all())


def _swings(run: Run, rows: Ints) -> Flags:
    """(n,) bool: rapids without TCP that turn rotary axes and take the tip far from the straight line to their end."""
    found = np.zeros(len(rows), np.bool_)
    before = np.maximum(rows - 1, 0)
    turns = (np.abs(run.rotary[rows] - run.rotary[before]) > _SAME_ANGLE).any(axis=1)
    here = np.flatnonzero(turns & (run.kind[rows] == Kind.RAPID) & ~run.tcp[rows] & ~run.machine_frame[rows])
    if len(here):
        start, end = run.positions(before[here]), run.positions(rows[here])
        half_way = run.forward_at(rows[here], 0.5 * (start.joints + end.joints))[0]
        found[here] = np.linalg.norm(half_way - 0.5 * (start.tip + end.tip), axis=1) > _SWING
    return found


def _turns_only(run: Run, rows: Ints) -> Flags:
    """(n,) bool: blocks that program rotary axes and no position."""
    programmed = run.programmed[rows]
    return np.asarray(((programmed & _POSITION) == 0) & (programmed != 0))


def _rotary_positioning(run: Run, rows: Ints) -> Flags:
    """(n,) bool: rapids of the rotary axes alone that move no tip with them, away from the part or behind the last
    position there.
    """
    alone = _turns_only(run, rows) & ~run.state.follows_at(rows) & (run.kind[rows] == Kind.RAPID)
    works = ~alone & ~run.machine_frame[rows]
    order = np.arange(len(rows))
    after_last = order > (int(np.flatnonzero(works)[-1]) if works.any() else -1)
    return np.asarray(alone & ((_latest(run.machine_frame[rows]) > _latest(works)) | after_last))


def _in_plane(run: Run, rows: Ints) -> Flags:
    """(n,) bool: a tilted plane or a frame is on."""
    changes = [event for event in run.events if event.kind in ("tilt", "cycle800", "frame")]
    at = np.searchsorted([event.before_row for event in changes], rows, "right")
    return np.array([False, *(bool(event.value) for event in changes)])[at]


def _level_approaches(run: Run, rows: Ints, in_plane: Flags) -> Flags:
    """(n,) bool: the first leg of an approach, in X and Y from home, before a second one in Z alone."""
    words = run.programmed[rows] & _POSITION
    works = ~run.machine_frame[rows] & (words != 0)
    rapid = (run.kind[rows] == Kind.RAPID) & (in_plane | ~run.tcp[rows])
    worked_before = np.concatenate(([-1], _latest(works)[:-1]))
    from_home = (_latest(run.machine_frame[rows]) >= worked_before) & (worked_before < np.arange(len(rows)))
    first_leg = works & rapid & ((words & ~np.uint8(_XY)) == 0) & from_home
    found = np.zeros(len(rows), np.bool_)
    found[:-1] = first_leg[:-1] & rapid[1:] & (words[1:] == ProgrammedWord.Z)
    return found


def _latest(flags: Flags) -> Ints:
    """(n,): index of the latest True up to each row, -1 before the first."""
    return np.asarray(np.maximum.accumulate(np.where(flags, np.arange(len(flags)), -1)))
