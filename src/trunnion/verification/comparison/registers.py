"""What moves the tool off its programmed path, or lets the control leave it: offsets, lengths, radii, tolerances.

In:     two runs.
Out:    for each of these registers a column of whole numbers for either run, equal where both are the same.

The positions of a run do not show these, as their values are in the control. Programs of one language are compared by
what they write. For those of two languages, whose numbers mean other registers, only how many there are and where they
change can be compared.
"""

from collections.abc import Callable, Hashable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final, TypeAlias

import numpy as np

from trunnion.arrays import Flags, Ints, distinct
from trunnion.messages import Wording
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.comparison.states import ComparedState, Values

#: Tolerances and what is added to tools are the same within this, mm: programs print no more digits; those in inches.
_LAST_DIGIT: Final = 1e-4
_LAST_DIGIT_OF_INCHES: Final = 2.6e-3

#: Number of a work offset that TRAORI has cleared.
_LOST: Final = -1

_SIDES: Final = {1: "left", -1: "right", 0: "off"}

#: What a register is called in a row.
_Said: TypeAlias = Wording | str | tuple[Wording, ...]

#: Words that add to the length and to the radius of a tool, by what they do.
_DELTAS: Final = {"DL": "length", "TOFFL": "length", "DR": "radius", "TOFFR": "radius"}


@dataclass(frozen=True, slots=True, eq=False)
class Register:
    """A register of both runs.

    variant   what is said where it differs
    columns   of the first run and of the second: its values by numbers
    words     what each run calls a value in a row
    counts    in which rows of a run it counts
    of_path   it moves the tool; else it counts for the rest of the comparison only
    within    values that differ by no more are the same
    """

    variant: str
    columns: tuple[StepColumn, StepColumn]
    words: tuple[Callable[[int], _Said], Callable[[int], _Said]]
    counts: Callable[[Run, Ints], Flags]
    of_path: bool = False
    within: float = 0.0


def compared_registers(one: Run, two: Run, *, path: bool) -> list[ComparedState]:
    """Return the registers of two runs; ``path``: only those that move the tool."""
    same_words = one.language == two.language
    return [_state(one, two, each) for each in _registers(one, two, same_words) if each.of_path or not path]


def _state(one: Run, two: Run, register: Register) -> ComparedState:
    first, second = register.columns

    def values(a: Ints, b: Ints) -> Values:
        return first.at(a), second.at(b)

    def same(a: Ints, b: Ints) -> Flags:
        x, y = values(a, b)
        if not register.within:
            return np.asarray(x == y)
        with np.errstate(invalid="ignore"):  # inf: no limit
            return np.asarray((x == y) | (np.abs(x - y) <= register.within))

    return ComparedState(
        lambda a, b: register.counts(one, a) & register.counts(two, b),
        same,
        values,
        lambda a, b: Wording("comparison", register.variant, one=register.words[0](a), two=register.words[1](b)),
    )


def _registers(one: Run, two: Run, same_words: bool) -> Iterator[Register]:
    """Yield the registers of two runs; ``same_words``: their programs are of one language."""
    runs = one, two
    offsets = [_offset_column(run) for run in runs]
    if not same_words:
        offsets = [_in_order(run.state.work_offset) for run in runs]
    yield replace(_register("offset", runs, offsets, _offset_words, _in_workpiece), of_path=True)
    sides = [run.state.compensation for run in runs]
    yield replace(_register("side", runs, sides, _side_words, _everywhere), of_path=True)
    numbers: dict[Hashable, int] = {}
    digit = _LAST_DIGIT_OF_INCHES if any(run.state.inches.values.any() for run in runs) else _LAST_DIGIT
    deltas = [_delta_column(run, same_words, digit, numbers) for run in runs]
    yield replace(_register("deltas", runs, deltas, _delta_words, _everywhere), of_path=True)
    if not same_words:
        return
    variant = "length_number" if one.uses_length_numbers else "edge"
    yield _register(variant, runs, [run.state.edge for run in runs], _edge_words, _in_workpiece)
    yield _register("radius", runs, [run.state.radius for run in runs], _radius_words, _compensated)
    tolerances = [_tolerance_column(run) for run in runs]
    yield replace(_register("tolerance", runs, tolerances, _tolerance_words, _cutting), within=digit)
    turns = [_tolerance_column(run, "orientation_tolerance") for run in runs]
    yield replace(_register("axis_tolerance", runs, turns, _turn_words, _cutting), within=_LAST_DIGIT)


def _register(
    variant: str,
    runs: tuple[Run, Run],
    columns: list[StepColumn],
    words: Callable[[Run, int], _Said],
    counts: Callable[[Run, Ints], Flags],
) -> Register:
    """Return a register that counts for the rest of the comparison only."""
    one, two = runs
    first, second = columns
    return Register(variant, (first, second), (partial(words, one), partial(words, two)), counts)


