"""Linearization errors: how far the tool leaves its path between points, because the control moves the axes linearly.

In:     a run; and, if there is one, the expected path with its matching.
Out:    the largest errors of tip and tool axis, and the rows beyond a limit.
Units:  mm, degrees outside kernels, radians inside.

Each motion is sampled at several positions on its way.
"""

import math
from functools import cached_property
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Floats3, Ints, Lines
from trunnion.jit import inner, kernel
from trunnion.machines.forward import KinematicChain, forward_row, kinematic_chain
from trunnion.model.axis_tolerance import AxisTolerance, allowed_deviation
from trunnion.model.programmed_words import POSITION_WORDS
from trunnion.model.run import Orientation, ProgrammedWord, RowPositions, Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.deviations.arc_turns import off_arcs
from trunnion.verification.deviations.divided_steps import divided_limits
from trunnion.verification.deviations.tip_limits import FREE_PHASES, tip_limits
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.great_circles import angle_between, slerp_weights
from trunnion.verification.kinematics.positioning_moves import comes_from_home, rotary_positioning_flags
from trunnion.verification.kinematics.worst_rows import WorstRows
from trunnion.verification.matching.pairs import Matching

#: Between points nearer to each other than this, mm, the tool axis tells how far the tool has come.
_SHORT: Final = 1e-3

#: What comes of arithmetic only, mm.
_ARITHMETIC: Final = 1e-6

#: Smaller rotary motion, degrees, makes no error.
_STILL: Final = 1e-9

#: Positions within a motion at which it is sampled, and by how many degrees they are apart in longer turns. No multiple
#: of that is a whole turn, so that none passes unseen.
_SAMPLES: Final = 7
_STEP: Final = 22.5

#: Turns beyond this are sampled as coarsely as they come, degrees.
_MOST_TURN: Final = 3.6e6

#: No step of a CL file needs a longer turn of a rotary axis than half a turn, degrees, rounding included.
_HALF_TURN: Final = 180.01


@dataclass(frozen=True, slots=True)
class SpanLimits:
    """How far tip and tool axis may be off between points.

    tip            mm; infinite: any, or as the CL file wants it
    axis           degrees; infinite: any, or as ``by_default``
    tip_tolerance  how far points themselves may be off, mm: is allowed in addition
    rounding       how far the tool axis may be off for its digits, degrees: is allowed in addition
    by_default     limits of the tool axis in cuts, by operation and by the turn of each step; None: ``axis``
    """

    tip: float = math.inf
    axis: float = math.inf
    tip_tolerance: float = 0.0
    rounding: float = 0.0
    by_default: AxisTolerance | None = None


