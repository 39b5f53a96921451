"""The decision log of an operation: where it starts, where it changes its state, and why."""

from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import Machine, forward, inverse
from trunnion.model.motion import Decision, Why
from trunnion.model.toolpath import Operation
from trunnion.planning.poses.limit_lookahead import DeadEnd, continued, dead_end
from trunnion.planning.poses.optimizer import IDLE
from trunnion.planning.poses.selection import choose_nearest, cutting, take
from trunnion.planning.poses.states import BEND, POLE_JUMP, REWOUND, STATE, states_of


@dataclass(frozen=True, slots=True, eq=False)
class Planned:
    """An operation as it was planned, before rewinds are put in.

    file        the CL file
    operation   in the program's coordinate system
    rotary      (n, 2) float64  degrees, as the axes display them
    state       (n,) uint8      as ``choose`` gives it
    """

    machine: Machine
    file: str
    operation: Operation
    rotary: Floats
    state: Codes
    keep_slides: bool

    def branch(self, rows: int | Ints) -> Ints:
        """The branch of a row, or of rows."""
        return np.asarray(states_of(self.machine).table[self.state[rows] & STATE, 0])

    def ahead(self, row: int, branch: int, pose: Floats) -> DeadEnd | None:
        """Where ``pose`` (2,), degrees, leads to from ``row`` on, if nothing is changed before the next idle row."""
        moves = self.operation.moves
        return dead_end(self.machine, moves, row, branch, pose, self.keep_slides)

    def words(self, pose: Floats) -> str:
        """A pose, such as ``C 10.000 B 40.000``."""
        return pose_words(self.machine, pose)


def pose_words(machine: Machine, pose: Floats) -> str:
    """Rotary values with their letters, the one next to the workpiece first."""
    return " ".join(
        f"{machine.axes[c].name} {value:.3f}" for c, value in zip(machine.rotary, pose.tolist(), strict=True)
    )


def steps(machine: Machine, rotary: Floats) -> Floats:
    """(n, 2) float64: how the rotary axes go into each row, degrees; from home into the first."""
    columns = list(machine.rotary)
    move = np.diff(rotary, axis=0, prepend=machine.home[columns][None])
    for r, column in enumerate(columns):
        if not np.isfinite(machine.axes[column].low) and not np.isfinite(machine.axes[column].high):
            move[:, r] -= 360.0 * np.rint(move[:, r] / 360.0)
    return move


def turned_over(planned: Planned) -> Ints:
    """Rows that cut and that are reached only by turning over or winding back, whether or not that was marked.

    This is the rule of ``trunnion.planning.poses.optimizer`` applied to a finished way, such as the nearest
    neighbour's.
    """
    machine, moves, rotary = planned.machine, planned.operation.moves, planned.rotary
    if len(moves) < 2:
        return np.zeros(0, np.int64)
    move, branch = steps(machine, rotary), planned.branch(np.arange(len(moves)))
    other = np.append(False, branch[1:] != branch[:-1])
    rows = np.flatnonzero((other | (np.abs(move) > 180.0 + 1e-9).any(axis=1)) & (cutting(moves) != IDLE))
    rows = rows[rows > 0]
    natural = _at_pole(planned, rows - 1) & (np.abs(move[rows]) <= 180.0 + 1e-9).all(axis=1)
    rows = rows[~natural]
    joints = np.zeros((len(rows), 5))
    joints[:, list(machine.rotary)] = rotary[rows - 1] + np.clip(0.5 * move[rows], -180.0, 180.0)
    asked = moves.axis[rows - 1] + moves.axis[rows]
    cosine = np.einsum("ij,ij->i", forward(machine, joints)[1], asked) / np.linalg.norm(asked, axis=1)
    return np.asarray(rows[cosine < np.cos(np.radians(BEND))])


def _at_pole(planned: Planned, rows: Ints) -> Flags:
    moves = planned.operation.moves
    return inverse(planned.machine, moves.tip[rows], moves.axis[rows]).pole


def travel(machine: Machine, rotary: Floats) -> float:
    """Degrees that both rotary axes turn, from home on."""
    return float(np.abs(steps(machine, rotary)).sum())


