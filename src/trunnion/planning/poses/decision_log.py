"""The decision log of an operation: where it starts, where it changes its state, and why."""

from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import Machine, forward, inverse
from trunnion.model.motion import Decision, DecisionTopic
from trunnion.model.toolpath import Operation
from trunnion.planning.poses.limit_lookahead import LimitHit, continue_in_branch, first_limit_hit
from trunnion.planning.poses.optimizer import NO_CONTACT
from trunnion.planning.poses.selection import choose_nearest_states, contact_of, poses_of_states
from trunnion.planning.poses.states import MAX_BEND, POLE_JUMP, REWIND_STEP, STATE_BITS, states_of


@dataclass(frozen=True, slots=True, eq=False)
class ChosenPoses:
    """An operation as it was planned, before rewinds are put in.

    file        the CL file
    operation   in the program's coordinate system
    rotary      (n, 2) float64  degrees, as the axes display them
    state       (n,) uint8      as ``choose_states`` gives it
    """

    machine: Machine
    file: str
    operation: Operation
    rotary: Floats
    state: Codes
    keep_slides: bool

    def branch(self, rows: int | Ints) -> Ints:
        """The branch of a row, or of rows."""
        return np.asarray(states_of(self.machine).table[self.state[rows] & STATE_BITS, 0])

    def limit_ahead(self, row: int, branch: int, pose: Floats) -> LimitHit | None:
        """Where ``pose`` (2,), degrees, leads to from ``row`` on, if nothing is changed before the next idle row."""
        moves = self.operation.moves
        return first_limit_hit(self.machine, moves, row, branch, pose, self.keep_slides)

    def describe(self, pose: Floats) -> str:
        """A pose, such as ``C 10.000 B 40.000``."""
        return describe_pose(self.machine, pose)


def describe_pose(machine: Machine, pose: Floats) -> str:
    """Rotary values with their letters, the one next to the workpiece first."""
    return " ".join(
        f"{machine.axes[c].name} {value:.3f}" for c, value in zip(machine.rotary, pose.tolist(), strict=True)
    )


def rotary_steps(machine: Machine, rotary: Floats) -> Floats:
    """(n, 2) float64: how the rotary axes go into each row, degrees; from home into the first."""
    columns = list(machine.rotary)
    move = np.diff(rotary, axis=0, prepend=machine.home[columns][None])
    for r, column in enumerate(columns):
        if not np.isfinite(machine.axes[column].low) and not np.isfinite(machine.axes[column].high):
            move[:, r] -= 360.0 * np.rint(move[:, r] / 360.0)
    return move


def rewind_rows(planned: ChosenPoses) -> Ints:
    """Rows that cut and that are reached only by turning over or winding back, whether or not that was marked.

    This is the rule of ``trunnion.planning.poses.optimizer`` applied to a finished way, such as the nearest
    neighbour's.
    """
    machine, moves, rotary = planned.machine, planned.operation.moves, planned.rotary
    if len(moves) < 2:
        return np.zeros(0, np.int64)
    move, branch = rotary_steps(machine, rotary), planned.branch(np.arange(len(moves)))
    other = np.append(False, branch[1:] != branch[:-1])
    rows = np.flatnonzero((other | (np.abs(move) > 180.0 + 1e-9).any(axis=1)) & (contact_of(moves) != NO_CONTACT))
    rows = rows[rows > 0]
    natural = _at_pole(planned, rows - 1) & (np.abs(move[rows]) <= 180.0 + 1e-9).all(axis=1)
    rows = rows[~natural]
    joints = np.zeros((len(rows), 5))
    joints[:, list(machine.rotary)] = rotary[rows - 1] + np.clip(0.5 * move[rows], -180.0, 180.0)
    asked = moves.axis[rows - 1] + moves.axis[rows]
    cosine = np.einsum("ij,ij->i", forward(machine, joints)[1], asked) / np.linalg.norm(asked, axis=1)
    return np.asarray(rows[cosine < np.cos(np.radians(MAX_BEND))])


def _at_pole(planned: ChosenPoses, rows: Ints) -> Flags:
    moves = planned.operation.moves
    return inverse(planned.machine, moves.tip[rows], moves.axis[rows]).pole


def rotary_travel(machine: Machine, rotary: Floats) -> float:
    """Degrees that both rotary axes turn, from home on."""
    return float(np.abs(rotary_steps(machine, rotary)).sum())