class LinearizationErrors:
    """Collects linearization errors of a run, chunk by chunk; up to ``max_rows`` rows beyond each limit are kept.

    A motion that goes or leads to a CL point is measured against the CL file's path: the straight line and the great
    circle from the CL point before. Without a CL file, and for the tool axis in rapids, it is measured against the path
    between its own ends.

    tip   mm from the straight line, without TCP; where no setting limits it, of motions that turn a rotary axis by more
          than half a turn, which no step of a CL file asks for, and of cuts along lines of the CL file
    axis  degrees from the great circle, wherever the control interpolates rotary angles
    cuts  where no setting limits the tip: mm from the lines of the CL file in cuts without TCP, whatever is allowed
    unstated  those of them that are in no tolerance of the CL file, where they are beyond what it would allow at least
    limits    what it was made with
    """

    def __init__(
        self,
        run: Run,
        max_rows: int,
        limits: SpanLimits,
        expected: ExpectedPath | None = None,
        matching: Matching | None = None,
    ) -> None:
        self._run = run
        self.limits = limits
        self._tip_uncertainty = 2.0 * math.sqrt(3.0) * limits.tip_tolerance
        self._rotary = np.array(run.machine.rotary, np.int64)
        self._is_rotary = np.array([axis.is_rotary for axis in run.machine.axes])
        self._expected = expected
        self._behind_holes = np.array(sorted(expected.hole_exits) if expected is not None else (), np.int64)
        self._matching = matching
        self._tip_is_limited = math.isfinite(limits.tip)
        self._judges_turns = expected is not None
        beyond = limits.tip + limits.tip_tolerance if self._tip_is_limited else self._tip_uncertainty + _ARITHMETIC
        self.tip = WorstRows(beyond, max_rows)
        self.cuts, self.unstated = WorstRows(math.inf, max_rows), WorstRows(0.0, max_rows)
        self.axis = WorstRows(0.0 if limits.by_default else limits.axis + limits.rounding, max_rows)

    @cached_property
    def _cl_row(self) -> Lines:
        """(n,) int32: the CL row that each row leads to on a line, else -1. Most runs have no row that needs it."""
        cl_row = np.full(len(self._run), -1, np.int32)
        if self._expected is not None and self._matching is not None:
            for nc, cl in self._matching.all_pair_chunks():
                no_line = np.isin(cl, self._expected.first_rows) | (self._expected.kind(cl) == Kind.ARC)
                no_line |= np.isin(cl, self._behind_holes)  # the tool comes from where the hole has left it
                cl_row[nc] = np.where(no_line, -1, cl)
        return cl_row

    def add(self, first: int, end: int, positions: RowPositions) -> None:
        """Add rows, in order; ``positions`` is the ``Run.chunk`` of them."""
        kind = self._run.kind[first:end]
        tcp = self._run.state.tcp.part(first, end)
        long = self._long_turns(first, end, positions, tcp)
        cuts = self._cuts_without_tcp(first, end, positions, tcp)
        rows = self._rows_to_sample(first, end, positions, tcp, long, cuts)
        off_tip, off_axis = np.zeros(end - first), np.zeros(end - first)
        on_arcs = np.flatnonzero(long & (kind == Kind.ARC))
        off_tip[on_arcs] = off_arcs(self._run.machine_at(first), positions.joints, self._rotary, on_arcs)
        if not len(rows):
            self.tip.add(first, off_tip)
            return
        tips, axes = self._path_ends(first, rows, positions)
        chain = kinematic_chain(self._run.machine_at(first))
        write_linearization_errors(
            chain, positions.joints, positions.tip, positions.axis, self._is_rotary, rows, tips, axes,
            kind[rows] == Kind.RAPID, tcp, self._tip_uncertainty, off_tip, off_axis,
        )  # fmt: skip
        if not self._tip_is_limited:
            off_tip[~(long | cuts)] = 0.0
            self._judge_cuts(first, np.flatnonzero(cuts & ~long), off_tip)
            off_axis[kind == Kind.RAPID] = 0.0
        self.tip.add(first, off_tip)
        if self.limits.by_default is not None:
            off_axis[rows] = np.where(
                off_axis[rows] > self._allowed(self.limits.by_default, first, rows, axes), off_axis[rows], 0.0
            )
        self.axis.add(first, off_axis)

    def allowed_by_default(self, row: int) -> float:
        """How far the tool axis may be off in a row where no setting says it, degrees; infinite outside of cuts."""
        assert self.limits.by_default is not None
        positions, here = self._run.chunk(row, row + 1), np.zeros(1, np.int64)
        _, axes = self._path_ends(row, here, positions)
        return float(self._allowed(self.limits.by_default, row, here, axes)[0]) - self.limits.rounding

    def _allowed(self, default: AxisTolerance, first: int, rows: Ints, axes: Floats) -> Floats:
        """How far the tool axis may be off within rows, (k,) degrees; infinite where they do not cut.

        ``axes`` (k, 2, 3) are the tool axes at both ends of the paths that the rows are on.
        """
        turn = np.degrees(2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(axes[:, 1] - axes[:, 0], axis=1), 1.0)))
        tolerance = np.full(len(rows), default.cutting)
        cl = self._cl_row[first + rows]
        for section in self._expected.sections if self._expected is not None else ():
            moves = section.operation.moves
            here = np.flatnonzero((cl >= section.first) & (cl < section.end))
            free = np.isin(moves.phase[cl[here] - section.first], FREE_PHASES)
            tolerance[here] = np.where(free, math.inf, default.of(section.operation))
        allowed = allowed_deviation(tolerance, turn)
        if self._divided is not None:
            allowed = np.where(np.isfinite(allowed), np.minimum(allowed, self._divided[first + rows]), allowed)
        return allowed + self.limits.rounding

    def _long_turns(self, first: int, end: int, positions: RowPositions, tcp: Flags) -> Flags:
        """Which rows turn a rotary axis by more than half a turn, whole turns included, without TCP, (end - first,).

        Rapids that only position rotary axes do not count, as they may do so away from the part, nor those from home.
        """
        turns = np.abs(np.diff(positions.joints[:, self._rotary], axis=0)).max(axis=1)
        long = (turns > _HALF_TURN) & ~tcp & ~self._run.state.machine_frame.part(first, end)
        if not self._judges_turns or not long.any():
            return np.zeros(end - first, np.bool_)
        long &= ~rotary_positioning_flags(self._run, first, end)
        rapids = np.flatnonzero(long & (self._run.kind[first:end] == Kind.RAPID))
        long[[k for k in rapids.tolist() if comes_from_home(self._run, first + k)]] = False
        return np.asarray(long)

    def is_long(self, row: int) -> bool:
        """Whether a row turns a rotary axis by more than half a turn."""
        joints = self._run.positions(np.array([max(row - 1, 0), row])).joints[:, self._rotary]
        return bool(np.abs(joints[1] - joints[0]).max() > _HALF_TURN)

    def _cuts_without_tcp(self, first: int, end: int, positions: RowPositions, tcp: Flags) -> Flags:
        """Which rows turn a rotary axis without TCP on a line of the CL file at feed, (end - first,)."""
        run = self._run
        turns = np.abs(np.diff(positions.joints[:, self._rotary], axis=0)).max(axis=1)
        cuts = (turns > _STILL) & ~tcp & (run.kind[first:end] == Kind.LINEAR)
        cuts &= ~run.state.machine_frame.part(first, end)
        if self._tip_is_limited or not self._judges_turns or not cuts.any():
            return np.zeros(end - first, np.bool_)
        return np.asarray(cuts & (self._cl_row[first:end] >= 0))

    def _judge_cuts(self, first: int, rows: Ints, off_tip: Floats) -> None:
        """Leave how far the tip is off in rows, counted from ``first``, only where that is a fault."""
        allowed, known = tip_limits(self._expected, self._cl_row[first + rows].astype(np.int64))
        off = np.where(np.isfinite(allowed), off_tip[rows], 0.0)
        is_fault = off > allowed + self.limits.tip_tolerance
        judged, unknown = np.zeros((2, len(off_tip)))
        judged[rows] = off
        unknown[rows] = np.where(is_fault | (off <= known + self.limits.tip_tolerance), 0.0, off)
        self.cuts.add(first, judged)
        self.unstated.add(first, unknown)
        off_tip[rows] = np.where(is_fault, off, 0.0)

    def limit_at(self, row: int) -> tuple[float, bool]:
        """Return how far the tip may leave its line in a row of ``cuts``, mm, and whether the CL file states that."""
        allowed, known = tip_limits(self._expected, self._cl_row[row : row + 1].astype(np.int64))
        return float(known[0]), bool(allowed[0] == known[0])

    @cached_property
    def _divided(self) -> Floats | None:
        """(n,) how far the tool axis may be off in steps that are divided; None: none is."""
        if self._matching is None or not len(self._matching.intermediate[0]):
            return None
        return divided_limits(self._cl_row, self._undivided)

    def is_divided(self, row: int) -> bool:
        """Whether the step that a row is on has points between, which say how far the tool axis may be off."""
        return self._divided is not None and abs(self.allowed_by_default(row) - float(self._divided[row])) <= 1e-9

    def _undivided(self, first: Ints, last: Ints) -> Floats:
        """How far the tool axis would be off in steps from the row before ``first`` to ``last``, (k,) degrees."""
        ends = self._run.positions(np.stack((first - 1, last), axis=1).ravel())
        tips, axes = self._expected_ends(self._cl_row[last].astype(np.int64))
        off_tip, off_axis = np.zeros((2, 2 * len(first)))
        rows, under_tcp = 2 * np.arange(len(first)), np.ones(2 * len(first), np.bool_)
        write_linearization_errors(
            kinematic_chain(self._run.machine_at(0)), ends.joints, ends.tip, ends.axis, self._is_rotary, rows, tips,
            axes, np.zeros(len(rows), np.bool_), under_tcp, 0.0, off_tip, off_axis,
        )  # fmt: skip
        return off_axis[rows]

    def _rows_to_sample(
        self, first: int, end: int, positions: RowPositions, tcp: Flags, long: Flags, cuts: Flags
    ) -> Ints:
        """Rows, counted from ``first``, in which rotary motion may lead the tool off its path.

        Rapids count only where the tip has a limit, or in ``long`` turns, and those that only position rotary axes
        never do. ``cuts`` count whatever they turn, and so do steps that are divided.
        """
        run = self._run
        kind, frame = run.kind[first:end], run.state.machine_frame.part(first, end)
        moves_tip = (run.programmed[first:end] & int(POSITION_WORDS)) != 0
        turns = np.abs(np.diff(positions.joints[:, self._rotary], axis=0))
        sampled = (turns > _STILL).any(axis=1) & ~frame & (kind != Kind.ARC)
        if self.limits.by_default is not None and not self._tip_is_limited:
            total = np.radians(turns[:, 0] + turns[:, 1])
            needed = (0.25 * total * total > math.radians(self.limits.by_default.finishing)) | cuts
            sampled &= needed if self._divided is None else needed | np.isfinite(self._divided[first:end])
        sampled &= (kind != Kind.RAPID) | (~tcp & moves_tip & self._tip_is_limited) | long
        sampled &= ~rotary_positioning_flags(run, first, end)
        by_angles = run.orientation_between(first, end) == Orientation.ANGLES
        # No great circle leads round by more than half a turn: the words of rotary axes do.
        by_angles |= (turns.max(axis=1) > _HALF_TURN) & (run.programmed[first:end] & int(ProgrammedWord.VECTOR) == 0)
        sampled &= ~tcp | by_angles
        return np.flatnonzero(sampled)

    def _path_ends(self, first: int, rows: Ints, positions: RowPositions) -> tuple[Floats, Floats]:
        """Tips and tool axes at both ends of the path that each row is on, (k, 2, 3) each."""
        tips = np.stack((positions.tip[rows], positions.tip[rows + 1]), axis=1)
        axes = np.stack((positions.axis[rows], positions.axis[rows + 1]), axis=1)
        matched = np.flatnonzero(self._cl_row[first + rows] >= 0)
        if self._expected is not None and len(matched):
            cl = self._cl_row[first + rows[matched]].astype(np.int64)
            order = np.argsort(cl, kind="stable")
            matched, cl = matched[order], cl[order]
            tips[matched], wanted = self._expected_ends(cl)
            at_feed = self._run.kind[first + rows[matched]] != Kind.RAPID
            axes[matched[at_feed]] = wanted[at_feed]
        return tips, axes

    def _expected_ends(self, cl: Ints) -> tuple[Floats, Floats]:
        """Tips and tool axes of CL rows and of those before them, (k, 2, 3) each."""
        assert self._expected is not None
        both = np.stack((cl - 1, cl), axis=1)
        return self._expected.tip(both.ravel()).reshape(-1, 2, 3), self._expected.axis(both.ravel()).reshape(-1, 2, 3)


