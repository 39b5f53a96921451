"""Reference implementations of the planner: the nearest neighbour, and every possible path through the states."""

import math
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, forward, inverse, slide_positions
from trunnion.model.toolpath import Kind, Moves, Phase

State = tuple[int, int, int]


def wrapped(angle: float) -> float:
    """An angle in [-180, 180]."""
    return angle - 360.0 * round(angle / 360.0)


@dataclass(frozen=True)
class NearestPath:
    """The path of a nearest neighbour: rotary values as they wind, and the branch of each row."""

    rotary: Floats
    branch: list[int]
    changes: list[int]  # rows into which it changes its branch or winds back
    rows_beyond_limits: list[int]


def nearest_neighbour(machine: Machine, moves: Moves, keep_slide_limits: bool = False) -> NearestPath:
    """From row to row, of the branches and turns within limits, those nearest to the last position."""
    solutions = inverse(machine, moves.tip, moves.axis)
    columns, limits = list(machine.rotary), machine.limits
    last = machine.home[columns]
    rotary, branches, changes, beyond_rows = np.empty((len(moves), 2)), [0] * len(moves), [], []
    now, known = 0, False
    for row in range(len(moves)):
        best = (99, math.inf)
        for branch in (now, 1 - now):
            value = solutions.joints[branch, row, columns].copy()
            if solutions.pole[row]:
                value[0] = last[0]
            for r, column in enumerate(columns):
                low, high = limits[column]
                turns = float(np.rint((last[r] - value[r]) / 360.0))
                if np.isfinite(low):
                    fewest = math.ceil((low - 1e-5 - value[r]) / 360.0)
                    most = math.floor((high + 1e-5 - value[r]) / 360.0)
                    turns = min(max(turns, fewest), most) if fewest <= most else turns
                value[r] += 360.0 * turns
            beyond = _count_beyond(machine, moves.tip[row], value, keep_slide_limits)
            travel = float(np.abs(value - last).sum())
            if beyond < best[0] or (beyond == best[0] and travel < best[1] - 1e-9):
                best, branches[row], rotary[row] = (beyond, travel), branch, value
        wound = row > 0 and bool((np.abs(rotary[row] - last) > 180.0 + 1e-9).any())
        if (known and branches[row] != now) or wound:
            changes.append(row)
        if best[0]:
            beyond_rows.append(row)
        now, last, known = branches[row], rotary[row].copy(), not solutions.pole[row]
    return NearestPath(rotary, branches, changes, beyond_rows)


def _count_beyond(machine: Machine, tip: Floats, rotary: Floats, keep_slide_limits: bool) -> int:
    joints = slide_positions(machine, tip[None], rotary[None])[0]
    low, high = machine.limits.T
    outside = (joints < low - 1e-5) | (joints > high + 1e-5)
    return int(outside.sum() if keep_slide_limits else outside[list(machine.rotary)].sum())


