"""The decision log of an operation: where it starts, where it changes its pose, and why."""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import Machine, inverse
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Decision, DecisionTopic
from trunnion.model.toolpath import Operation
from trunnion.planning.poses.contact import NO_CONTACT, contact_of
from trunnion.planning.poses.limit_lookahead import LimitHit, continue_in_branch, first_limit_hit
from trunnion.planning.poses.selection import choose_nearest_states, poses_of_states
from trunnion.planning.poses.states import MAX_BEND, POLE_JUMP, REWIND_STEP, STATE_BITS, states_of
from trunnion.planning.rotary_positions import is_endless, tool_axes
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class ChosenPoses:
    """An operation with its poses, before the rows of rewinds are in.

    file       its CL file
    operation  in the program's coordinate system
    rotary     (n, 2) float64  displayed positions, degrees
    state      (n,) uint8      as in ``PlannedPoses``
    """

    machine: Machine
    file: str
    operation: Operation
    rotary: Floats
    state: Codes
    keep_slide_limits: bool

    def branch(self, rows: int | Ints) -> Ints:
        """Return the branch of a row, or of several."""
        return np.asarray(states_of(self.machine).table[self.state[rows] & STATE_BITS, 0])

    def limit_ahead(self, row: int, branch: int, pose: Floats) -> LimitHit | None:
        """Return the first limit left from ``row`` on if the axes go on from ``pose`` (2,), degrees, in ``branch``."""
        return first_limit_hit(self.machine, self.operation.moves, row, branch, pose, self.keep_slide_limits)

    def describe(self, pose: Floats) -> str:
        """Return a pose (2,) as text, such as ``C 10.000 B 40.000``."""
        return describe_pose(self.machine, pose)

    def decision(self, row: int, topic: DecisionTopic, said: Wording) -> Decision:
        """Return a decision about a row; -1: about the whole operation."""
        line = int(self.operation.moves.line[max(row, 0)])
        return Decision(self.file, self.operation.name, line, row, topic, said)


def describe_pose(machine: Machine, pose: Floats) -> str:
    """Rotary values (2,), degrees, with their letters; the axis next to the workpiece comes first."""
    return " ".join(
        f"{machine.axes[c].name} {value:.3f}" for c, value in zip(machine.own_rotary, pose.tolist(), strict=False)
    )


def rotary_steps(machine: Machine, rotary: Floats) -> Floats:
    """(n, 2) float64: turn of the rotary axes into each row, degrees; into the first one from home."""
    steps = np.diff(rotary, axis=0, prepend=machine.home[list(machine.rotary)][None])
    for r, endless in enumerate(is_endless(machine)):
        if endless:
            steps[:, r] -= 360.0 * np.rint(steps[:, r] / 360.0)
    return steps


def rotary_travel(machine: Machine, rotary: Floats) -> float:
    """Degrees that both rotary axes turn together, from home on."""
    return float(np.abs(rotary_steps(machine, rotary)).sum())


def rewind_rows(chosen: ChosenPoses) -> Ints:
    """Rows of the cut into which the axes get only by a rewind, whether or not that is marked in the states.

    This is the rule of ``trunnion.planning.poses.optimizer``, applied to any poses, such as the nearest neighbour's.
    """
    machine, moves, rotary = chosen.machine, chosen.operation.moves, chosen.rotary
    if len(moves) < 2:
        return np.zeros(0, np.int64)
    steps, branch = rotary_steps(machine, rotary), chosen.branch(np.arange(len(moves)))
    changes_branch = np.append(False, branch[1:] != branch[:-1])
    is_long = np.asarray((np.abs(steps) > 180.0 + 1e-9).any(axis=1))
    rows = np.flatnonzero((changes_branch | is_long) & (contact_of(moves) != NO_CONTACT))
    rows = rows[rows > 0]
    rows = rows[~(_at_pole(chosen, rows - 1) & ~is_long[rows])]
    half_way = rotary[rows - 1] + np.clip(0.5 * steps[rows], -180.0, 180.0)
    between = moves.axis[rows - 1] + moves.axis[rows]
    cosine = np.einsum("ij,ij->i", tool_axes(machine, half_way), between) / np.linalg.norm(between, axis=1)
    return np.asarray(rows[cosine < np.cos(np.radians(MAX_BEND))])


def _at_pole(chosen: ChosenPoses, rows: Ints) -> Flags:
    moves = chosen.operation.moves
    return inverse(chosen.machine, moves.tip[rows], moves.axis[rows]).pole