def decisions(planned: Planned, changes: Ints, rewound: dict[int, str]) -> list[Decision]:
    """The log, with what the nearest neighbour would have done.

    Parameters
    ----------
    changes
        As in ``Poses``.
    rewound
        Why each rewind is needed, by its row.
    """
    log = [_start(planned)]
    count, last, *rows = changes.tolist()
    log += [_change(planned, row, rewound) for row in rows[:count]]
    if count > len(rows):
        log.append(_decision(planned, last, Why.MORE, f"and {count - len(rows)} further changes, the last here"))
    return [*log, _comparison(planned)]


def _decision(planned: Planned, row: int, why: Why, text: str) -> Decision:
    operation = planned.operation
    return Decision(planned.file, operation.name, int(operation.moves.line[max(row, 0)]), row, why, text)


def _start(planned: Planned) -> Decision:
    """The start pose, against that which is nearest to home."""
    machine, moves = planned.machine, planned.operation.moves
    first = f"starts at {planned.words(planned.rotary[0])}"
    one = _part(planned, slice(0, 1))
    state = choose_nearest(machine, one.operation.moves, planned.keep_slides)
    pose = take(machine, one.operation.moves, state, planned.keep_slides).rotary[0]
    if np.abs(pose - planned.rotary[0]).max() < 1e-6:
        return _decision(planned, 0, Why.START, f"{first}, the pose nearest to home")
    branch = int(states_of(machine).table[state[0] & STATE, 0])
    end = planned.ahead(0, branch, pose)
    reason = "that would mean more rewinds or more travel later on"
    if any(machine.axes[c].preferred_sign for c in machine.rotary):
        reason = "the definition prefers this side"
    if end is not None:
        reason = f"from there {end.words(machine, moves)}"
    return _decision(planned, 0, Why.START, f"{first}; nearest to home is {planned.words(pose)}, but {reason}")


def _part(planned: Planned, rows: slice) -> Planned:
    """Some rows of an operation, to be planned by themselves."""
    operation = replace(planned.operation, moves=planned.operation.moves.part(rows))
    return replace(planned, operation=operation, rotary=planned.rotary[rows], state=planned.state[rows])


def _change(planned: Planned, row: int, rewound: dict[int, str]) -> Decision:
    if row in rewound:
        return _decision(planned, row, Why.REWIND, f"rewinds in the cut: {rewound[row]}")
    rotary, was, now = planned.rotary, int(planned.branch(row - 1)), int(planned.branch(row))
    idle = cutting(planned.operation.moves, slice(row, row + 1))[0] == IDLE
    ways = f"{planned.words(rotary[row - 1])} to {planned.words(rotary[row])}"
    swing = np.abs(steps(planned.machine, rotary[row - 1 : row + 1])[1]).max()
    if not idle or (swing <= POLE_JUMP and was != now):
        what = "swings round at the pole" if swing > POLE_JUMP else "goes through the pole"
        return _decision(planned, row, Why.POLE, f"{what}, {ways}")
    stay = continued(planned.machine, planned.operation.moves, slice(row, row + 1), was, rotary[row - 1])[0]
    end = planned.ahead(row, was, rotary[row - 1])
    if np.abs(steps(planned.machine, np.vstack((rotary[row], stay)))[1]).max() < 1e-6:
        reason = "the tool axis is another one here"
    elif end is None:
        reason = "the preferred side, or less travel later on"
    else:
        reason = f"otherwise {end.words(planned.machine, planned.operation.moves)}"
    return _decision(planned, row, Why.CHANGE, f"turns away from the cut, {ways}: {reason}")


def _comparison(planned: Planned) -> Decision:
    """What the nearest neighbour would have done."""
    machine, moves = planned.machine, planned.operation.moves
    state = choose_nearest(machine, moves, planned.keep_slides)
    poses = take(machine, moves, state, planned.keep_slides)
    other = Planned(machine, planned.file, planned.operation, poses.rotary, state, planned.keep_slides)
    mine = int((planned.state & REWOUND != 0).sum())
    text = (
        f"{_rewinds(mine)} and {travel(machine, planned.rotary):.0f} degrees of rotary travel;"
        f" from point to point the nearest pose would have had {_rewinds(len(turned_over(other)))}"
        f" and {travel(machine, poses.rotary):.0f} degrees"
    )
    return _decision(planned, -1, Why.NEAREST, text)


def _rewinds(count: int) -> str:
    return "1 rewind" if count == 1 else f"{count} rewinds"