@kernel(writes="off_tip off_axis")
def write_linearization_errors(
    chain: KinematicChain,
    joints: Floats2,
    tip_at: Floats2,
    axis_at: Floats2,
    is_rotary: Flags,
    rows: Ints,
    tips: Floats3,
    axes: Floats3,
    free_axis: Flags,
    tcp: Flags,
    tip_uncertainty: float,
    off_tip: Floats,
    off_axis: Floats,
) -> None:
    """Write how far the tool is off within ``rows``, mm and degrees.

    joints, tip_at, axis_at  the position before the first row comes first
    is_rotary  (5,)        which axes are rotary
    tips, axes  (k, 2, 3)    ends of the paths that the k rows are on
    free_axis   (k,)         the tool axis has the ends of the motion itself
    tip_uncertainty          how far a tip may be off along its path, mm
    """
    here, tip, axis = np.empty(5), np.empty(3), np.empty(3)
    for k in range(rows.shape[0]):
        row = rows[k]
        worst_tip, worst_axis = 0.0, 0.0
        angle = angle_between(axes[k], 0, axes[k], 1)
        length_squared = 0.0
        for c in range(3):
            length_squared += (tips[k, 1, c] - tips[k, 0, c]) ** 2
        begin, end = 0.0, 1.0
        if not free_axis[k]:
            begin = _fraction_done(tip_at, axis_at, row, tips[k], axes[k], angle)
            end = _fraction_done(tip_at, axis_at, row + 1, tips[k], axes[k], angle)
        turn = 0.0
        for c in range(5):
            if is_rotary[c]:
                turn = max(turn, abs(joints[row + 1, c] - joints[row, c]))
        samples = _SAMPLES
        if turn > _HALF_TURN:  # one more than whole turns have steps: none falls on their ends
            samples = _SAMPLES + int(min(turn, _MOST_TURN) / _STEP)
        for sample in range(1, samples + 1):
            share = sample / (samples + 1.0)
            for c in range(5):
                here[c] = joints[row, c] + share * (joints[row + 1, c] - joints[row, c])
            forward_row(chain, here, tip, axis)
            fraction = begin + share * (end - begin)
            if not tcp[row]:
                worst_tip = max(worst_tip, _distance_to_line(tip, tips[k], length_squared, fraction))
            worst_axis = max(worst_axis, _angle_to_great_circle(axis, axes[k], angle, fraction))
        if not free_axis[k] and length_squared > _SHORT * _SHORT:
            worst_axis = max(worst_axis - tip_uncertainty / math.sqrt(length_squared) * angle, 0.0)
        off_tip[row], off_axis[row] = worst_tip, math.degrees(worst_axis)