def _offset_column(run: Run) -> StepColumn:
    """Return the work offsets, ``_LOST`` from where TRAORI clears one to where it is selected again."""
    column = run.state.work_offset
    events = [event for event in run.events if event.kind == "offset"]
    if not events:
        return column
    lost = _column(
        run, [0, *(each.before_row for each in events)], [False, *(each.value == "TRAORI" for each in events)]
    )
    rows = distinct(np.concatenate((column.rows, lost.rows)))
    rows = rows[rows < len(run)]
    return StepColumn(len(run), rows, np.where(lost.at(rows), _LOST, column.at(rows).astype(np.int64)))


def _in_order(column: StepColumn) -> StepColumn:
    """Values by the order in which they come, none (0) as it is."""
    order: dict[int, int] = {0: 0}
    values = [order.setdefault(int(value), len(order)) for value in column.values]
    return StepColumn(column.n, column.rows, np.array(values, np.int64))


# Where they count


def _everywhere(_run: Run, rows: Ints) -> Flags:
    return np.ones(len(rows), np.bool_)


def _in_workpiece(run: Run, rows: Ints) -> Flags:
    return ~np.asarray(run.state.machine_frame.at(rows), np.bool_)


def _compensated(run: Run, rows: Ints) -> Flags:
    return np.asarray(run.state.compensation.at(rows) != 0)


def _cutting(run: Run, rows: Ints) -> Flags:
    return np.asarray(run.kind[rows] != Kind.RAPID)


# Those that only events tell


def _delta_column(run: Run, by_name: bool, digit: float, numbers: dict[Hashable, int]) -> StepColumn:
    """Return what the program adds to the tool in the spindle; ``numbers`` are those of both runs."""
    held: dict[str, int] = {}

    def values() -> Iterator[tuple[int, Hashable]]:
        for event in run.events:
            if event.kind == "tool_change":
                held.clear()
            elif event.kind == "delta" and isinstance(event.value, tuple):
                name = str(event.value[0])
                count = round(float(event.value[1] or 0.0) / digit)
                held[name if by_name else _DELTAS.get(name, name)] = count
            else:
                continue
            yield event.before_row, frozenset((name, count) for name, count in held.items() if count)

    return _steps(run, [(0, frozenset()), *values()], numbers)


def _tolerance_column(run: Run, kind: str = "tolerance") -> StepColumn:
    """Within which tolerance the control may leave the path, mm, or the tool axis, degrees; 0: none."""
    found: list[tuple[int, float]] = [(0, 0.0)]
    for event in run.events:
        if event.kind == kind:
            found.append((event.before_row, float(event.value) if isinstance(event.value, int | float) else 0.0))
    rows, values = zip(*found, strict=True)
    return _column(run, list(rows), list(values))


def _steps(run: Run, found: list[tuple[int, Hashable]], numbers: dict[Hashable, int]) -> StepColumn:
    """Return a column of values by numbers, which both runs share; they are filled in."""
    rows = [row for row, _ in found]
    return _column(run, rows, [numbers.setdefault(value, len(numbers)) for _, value in found])


def _column(run: Run, rows: list[int], values: list[Any]) -> StepColumn:
    """Return a column by its changes; of several before one row the last holds."""
    last = dict(zip(rows, values, strict=True))
    return StepColumn(len(run), np.array(list(last), np.int64), np.array(list(last.values())))


# What they are called


def _offset_words(run: Run, row: int) -> Wording | str:
    code = int(_offset_column(run)[row])
    if code > 0:
        return run.work_offset_name(code)
    return Wording("comparison", "cleared" if code == _LOST else "none")


def _side_words(run: Run, row: int) -> Wording:
    return Wording("comparison", _SIDES[int(run.state.compensation[row])])


def _edge_words(run: Run, row: int) -> Wording | str:
    number = int(run.state.edge[row])
    return f"{'H' if run.uses_length_numbers else 'D'}{number}" if number >= 0 else Wording("comparison", "none")


def _radius_words(run: Run, row: int) -> Wording | str:
    number = int(run.state.radius[row])
    return f"D{number}" if number >= 0 else Wording("comparison", "the_tool")


def _delta_words(run: Run, row: int) -> tuple[Wording, ...]:
    held: dict[str, float] = {}
    for event in run.events:
        if event.before_row > row:
            break
        if event.kind == "tool_change":
            held.clear()
        elif event.kind == "delta" and isinstance(event.value, tuple):
            held[str(event.value[0])] = float(event.value[1] or 0.0)
    found = (Wording("comparison", "delta", word=name, value=value) for name, value in held.items() if value)
    return tuple(found) or (Wording("comparison", "nothing"),)


def _tolerance_words(run: Run, row: int, kind: str = "tolerance", variant: str = "millimetres") -> Wording:
    found = [event.value for event in run.events if event.kind == kind and event.before_row <= row]
    value = float(found[-1]) if found and isinstance(found[-1], int | float) else 0.0
    if not value or np.isinf(value):
        return Wording("comparison", "any" if value else "none")
    return Wording("comparison", variant, value=value)


def _turn_words(run: Run, row: int) -> Wording:
    return _tolerance_words(run, row, "orientation_tolerance", "degrees")
