"""What the program asks of the machine: travel, speed and acceleration of its axes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from trunnion.machines import Axis
from trunnion.messages import Wording, phrase
from trunnion.model.tool_additions import added_lengths
from trunnion.verification.checks.coverage import coverage_of
from trunnion.verification.context import MAX_PLACES, Context
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.machine_travel import positions_beyond_travel, unknown_steps
from trunnion.verification.kinematics.values_in_force import values_in_force
from trunnion.verification.kinematics.worst_rows import WorstRows
from trunnion.verification.results import Check, Coverage
from trunnion.wording import counted

#: Travel beyond a limit by less than this is rounding, mm or degrees.
_ROUNDING = 1e-5


@dataclass(frozen=True, slots=True, eq=False)
class _Margin:
    """Travel that an axis has left, mm or degrees, negative where it goes too far; and how and where it uses it."""

    axis: Axis
    left: float
    text: str
    value: float
    row: int
    within: str = ""

    @property
    def share(self) -> float:
        """Of the travel of the axis."""
        return self.left / max(self.axis.high - self.axis.low, 1e-9)


def check_travel(context: Context, motion: AxisMotion) -> Check:
    """Every axis is inside its limits; the summary has the least distance of each axis to one, at the part."""
    title = "travel of the axes"
    coverage, unknown = _coverage(context, motion)
    margins = sorted(_margins(context, motion), key=lambda margin: margin.share)
    over = [margin for margin in (*margins, *_machine_margins(context)) if margin.left < -_ROUNDING]
    if not (margins or over):
        return Check("travel", title, True, "no axis with limits moves", missing=unknown, coverage=coverage)
    over.sort(key=lambda margin: margin.share)
    places = tuple(
        context.place(margin.row, margin.value, f"{margin.text}, {_words(margin.left, margin.left < 0)}")
        for margin in (over or margins)
    )
    worst = (over or margins)[0]
    unit = "deg" if worst.axis.is_rotary else "mm"
    summary = places[0].text if over else ", ".join(_least(context, margin) for margin in margins)
    return Check("travel", title, not over, summary, worst.left, 0.0, unit, places, unknown, coverage)


def _least(context: Context, margin: "_Margin") -> str:
    """Return the least distance of an axis to a limit, and where that is."""
    unit = "deg" if margin.axis.is_rotary else "mm"
    return f"{margin.axis.name} {margin.left:.3f} {unit} left in {context.block_name(margin.row)}{margin.within}"


def _coverage(context: Context, motion: AxisMotion) -> tuple[Coverage, tuple[Wording, ...]]:
    """Return which motions are looked at, and what is missing for the others where zero and tool length are known."""
    run, unknown = context.run, motion.unknown
    left_out = dict(zip(unknown.rows.tolist(), unknown.reasons, strict=True))
    left_out |= dict.fromkeys(unknown_steps(run).tolist(), phrase("left_step_unknown"))
    rows = sorted(left_out)
    places = tuple(context.place(row, 0.0, left_out[row].what) for row in rows[:MAX_PLACES])
    coverage = Coverage(len(run) - len(rows), len(run), places)
    is_placed = MachinePositions.of(run).known
    return coverage, (phrase("motions_unknown", count=len(rows)),) if rows and is_placed else ()


def _words(left: float, too_far: bool) -> str:
    return f"{abs(left):.3f} {'too far' if too_far else 'left'}"


def _margins(context: Context, motion: AxisMotion) -> Iterator[_Margin]:
    """Yield the margin of each axis with limits.

    Slides that nobody knows the place of, as the workpiece zero or the tool length is missing, are compared with their
    whole travel; with a zero also with their limits for a tool without length, which they must not leave either.
    """
    machine, added = context.run.machine, added_lengths(context.run)
    for k, axis in enumerate(machine.axes):
        low, high = motion.extremes[k].tolist()
        if low > high or not axis.has_limits:
            continue
        rows = motion.extreme_rows[k].tolist()
        below, above = low - axis.low, axis.high - high
        is_placed = machine.is_placed(k)
        if not is_placed and (machine.workpiece_zero is None or min(below, above) >= -_ROUNDING):
            within = _within(context, motion, k, (0, 1))
            counted_too = f", counting what it does{within}" if within else ""
            text = f"{axis.name} needs {high - low:.3f} of {axis.high - axis.low:g} mm{counted_too}"
            needs = f", it needs {high - low:.3f} of {axis.high - axis.low:g}"
            yield _Margin(axis, (axis.high - axis.low) - (high - low), text, high - low, rows[1], needs)
            continue
        value, limit, row = (low, axis.low, rows[0]) if below < above else (high, axis.high, rows[1])
        tool = "" if is_placed else " with a tool 0 mm long"
        if is_placed:
            tool += values_in_force(context.run, k, row)
        if machine.depends_on_length(k) and added[row]:
            tool += f", {'' if is_placed else 'and '}the tool {added[row]:+g} mm by the program"
        unit, within = "deg" if axis.is_rotary else "mm", _within(context, motion, k, (0,) if below < above else (1,))
        text = f"{axis.name} goes to {value:.3f}{within}{tool}, its limit is {limit:g} {unit}"
        yield _Margin(axis, min(below, above), text, value, row, f" at {value:.3f}{tool}{within and ', on the way'}")


def _within(context: Context, motion: AxisMotion, column: int, sides: Sequence[int]) -> str:
    """Where a slide is farther out between the ends of a block than at them; empty if it is not."""
    rows = [int(motion.extreme_rows[column, side]) for side in sides if motion.within_lines[column, side]]
    names = " and ".join(dict.fromkeys(context.block_name(row) for row in rows))
    return f" within {names}, while rotary axes turn" if names else ""


def _machine_margins(context: Context) -> Iterator[_Margin]:
    """Positions in machine coordinates beyond the travel; those within it are no measure of the room at the part."""
    for found in positions_beyond_travel(context.run):
        axis = context.run.machine.axes[found.column]
        unit = "deg" if axis.is_rotary else "mm"
        text = f"{axis.name} goes to {found.value:.3f} in machine coordinates, its limit is {found.limit:g} {unit}"
        yield _Margin(axis, -found.beyond, text, found.value, found.row)


def check_speed(context: Context, motion: AxisMotion) -> Check:
    """Shares of rapid speed; the control slows down where more than all of it is needed, so this never fails."""
    title = "speed of the axes at the programmed feed"
    if not any(axis.rapid for axis in context.run.machine.axes):
        return Check("speed", title, True, "")
    check = _check_shares(context, motion.speed, "speed", title, "rapid speed", "no axis moves at feed")
    return replace(check, coverage=coverage_of(context, motion.speed_seen))


def check_acceleration(context: Context, motion: AxisMotion) -> Check:
    """Shares of acceleration; the control slows down where more than all of it is needed, so this never fails."""
    title = "acceleration of the axes between blocks"
    if not any(axis.acceleration for axis in context.run.machine.axes):
        return Check("acceleration", title, True, "")
    none = "no two motions at feed follow each other"
    check = _check_shares(context, motion.acceleration, "acceleration", title, "acceleration", none)
    return replace(check, coverage=coverage_of(context, motion.change_seen))


def _check_shares(
    context: Context, shares: Sequence[WorstRows], key: str, title: str, quantity: str, none: str
) -> Check:
    axes = context.run.machine.axes
    text = "{} would need {:.0f} % of its {}: the control slows down"
    places = [
        context.place(row, share, text.format(axis.name, 100.0 * share, quantity))
        for axis, worst in zip(axes, shares, strict=True)
        for row, share in worst.rows
    ]
    places.sort(key=lambda place: -place.value)
    top = max(range(len(axes)), key=lambda k: shares[k].value)
    worst = shares[top]
    if worst.row < 0:
        return Check(key, title, True, none, 0.0, None, f"of {quantity}")
    count = sum(each.count for each in shares)
    summary = (
        f"{axes[top].name} at most {100.0 * worst.value:.0f} % of its {quantity}, in {context.block_name(worst.row)}"
    )
    if count:
        summary += f"; in {counted(count, 'place')} the control slows down"
    # No limit: more than all of it is no fault of the program, the control slows down.
    return Check(key, title, True, summary, worst.value, None, f"of {quantity}", tuple(places[:MAX_PLACES]))
