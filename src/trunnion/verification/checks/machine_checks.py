"""What the program asks of the machine: travel, speed and acceleration of its axes."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from trunnion.machines import Axis
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.model.tool_additions import added_lengths
from trunnion.records import dataclass
from trunnion.verification.checks.coverage import coverage_of
from trunnion.verification.context import MAX_PLACES, Context
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.machine_travel import positions_beyond_travel, unknown_steps
from trunnion.verification.kinematics.values_in_force import with_values_in_force
from trunnion.verification.kinematics.worst_rows import WorstRows
from trunnion.verification.results import Check, Coverage

#: Travel beyond a limit by less than this is rounding, mm or degrees.
_ROUNDING = 1e-5


@dataclass(frozen=True, slots=True, eq=False)
class _Margin:
    """Travel that an axis has left, mm or degrees, negative where it goes too far; and how and where it uses it.

    reached  what it does with its travel
    least    the same as part of an answer, without the block
    """

    axis: Axis
    left: float
    reached: Wording
    value: float
    row: int
    least: Wording | None = None

    @property
    def share(self) -> float:
        """Of the travel of the axis."""
        return self.left / max(self.axis.high - self.axis.low, 1e-9)


def check_travel(context: Context, motion: AxisMotion) -> Check:
    """Every axis is inside its limits; the summary has the least distance of each axis to one, at the part."""
    coverage, unknown = _coverage(context, motion)
    margins = sorted(_margins(context, motion), key=lambda margin: margin.share)
    over = [margin for margin in (*margins, *_machine_margins(context)) if margin.left < -_ROUNDING]
    if not (margins or over):
        return Check("travel", True, Wording("travel", "nothing_moves"), missing=unknown, coverage=coverage)
    over.sort(key=lambda margin: margin.share)
    places = tuple(context.place(each.row, each.value, _reached(each)) for each in (over or margins))
    least = tuple(each.least.with_parameters(block=context.block_name(each.row)) for each in margins if each.least)
    answer = places[0].wording if over else Wording("travel", "good", axes=least)
    worst = (over or margins)[0]
    return Check("travel", not over, answer, worst.left, 0.0, _unit(worst.axis), places, unknown, coverage)


def _reached(margin: _Margin) -> Wording:
    """Return what an axis does with its travel, and how much is left, or lacking."""
    variant = "too_far" if margin.left < 0 else "left"
    return Wording("travel", variant, reached=margin.reached, distance=abs(margin.left))


def _unit(axis: Axis) -> str:
    return "deg" if axis.is_rotary else "mm"


def _coverage(context: Context, motion: AxisMotion) -> tuple[Coverage, tuple[Wording, ...]]:
    """Return which motions are looked at, and what is missing for the others where zero and tool length are known."""
    run, unknown = context.run, motion.unknown
    left_out = dict(zip(unknown.rows.tolist(), unknown.reasons, strict=True))
    left_out |= dict.fromkeys(unknown_steps(run).tolist(), phrase("left_step_unknown"))
    rows = sorted(left_out)
    places = tuple(context.place(row, 0.0, left_out[row]) for row in rows[:MAX_PLACES])
    coverage = Coverage(len(run) - len(rows), len(run), places)
    is_placed = MachinePositions.of(run).known
    return coverage, (phrase("motions_unknown", count=len(rows)),) if rows and is_placed else ()


def _margins(context: Context, motion: AxisMotion) -> Iterator[_Margin]:
    """Yield the margin of each axis with limits.

    Slides that nobody knows the place of, as the workpiece zero or the tool length is missing, are compared with their
    whole travel; with a zero also with their limits for a tool without length, which they must not leave either.
    """
    machine, added = context.run.machine, added_lengths(context.run)
    for k, axis in machine.own_columns:
        low, high = motion.extremes[k].tolist()
        if low > high or not axis.has_limits:
            continue
        rows = motion.extreme_rows[k].tolist()
        below, above = low - axis.low, axis.high - high
        is_placed = machine.is_placed(k)
        if not is_placed and (machine.workpiece_zero is None or min(below, above) >= -_ROUNDING):
            named = {"axis": axis.name, "needed": high - low, "travel": axis.high - axis.low}
            needs = Wording("travel", "needs", **named)
            if blocks := _blocks_within(context, motion, k, (0, 1)):
                needs = Wording("travel", "needs_on_way", **named, blocks=blocks)
            left = (axis.high - axis.low) - (high - low)
            least = Wording("travel", "least_needed", **named, left=left, unit="mm")
            yield _Margin(axis, left, needs, high - low, rows[1], least)
            continue
        side, value, limit = (0, low, axis.low) if below < above else (1, high, axis.high)
        row, left = rows[side], min(below, above)
        own, blocks = float(added[row]), _blocks_within(context, motion, k, (side,))
        at = Wording("travel", "at", value=value)
        unit, with_tool = _unit(axis), _with_tool(at, context.run, k, row, own)
        variant = "least_on_way" if blocks else "least"
        least = Wording("travel", variant, axis=axis.name, left=left, unit=unit, at=with_tool)
        if blocks:
            with_tool = _with_tool(Wording("travel", "at_on_way", at=at, blocks=blocks), context.run, k, row, own)
        goes = Wording("travel", "goes_to", axis=axis.name, at=with_tool, limit=limit, unit=unit)
        yield _Margin(axis, left, goes, value, row, least)


def _with_tool(at: Wording, run: Run, column: int, row: int, added: float) -> Wording:
    """Return a position with the tool and the work offset that it stands on; ``added`` is what the program adds."""
    is_placed = run.machine.is_placed(column)
    at = with_values_in_force(at, run, column, row) if is_placed else Wording("travel", "at_without_length", at=at)
    if not (added and run.machine.depends_on_length(column)):
        return at
    return Wording("travel", "at_with_added" if is_placed else "at_and_with_added", at=at, added=added)


def _blocks_within(context: Context, motion: AxisMotion, column: int, sides: Sequence[int]) -> tuple[Wording, ...]:
    """Return the blocks in which a linear axis is farther out than at their ends, while rotary axes turn."""
    rows = [int(motion.extreme_rows[column, side]) for side in sides if motion.within_lines[column, side]]
    return tuple(dict.fromkeys(context.block_name(row) for row in rows))


def _machine_margins(context: Context) -> Iterator[_Margin]:
    """Positions in machine coordinates beyond the travel; those within it are no measure of the room at the part."""
    for found in positions_beyond_travel(context.run):
        axis = context.run.machine.axes[found.column]
        values = {"at": found.value, "limit": found.limit, "unit": _unit(axis)}
        goes = Wording("travel", "goes_to_in_machine", axis=axis.name, **values)
        yield _Margin(axis, -found.beyond, goes, found.value, found.row)


def check_speed(context: Context, motion: AxisMotion) -> Check:
    """Shares of rapid speed; the control slows down where more than all of it is needed, so this never fails."""
    if not any(axis.rapid for axis in context.run.machine.own_axes):
        return Check("speed", True, None)
    return replace(_check_shares(context, motion.speed, "speed"), coverage=coverage_of(context, motion.speed_seen))


def check_acceleration(context: Context, motion: AxisMotion) -> Check:
    """Shares of acceleration; the control slows down where more than all of it is needed, so this never fails."""
    if not any(axis.acceleration for axis in context.run.machine.own_axes):
        return Check("acceleration", True, None)
    check = _check_shares(context, motion.acceleration, "acceleration")
    return replace(check, coverage=coverage_of(context, motion.change_seen))


def _check_shares(context: Context, shares: Sequence[WorstRows], key: str) -> Check:
    axes = context.run.machine.axes
    places = [
        context.place(row, share, Wording(key, "slows", axis=axis.name, share=100.0 * share))
        for axis, worst in zip(axes, shares, strict=True)
        for row, share in worst.rows
    ]
    places.sort(key=lambda place: -place.value)
    top = max(range(len(axes)), key=lambda k: shares[k].value)
    worst, unit = shares[top], Wording(key, "unit").what
    if worst.row < 0:
        return Check(key, True, Wording(key, "none_moves"), 0.0, None, unit)
    most = {"axis": axes[top].name, "share": 100.0 * worst.value, "block": context.block_name(worst.row)}
    answer = Wording(key, "most", **most)
    if count := sum(each.count for each in shares):
        answer = Wording(key, "most_and_slows", **most, count=count)
    # No limit: more than all of it is no fault of the program, the control slows down.
    return Check(key, True, answer, worst.value, None, unit, tuple(places[:MAX_PLACES]))
