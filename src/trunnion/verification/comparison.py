"""Two programs side by side: do they make the tool do the same?

In:     two runs, maybe of different machines.
Out:    whether tip, tool axis, kind of motion, feed, spindle, tool and coolant are the same all the way; the first
        difference and the worst.

Words do not matter, only what they do: block numbers, modal habits and number formats may differ, and either program
may have points more that lie on the other's path. Motions in a machine's own frame count if both run on the same one.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import forward
from trunnion.model.feed_path import row_feed_path_lengths
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.matching.path_matching import CHUNK, find_resync, workpiece_rows

#: How far ahead the two are searched for a place at which they are the same again.
_WINDOWS = (8, 64, 512)

#: Differences that are looked into; after them the programs are called different without more ado.
_MOST = 1000

#: Feeds and speeds are the same within this, mm/min and rev/min; numbers of programs have no more to say.
_RATE = 0.005
_RPM = 0.5

_KINDS = {Kind.RAPID: "rapid", Kind.LINEAR: "line", Kind.ARC: "circle"}


@dataclass(frozen=True, slots=True)
class Difference:
    """One difference: blocks of both programs as they name them, how much (mm, or 0) and in words."""

    one: str
    two: str
    value: float
    text: str


@dataclass(frozen=True, slots=True)
class Comparison:
    """What came out.

    tip, axis  the largest distances (mm, degrees) at points that are the same
    doubts     words that are not understood, if the programs do not have the same ones: they cannot be called the same
    """

    programs: tuple[str, str]
    points: int
    tip: float
    axis: float
    count: int
    first: Difference | None
    worst: Difference | None
    unknown_words: tuple[str, ...] = ()

    @property
    def same(self) -> bool:
        """Whether both programs make the tool do the same."""
        return self.count == 0 and not self.unknown_words

    def lines(self) -> Iterator[str]:
        """What came out, for a terminal."""
        if self.same:
            yield f"same: {self.points} points, tips within {self.tip:.6f} mm, tool axes within {self.axis:.6f} degrees"
            return
        yield from self.unknown_words[:5]
        yield f"different: {self.count} places, {self.points} points are the same"
        for name, what in (("first", self.first), ("worst", self.worst)):
            if what is not None and (name == "first" or what != self.first):
                yield f"{name}: {self.programs[0]}:{what.one} against {self.programs[1]}:{what.two}: {what.text}"


def compare(one: Run, two: Run, tolerance: float = 0.001, *, path: bool = False) -> Comparison:
    """Compare two runs.

    Parameters
    ----------
    tolerance
        How far tips may be apart, mm, and tool axes, degrees.
    path
        Compare where the tool goes, and whether at rapid, but not feed, spindle, tool and coolant.
    """
    return _Comparer(one, two, tolerance, path).compare()


class _Side:
    """One program, reduced to what its tool does: blocks that move and change nothing are left out."""

    def __init__(self, run: Run, with_machine_frame: bool, coolants: dict[str, int], tools: dict[str, int]) -> None:
        self.run = run
        answering = workpiece_rows(run)
        rows = answering.part(0, len(answering))
        if with_machine_frame:
            rows = np.union1d(rows, run.state.machine_frame.rows_with(True))
        self.coolant = _coolant(run, coolants)
        numbers = [tools.setdefault(_tool_name(name), len(tools)) for name in run.tools]
        self.tool = np.array(numbers, np.int64)[run.tool]
        self.start_tip, self.start_axis = (column[0] for column in forward(run.machine, run.start[None]))
        self.rows = rows[self._moving(rows)]

    def __len__(self) -> int:
        return len(self.rows)

    def _moving(self, rows: Ints) -> Flags:
        run = self.run
        moving = np.ones(len(rows), np.bool_)
        for start in range(1, len(rows), CHUNK):
            part, before = rows[start : start + CHUNK], rows[start - 1 : start - 1 + CHUNK][: len(rows) - start]
            moved = np.abs(run.tip[part] - run.tip[before]).max(axis=1, initial=0.0) > 1e-9
            moved |= np.abs(run.axis[part] - run.axis[before]).max(axis=1, initial=0.0) > 1e-12
            moving[start : start + CHUNK] = moved | (run.kind[part] == Kind.ARC)
        return moving

    def start(self, k: int) -> tuple[Floats, Floats]:
        """Tip and axis before motion ``k``."""
        if k == 0:
            return self.start_tip, self.start_axis
        row = self.rows[k - 1]
        return self.run.tip[row], self.run.axis[row]

    def rate(self, rows: Ints) -> Floats:
        """Feeds in mm/min, 0 for rapids."""
        run = self.run
        rate = np.where(run.feed_mode[rows] == 95, run.feed[rows] * run.rpm[rows], run.feed[rows])
        inverse, way = run.feed_mode[rows] == 93, row_feed_path_lengths(run, rows)
        free = ~np.isnan(way)
        if inverse.any() or free.any():
            before = np.maximum(rows - 1, 0)
            length = np.sqrt(((run.tip[rows] - run.tip[before]) ** 2).sum(axis=1))
            rate = np.where(inverse, rate * length, rate)
            rate[free] *= length[free] / way[free]
        return np.asarray(np.where(run.kind[rows] == Kind.RAPID, 0.0, np.nan_to_num(rate)))

    def arc(self, k: int) -> tuple[Floats, Floats] | None:
        """Centre and normal of the circle that motion ``k`` is, if it is one."""
        row = self.rows[k]
        if self.run.kind[row] != Kind.ARC:
            return None
        m = int(np.searchsorted(self.run.arcs.row, row))
        return self.run.arcs.centre[m], self.run.arcs.normal[m]

    def turns(self, k: int) -> int:
        """Whole turns of the circle that motion ``k`` is."""
        m = int(np.searchsorted(self.run.arcs.row, self.rows[k]))
        return int(self.run.arcs.full_turns[m])

    def name(self, k: int) -> str:
        """Line and block number of a motion, or where the program ends."""
        if not len(self.run):
            return "0"
        row = int(self.rows[k]) if k < len(self.rows) else len(self.run) - 1
        number = int(self.run.block_number[row])
        end = "" if k < len(self.rows) else ", after its last motion"
        return f"{int(self.run.line[row])}" + (f" (N{number}{end})" if number >= 0 else f"{end}")


def _tool_name(name: str) -> str:
    return str(int(name)) if name.isdigit() else name


def _coolant(run: Run, codes: dict[str, int]) -> Ints:
    """A number for the coolant of every row, (n,)."""
    state = np.full(len(run), codes.setdefault("off", len(codes)), np.int64)
    for event in run.events:
        if event.kind == "coolant":
            state[event.before_row :] = codes.setdefault(str(event.value), len(codes))
    return state


class _Comparer:
    """Walks along both programs together."""

    def __init__(self, one: Run, two: Run, tolerance: float, path: bool) -> None:
        coolants: dict[str, int] = {}
        tools: dict[str, int] = {}
        same_machine = one.machine is two.machine or one.machine.key == two.machine.key
        self._one = _Side(one, same_machine, coolants, tools)
        self._two = _Side(two, same_machine, coolants, tools)
        self._path = path
        self._tip = tolerance
        self._axis = float(np.radians(tolerance))
        self._largest = [0.0, 0.0]
        self._points = 0
        self._found: list[Difference] = []
        self._worst: Difference | None = None

    def compare(self) -> Comparison:
        one, two = self._one, self._two
        i = j = 0
        size = 64
        while i < len(one) and j < len(two) and len(self._found) < _MOST:
            count = min(size, len(one) - i, len(two) - j)
            same = self._same(i, j, count)
            length = count if same.all() else int(np.argmin(same))
            self._points += length
            i, j = i + length, j + length
            if length == count:
                size = min(2 * size, CHUNK)
                continue
            size = 64
            if self._on_way(one, i, two, j):
                i += 1
                continue
            if self._on_way(two, j, one, i):
                j += 1
                continue
            i, j = self._differ(i, j)
        while i < len(one) or j < len(two):
            if len(self._found) >= _MOST:
                break
            value = float("inf")
            which = "first" if i < len(one) else "second"
            self._note(i, j, value, f"only the {which} program goes on")
            break
        run_one, run_two = one.run, two.run
        return Comparison(
            (run_one.files[0], run_two.files[0]),
            self._points,
            self._largest[0],
            float(np.degrees(self._largest[1])),
            len(self._found),
            self._found[0] if self._found else None,
            self._worst,
            _doubts(run_one, run_two),
        )

    def _same(self, i: int, j: int, count: int) -> Flags:
        """Which of ``count`` motions are the same, (count,) bool."""
        one, two = self._one, self._two
        a, b = one.rows[i : i + count], two.rows[j : j + count]
        tip = np.abs(one.run.tip[a] - two.run.tip[b]).max(axis=1, initial=0.0)
        axis = np.sqrt(((one.run.axis[a] - two.run.axis[b]) ** 2).sum(axis=1))
        same = (tip <= self._tip) & (axis <= self._axis) & (one.run.kind[a] == two.run.kind[b])
        same &= self._same_state(a, b)
        arcs = np.flatnonzero(same & (one.run.kind[a] == Kind.ARC))
        for k in arcs.tolist():
            same[k] = self._same_circle(i + k, j + k)
        if same.any():
            self._largest[0] = max(self._largest[0], float(tip[same].max()))
            self._largest[1] = max(self._largest[1], float(axis[same].max()))
        return np.asarray(same)

    def _same_state(self, a: Ints, b: Ints) -> Flags:
        if self._path:
            return np.ones(len(a), np.bool_)
        one, two = self._one, self._two
        same = np.abs(one.rate(a) - two.rate(b)) <= np.maximum(_RATE, 1e-4 * one.rate(a))
        same &= one.run.spindle[a] == two.run.spindle[b]
        same &= (np.abs(one.run.rpm[a] - two.run.rpm[b]) <= _RPM) | (one.run.spindle[a] == 0)
        same &= one.tool[a] == two.tool[b]
        same &= one.coolant[a] == two.coolant[b]
        return np.asarray(same)

    def _same_circle(self, i: int, j: int) -> bool:
        one, two = self._one.arc(i), self._two.arc(j)
        if one is None or two is None or self._one.turns(i) != self._two.turns(j):
            return False
        apart = one[0] - two[0]
        apart = apart - (apart @ one[1]) * one[1]
        return bool(np.abs(apart).max() <= 2.0 * self._tip and one[1] @ two[1] > 1.0 - 1e-6)

    def _on_way(self, more: _Side, i: int, less: _Side, j: int) -> bool:
        """Whether motion ``i`` ends on the way of the other's motion ``j``, and does it in the same manner."""
        a, b = more.rows[i], less.rows[j]
        if more.run.kind[a] != less.run.kind[b]:
            return False
        pair = (np.array([a]), np.array([b])) if more is self._one else (np.array([b]), np.array([a]))
        if not self._same_state(*pair)[0]:
            return False
        (start, start_axis), end, point = less.start(j), less.run.tip[b], more.run.tip[a]
        begin, begin_axis = more.start(i)
        done = more.arc(i)
        if done is not None:
            circle = less.arc(j)
            if circle is None or (np.abs(done[0] - circle[0]) > 2.0 * self._tip).any() or done[1] @ circle[1] < 0.999:
                return False
            part, before = (_round(circle, start, p, end) for p in (point, begin))
            if np.abs(begin - start).max() <= self._tip:
                before = 0.0
            if not (1e-9 < part < 1.0 and before < part):
                return False
            return bool((np.abs(more.run.axis[a] - start_axis) <= self._axis).all())
        way = end - start
        length = float(way @ way)
        if length < self._tip**2:
            # Nothing but the tool axis moves: it must be on its way.
            turn = less.run.axis[b] - start_axis
            total = float(turn @ turn)
            part = float((more.run.axis[a] - start_axis) @ turn) / total if total > 0.0 else 0.0
            before = float((begin_axis - start_axis) @ turn) / total if total > 0.0 else 0.0
        else:
            part, before = float((point - start) @ way) / length, float((begin - start) @ way) / length
        if not (before - 1e-9 <= part <= 1.0 + 1e-9):
            return False
        if (np.abs(point - (start + part * way)) > self._tip).any():
            return False
        axis = start_axis + part * (less.run.axis[b] - start_axis)
        axis = axis / np.linalg.norm(axis)
        return bool(np.linalg.norm(more.run.axis[a] - axis) <= self._axis)

    def _differ(self, i: int, j: int) -> tuple[int, int]:
        """Note a difference, and find where the programs are the same again."""
        one, two = self._one, self._two
        for window in _WINDOWS:
            a, b = one.rows[i : i + window], two.rows[j : j + window]
            fits = np.ones((len(a), len(b)), np.bool_)
            for c in range(3):
                fits &= np.abs(one.run.tip[a, c][:, None] - two.run.tip[b, c]) <= self._tip
                fits &= np.abs(one.run.axis[a, c][:, None] - two.run.axis[b, c]) <= self._axis
            if fits[0, 0]:
                self._note(i, j, 0.0, self._how(int(a[0]), int(b[0]), i, j))
                return i + 1, j + 1
            found = find_resync(fits, (len(a) < window, len(b) < window))
            if found is not None:
                break
        else:
            found = (len(one) - i, len(two) - j)
        less = min(found)
        for k in range(min(max(less, 1), _MOST)):
            if i + k >= len(one) or j + k >= len(two):
                break
            if found[0] == found[1] and self._same(i + k, j + k, 1)[0]:
                self._points += 1
                continue
            p, q = int(one.rows[i + k]), int(two.rows[j + k])
            apart = float(np.linalg.norm(one.run.tip[p] - two.run.tip[q]))
            angle = float(np.degrees(np.linalg.norm(one.run.axis[p] - two.run.axis[q])))
            text = f"tips are {apart:.6f} mm apart, tool axes {angle:.6f} degrees"
            if found[0] != found[1]:
                more = abs(found[0] - found[1])
                text += f"; the {'first' if found[0] > found[1] else 'second'} program has {more} points more"
            self._note(i + k, j + k, apart + angle, text)
            if found[0] != found[1]:
                break
        return i + found[0], j + found[1]

    def _how(self, a: int, b: int, i: int, j: int) -> str:
        """What differs at the same point."""
        one, two = self._one, self._two
        x, y = one.run, two.run
        if x.kind[a] != y.kind[b]:
            return f"{_KINDS[Kind(int(x.kind[a]))]} against {_KINDS[Kind(int(y.kind[b]))]}"
        rates = float(one.rate(np.array([a]))[0]), float(two.rate(np.array([b]))[0])
        if abs(rates[0] - rates[1]) > max(_RATE, 1e-4 * rates[0]):
            return f"feed {rates[0]:g} against {rates[1]:g} mm/min"
        if x.spindle[a] != y.spindle[b] or abs(x.rpm[a] - y.rpm[b]) > _RPM:
            speeds = [f"S{run.rpm[row]:g} {_SENSES[int(run.spindle[row])]}" for run, row in ((x, a), (y, b))]
            return f"spindle {speeds[0]} against {speeds[1]}"
        if one.tool[a] != two.tool[b]:
            return f"tool {x.tools[x.tool[a]] or 'none'} against {y.tools[y.tool[b]] or 'none'}"
        if one.coolant[a] != two.coolant[b]:
            return "coolant differs"
        return "circles about other centres, or the other way round"

    def _note(self, i: int, j: int, value: float, text: str) -> None:
        found = Difference(self._one.name(i), self._two.name(j), value, text)
        self._found.append(found)
        if self._worst is None or value > self._worst.value:
            self._worst = found


def _doubts(one: Run, two: Run) -> tuple[str, ...]:
    """Words that are not understood, unless both programs have the same ones: nobody knows what they do."""
    if sorted(error.text for error in one.errors) == sorted(error.text for error in two.errors):
        return ()
    return tuple(
        f"{error.file}:{error.line}: not understood: {error.text}" for run in (one, two) for error in run.errors
    )


_SENSES = {1: "clockwise", -1: "counterclockwise", 0: "off"}


def _round(circle: tuple[Floats, Floats], start: Floats, point: Floats, end: Floats) -> float:
    """How much of the way round a circle from ``start`` to ``end`` a point is; -1 if it is not on it."""
    centre, normal = circle
    a, p, b = start - centre, point - centre, end - centre
    if abs(float(np.linalg.norm(p) - np.linalg.norm(a))) > 0.01:
        return -1.0

    def angle(arm: Floats) -> float:
        return float(np.arctan2(np.cross(a, arm) @ normal, a @ arm - (a @ normal) * (arm @ normal)) % (2.0 * np.pi))

    whole = angle(b)
    return angle(p) / (whole if whole > 1e-9 else 2.0 * np.pi)