class AllPaths:
    """Costs of every path through the states of a short toolpath, as docs/planning.md defines them."""

    def __init__(self, machine: Machine, moves: Moves, prefer: int = -1) -> None:
        self.machine, self.moves, self.prefer = machine, moves, prefer
        self.home = machine.home[list(machine.rotary)]
        self.limits = machine.limits[list(machine.rotary)]
        self.endless = [not np.isfinite(low) for low, _ in self.limits]
        solutions = inverse(machine, moves.tip, moves.axis)
        self.pole = solutions.pole
        self.angles = solutions.joints[:, :, list(machine.rotary)].copy()  # branch, row, axis
        for row in np.flatnonzero(self.pole):
            for branch in range(2):
                self.angles[branch, row, 0] = self.angles[branch, row - 1, 0] if row else wrapped(self.home[0])
        self.states = self._states()
        self.open = [self._open(row) for row in range(len(moves))]

    def _states(self) -> list[State]:
        turns = []
        for (low, high), endless in zip(self.limits, self.endless, strict=True):
            fits = [k for k in range(-9, 10) if 360 * k + 180 >= low - 1e-5 and 360 * k - 180 <= high + 1e-5]
            turns.append([0] if endless else fits)
        return [(b, one, two) for b in (0, 1) for one in turns[0] for two in turns[1]]

    def value(self, row: int, state: State) -> Floats:
        """Rotary values of a state, degrees; for endless axes without turns."""
        return np.asarray(self.angles[state[0], row] + 360.0 * np.array(state[1:]))

    def _open(self, row: int) -> list[bool]:
        counts = []
        for state in self.states:
            value = self.value(row, state)
            low, high = self.limits.T
            counts.append(int(((value < low - 1e-5) | (value > high + 1e-5)).sum()))
        return [count == min(counts) for count in counts]

    def _move(self, row: int, before: State, state: State) -> tuple[Floats, bool]:
        """Turn of both axes, degrees, and whether both take the shorter way."""
        plain = self.angles[state[0], row] - self.angles[before[0], row - 1]
        nearer = np.array([wrapped(angle) for angle in plain])
        move = self.value(row, state) - self.value(row - 1, before)
        move = np.where(self.endless, nearer, move)
        return move, bool((np.abs(move - nearer) < 1.0).all())

    def _bends(self, row: int, before: State, move: Floats) -> bool:
        joints = np.zeros((1, 5))
        joints[0, list(self.machine.rotary)] = self.value(row - 1, before) + np.clip(0.5 * move, -180.0, 180.0)
        middle = forward(self.machine, joints)[1][0]
        asked = self.moves.axis[row - 1] + self.moves.axis[row]
        return bool(middle @ asked < math.cos(math.radians(1.0)) * np.linalg.norm(asked))

    def _alive(self, row: int, branch: int) -> bool:
        return any(is_open and s[0] == branch for s, is_open in zip(self.states, self.open[row], strict=True))

    def _heading(self, row: int, branch: int, r: int) -> float:
        """The last step of a branch before a row that moved an axis, since the branch was last closed."""
        for k in range(row - 1, 0, -1):
            if not (self._alive(k, branch) and self._alive(k - 1, branch)):
                return 0.0
            move = wrapped(self.angles[branch, k, r] - self.angles[branch, k - 1, r])
            if abs(move) > 1e-3:
                return move
        return 0.0

    def step(self, row: int, before: State, state: State) -> tuple[int, float]:
        """Rewinds and cost of one step between open states."""
        idle = bool(self.moves.kind[row] == Kind.RAPID)
        move, near = self._move(row, before, state)
        travel = cost = float(np.abs(move).sum())
        other = before[0] != state[0]
        direct = near and (not other or bool(self.pole[row - 1]))
        alive = self._alive(row, before[0])
        small = other and travel < 90.0 and alive
        bent = self._bends(row, before, move)
        rewinds = 0
        if not idle and bent and not direct:
            rewinds = 1 if self._direct_source_open(row, state) else 1 + (1 << 20)
            cost += 1.0 if self.moves.phase[row] == Phase.CUT else 0.0
        elif other:
            cost += 0.5 if small and not bent else 200.0
        for r in range(2):
            if abs(move[r]) > 1e-3 and move[r] * self._heading(row, before[0], r) < 0:
                cost += 0.1
        return rewinds, cost

    def _direct_source_open(self, row: int, state: State) -> bool:
        for source, is_open in zip(self.states, self.open[row - 1], strict=True):
            if source[0] == state[0] and is_open and self._move(row, source, state)[1]:
                return True
        return False

    def at(self, row: int, state: State) -> float:
        """Cost of being in a state."""
        cost = 0.0
        for value, (low, high), endless in zip(self.value(row, state), self.limits, self.endless, strict=True):
            if not endless:
                cost += 1e-6 / len(self.moves) * min(abs(2 * value - low - high) / (high - low), 1.0)
        cuts = self.moves.kind[row] != Kind.RAPID
        begins = cuts and (row == 0 or self.moves.kind[row - 1] == Kind.RAPID)
        return cost + (400.0 if begins and self.prefer == 1 - state[0] else 0.0)

    def start(self, state: State) -> float:
        """Travel from home to a state of the first row."""
        move = self.value(0, state) - self.home
        return float(sum(abs(wrapped(m) if e else m) for m, e in zip(move, self.endless, strict=True)))

    def cost_of(self, way: list[int]) -> tuple[int, float]:
        """Rewinds and cost of a path, given as indices of states; infinite if one is closed."""
        if not all(self.open[row][s] for row, s in enumerate(way)):
            return 1 << 40, math.inf
        rewinds, cost = 0, self.start(self.states[way[0]]) + self.at(0, self.states[way[0]])
        for row in range(1, len(way)):
            more, travel = self.step(row, self.states[way[row - 1]], self.states[way[row]])
            rewinds, cost = rewinds + more, cost + travel + self.at(row, self.states[way[row]])
        return rewinds, cost

    def least(self) -> tuple[int, float]:
        """Fewest rewinds of all paths, and the least cost with as many."""
        n, s = len(self.moves), len(self.states)
        rewinds, cost = np.zeros((s,) * n, np.int64), np.zeros((s,) * n)
        for row in range(n):
            shape = [1] * n
            shape[row] = s
            for k in range(s):
                part = tuple(slice(None) if r != row else k for r in range(n))
                if not self.open[row][k]:
                    cost[part] = math.inf
                    continue
                cost[part] += self.at(row, self.states[k]) + (self.start(self.states[k]) if row == 0 else 0.0)
                for before in range(s):
                    if row and self.open[row - 1][before]:
                        both = tuple(before if r == row - 1 else p for r, p in enumerate(part))
                        more, travel = self.step(row, self.states[before], self.states[k])
                        rewinds[both] += more
                        cost[both] += travel
        fewest = int(rewinds[np.isfinite(cost)].min())
        return fewest, float(cost[rewinds == fewest].min())
