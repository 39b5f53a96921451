"""The rows of NC programs as placing takes them."""

import numpy as np

from trunnion.arrays import Flags
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.arc_extremes import ArcPaths
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.placing.path_rows import PathRows, Stretch
from trunnion.placing.plan_rows import branches
from trunnion.verification.kinematics.positioning_moves import approach_rows

_SLIDE_WORDS = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)


_ROTARY_WORDS = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR)


def rows_of_run(run: Run) -> PathRows:
    """Return the rows of a run that move slides to positions of the workpiece."""
    machine = run.machine
    keep = _rows_at_workpiece(run)
    if not keep.any():
        raise InputError(Problem(run.files[0], 0, Wording("CNV121", "no_motion_part")))
    rows = np.flatnonzero(keep)
    joints, tip, axis = run.joints, run.tip[rows], run.axis[rows]
    rotary = joints[:, list(machine.rotary)]
    begins = np.append(True, np.diff(rows) > 1)
    firsts = np.flatnonzero(begins)
    solution = branches(machine, tip, axis, rotary[rows])
    arc = np.flatnonzero(keep[run.arcs.row])
    starts = run.positions(run.arcs.row[arc] - 1).tip
    seconds = np.zeros(len(rows))
    feed, mode = run.feed[rows], run.feed_mode[rows]
    way = np.append(0.0, np.linalg.norm(np.diff(tip, axis=0), axis=1))
    timed = (run.kind[rows] != Kind.RAPID) & (mode == 94) & (feed > 0.0) & ~begins
    seconds[timed] = 60.0 * way[timed] / feed[timed]
    files = run.file[rows]
    return PathRows(
        tip,
        axis,
        solution,
        run.line[rows].astype(np.int64),
        run.tcp[rows],
        seconds,
        tuple(
            Stretch(first, run.files[int(files[first])] if files[first] else run.files[0]) for first in firsts.tolist()
        ),
        rotary[rows[firsts]],
        ArcPaths.of(run.arcs, arc, starts, run.tip[run.arcs.row[arc]]),
        np.searchsorted(rows, run.arcs.row[arc]),
    )


def _rows_at_workpiece(run: Run) -> Flags:
    """Which rows move slides, and not to positions of the machine; first legs of approaches are among those."""
    programmed = run.programmed.astype(np.int64)
    names_slides = ((programmed & _SLIDE_WORDS) != 0) | ((programmed & (_SLIDE_WORDS | _ROTARY_WORDS)) == 0)
    moves = run.state.follows(0, len(run)) | names_slides
    moves &= ~run.machine_frame
    moves[approach_rows(run)] = False
    return np.asarray(moves)