def pose_decisions(chosen: ChosenPoses, changes: Ints, rewinds: dict[int, Wording]) -> list[Decision]:
    """Return the log: start, changes, and a comparison with the nearest neighbour.

    changes  as in ``PlannedPoses``
    rewinds  why each rewind is needed, by its row
    """
    log = [_start(chosen)]
    count, last, *rows = changes.tolist()
    log += [_change(chosen, row, rewinds) for row in rows[:count]]
    if count > len(rows):
        log.append(chosen.decision(last, DecisionTopic.MORE, Wording("decision", "more", count=count - len(rows))))
    return [*log, _comparison(chosen)]


def _start(chosen: ChosenPoses) -> Decision:
    """Return the first pose, and why it is not the one nearest to home."""
    machine, moves = chosen.machine, chosen.operation.moves
    start = chosen.describe(chosen.rotary[0])
    nearest = _nearest_neighbour(_rows(chosen, slice(0, 1)))
    pose = nearest.rotary[0]
    if np.abs(pose - chosen.rotary[0]).max() < 1e-6:
        return chosen.decision(0, DecisionTopic.START, Wording("decision", "start_nearest", start=start))
    hit = chosen.limit_ahead(0, int(nearest.branch(0)), pose)
    reason = phrase("more_rewinds_or_travel")
    if any(machine.axes[c].preferred_sign for c in machine.rotary):
        reason = phrase("definition_prefers_side")
    if hit is not None:
        reason = phrase("from_there", limit=hit.said(machine, moves))
    said = Wording("decision", "start", start=start, nearest=chosen.describe(pose), reason=reason)
    return chosen.decision(0, DecisionTopic.START, said)


def _rows(chosen: ChosenPoses, rows: slice) -> ChosenPoses:
    """Return some rows of an operation by themselves."""
    operation = replace(chosen.operation, moves=chosen.operation.moves.select(rows))
    return replace(chosen, operation=operation, rotary=chosen.rotary[rows], state=chosen.state[rows])


def _nearest_neighbour(chosen: ChosenPoses) -> ChosenPoses:
    """Return the same operation with the nearest pose from row to row."""
    machine, moves, keep = chosen.machine, chosen.operation.moves, chosen.keep_slide_limits
    state = choose_nearest_states(machine, moves, keep)
    return replace(chosen, rotary=poses_of_states(machine, moves, state, keep).rotary, state=state)


def _change(chosen: ChosenPoses, row: int, rewinds: dict[int, Wording]) -> Decision:
    if row in rewinds:
        return chosen.decision(row, DecisionTopic.REWIND, Wording("decision", "rewind", reason=rewinds[row]))
    machine, moves, rotary = chosen.machine, chosen.operation.moves, chosen.rotary
    before, after = int(chosen.branch(row - 1)), int(chosen.branch(row))
    is_idle = contact_of(moves, slice(row, row + 1))[0] == NO_CONTACT
    turn = {"before": chosen.describe(rotary[row - 1]), "after": chosen.describe(rotary[row])}
    swing = np.abs(rotary_steps(machine, rotary[row - 1 : row + 1])[1]).max()
    if not is_idle or (swing <= POLE_JUMP and before != after):
        what = "swings_at_pole" if swing > POLE_JUMP else "through_pole"
        return chosen.decision(row, DecisionTopic.POLE, Wording("decision", what, **turn))
    unchanged = continue_in_branch(machine, moves, slice(row, row + 1), before, rotary[row - 1])[0]
    hit = chosen.limit_ahead(row, before, rotary[row - 1])
    if np.abs(rotary_steps(machine, np.vstack((rotary[row], unchanged)))[1]).max() < 1e-6:
        reason = phrase("new_tool_axis")
    elif hit is None:
        reason = phrase("preferred_side_or_less_travel")
    else:
        reason = phrase("otherwise", limit=hit.said(machine, moves))
    return chosen.decision(row, DecisionTopic.CHANGE, Wording("decision", "repositions", reason=reason, **turn))


def _comparison(chosen: ChosenPoses) -> Decision:
    """Return what the nearest neighbour would have done."""
    nearest = _nearest_neighbour(chosen)
    count = int((chosen.state & REWIND_STEP != 0).sum())
    said = Wording(
        "decision",
        "comparison",
        count=count,
        travel=rotary_travel(chosen.machine, chosen.rotary),
        count_nearest=len(rewind_rows(nearest)),
        travel_nearest=rotary_travel(chosen.machine, nearest.rotary),
    )
    return chosen.decision(-1, DecisionTopic.NEAREST, said)