@inner
def _distance_to_line(tip: Floats, ends: Floats, length_squared: float, fraction: float) -> float:
    """Distance of a tip from the line between ``ends`` (2, 3), mm; at ``fraction`` of it where it is short."""
    along, off = 0.0, 0.0
    if length_squared > _SHORT * _SHORT:
        for c in range(3):
            along += (tip[c] - ends[0, c]) * (ends[1, c] - ends[0, c])
        fraction = min(max(along / length_squared, 0.0), 1.0)
    for c in range(3):
        off += (tip[c] - ends[0, c] - fraction * (ends[1, c] - ends[0, c])) ** 2
    return math.sqrt(off)


@inner
def _angle_to_great_circle(axis: Floats, ends: Floats, angle: float, fraction: float) -> float:
    """Angle of a tool axis from the vector at ``fraction`` of the great circle between ``ends`` (2, 3), rad."""
    before, after = slerp_weights(angle, fraction)
    off = 0.0
    for c in range(3):
        off += (axis[c] - before * ends[0, c] - after * ends[1, c]) ** 2
    return 2.0 * math.asin(min(0.5 * math.sqrt(off), 1.0))


@inner
def _fraction_done(tip_at: Floats, axis_at: Floats, row: int, tips: Floats, axes: Floats, angle: float) -> float:
    """Fraction of a path at which a position lies: by the tip, or by the tool axis where the path is short."""
    length_squared, along = 0.0, 0.0
    for c in range(3):
        length_squared += (tips[1, c] - tips[0, c]) ** 2
        along += (tip_at[row, c] - tips[0, c]) * (tips[1, c] - tips[0, c])
    if length_squared > _SHORT * _SHORT:
        return min(max(along / length_squared, 0.0), 1.0)
    return min(angle_between(axis_at, row, axes, 0) / angle, 1.0) if angle > 1e-9 else 1.0