def pose_decisions(planned: ChosenPoses, changes: Ints, rewound: dict[int, str]) -> list[Decision]:
    """The log, with what the nearest neighbour would have done.

    Parameters
    ----------
    changes
        As in ``PlannedPoses``.
    rewound
        Why each rewind is needed, by its row.
    """
    log = [_start(planned)]
    count, last, *rows = changes.tolist()
    log += [_change(planned, row, rewound) for row in rows[:count]]
    if count > len(rows):
        log.append(
            _decision(planned, last, DecisionTopic.MORE, f"and {count - len(rows)} further changes, the last here")
        )
    return [*log, _comparison(planned)]


def _decision(planned: ChosenPoses, row: int, topic: DecisionTopic, text: str) -> Decision:
    operation = planned.operation
    return Decision(planned.file, operation.name, int(operation.moves.line[max(row, 0)]), row, topic, text)


def _start(planned: ChosenPoses) -> Decision:
    """The start pose, against that which is nearest to home."""
    machine, moves = planned.machine, planned.operation.moves
    first = f"starts at {planned.describe(planned.rotary[0])}"
    one = _part(planned, slice(0, 1))
    state = choose_nearest_states(machine, one.operation.moves, planned.keep_slides)
    pose = poses_of_states(machine, one.operation.moves, state, planned.keep_slides).rotary[0]
    if np.abs(pose - planned.rotary[0]).max() < 1e-6:
        return _decision(planned, 0, DecisionTopic.START, f"{first}, the pose nearest to home")
    branch = int(states_of(machine).table[state[0] & STATE_BITS, 0])
    end = planned.limit_ahead(0, branch, pose)
    reason = "that would mean more rewinds or more travel later on"
    if any(machine.axes[c].preferred_sign for c in machine.rotary):
        reason = "the definition prefers this side"
    if end is not None:
        reason = f"from there {end.describe(machine, moves)}"
    return _decision(
        planned, 0, DecisionTopic.START, f"{first}; nearest to home is {planned.describe(pose)}, but {reason}"
    )


def _part(planned: ChosenPoses, rows: slice) -> ChosenPoses:
    """Some rows of an operation, to be planned by themselves."""
    operation = replace(planned.operation, moves=planned.operation.moves.select(rows))
    return replace(planned, operation=operation, rotary=planned.rotary[rows], state=planned.state[rows])


def _change(planned: ChosenPoses, row: int, rewound: dict[int, str]) -> Decision:
    if row in rewound:
        return _decision(planned, row, DecisionTopic.REWIND, f"rewinds in the cut: {rewound[row]}")
    rotary, was, now = planned.rotary, int(planned.branch(row - 1)), int(planned.branch(row))
    idle = contact_of(planned.operation.moves, slice(row, row + 1))[0] == NO_CONTACT
    ways = f"{planned.describe(rotary[row - 1])} to {planned.describe(rotary[row])}"
    swing = np.abs(rotary_steps(planned.machine, rotary[row - 1 : row + 1])[1]).max()
    if not idle or (swing <= POLE_JUMP and was != now):
        what = "swings round at the pole" if swing > POLE_JUMP else "goes through the pole"
        return _decision(planned, row, DecisionTopic.POLE, f"{what}, {ways}")
    stay = continue_in_branch(planned.machine, planned.operation.moves, slice(row, row + 1), was, rotary[row - 1])[0]
    end = planned.limit_ahead(row, was, rotary[row - 1])
    if np.abs(rotary_steps(planned.machine, np.vstack((rotary[row], stay)))[1]).max() < 1e-6:
        reason = "the tool axis is another one here"
    elif end is None:
        reason = "the preferred side, or less travel later on"
    else:
        reason = f"otherwise {end.describe(planned.machine, planned.operation.moves)}"
    return _decision(planned, row, DecisionTopic.CHANGE, f"turns away from the cut, {ways}: {reason}")


def _comparison(planned: ChosenPoses) -> Decision:
    """What the nearest neighbour would have done."""
    machine, moves = planned.machine, planned.operation.moves
    state = choose_nearest_states(machine, moves, planned.keep_slides)
    poses = poses_of_states(machine, moves, state, planned.keep_slides)
    other = ChosenPoses(machine, planned.file, planned.operation, poses.rotary, state, planned.keep_slides)
    mine = int((planned.state & REWIND_STEP != 0).sum())
    text = (
        f"{_rewinds(mine)} and {rotary_travel(machine, planned.rotary):.0f} degrees of rotary travel;"
        f" from point to point the nearest pose would have had {_rewinds(len(rewind_rows(other)))}"
        f" and {rotary_travel(machine, poses.rotary):.0f} degrees"
    )
    return _decision(planned, -1, DecisionTopic.NEAREST, text)


def _rewinds(count: int) -> str:
    return "1 rewind" if count == 1 else f"{count} rewinds"
