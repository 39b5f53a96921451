"""All checks of a program, in the order in which they are reported.

In:     what is known of a program once its rows have been seen.
Out:    checks.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any, Final, TypeVar

from trunnion.definitions.marked_values import MarkedValue
from trunnion.machines.unmeasured import POSITIONS, ValueKind, kind_of, unmeasured_values
from trunnion.messages import phrase
from trunnion.model.run_samples import joint_samples
from trunnion.records import dataclass
from trunnion.verification.basis import ACCELERATION, RAPID, SPINDLE, TOOL_LENGTH, TRAVEL, ZERO, Basis, missing_of
from trunnion.verification.checks.basis_check import check_basis
from trunnion.verification.checks.compensation_checks import check_compensation
from trunnion.verification.checks.coolant_checks import check_coolant
from trunnion.verification.checks.coverage import with_coverage
from trunnion.verification.checks.feed_checks import check_feed
from trunnion.verification.checks.hole_checks import check_holes
from trunnion.verification.checks.home_checks import check_home
from trunnion.verification.checks.linearization_check import check_between_points
from trunnion.verification.checks.machine_checks import check_acceleration, check_speed, check_travel
from trunnion.verification.checks.modal_checks import check_modal_state
from trunnion.verification.checks.motion_checks import check_kind, check_order
from trunnion.verification.checks.normal_checks import check_normals
from trunnion.verification.checks.position_checks import check_axis, check_tip
from trunnion.verification.checks.reach_check import check_reach
from trunnion.verification.checks.spindle_checks import check_spindle, check_spindle_range
from trunnion.verification.checks.stop_checks import check_stops
from trunnion.verification.checks.tool_checks import check_tool
from trunnion.verification.checks.turn_checks import check_turns
from trunnion.verification.checks.word_checks import check_words
from trunnion.verification.checks.work_offset_checks import check_work_offset
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.deviations.declared_deviations import AcceptedDeviations
from trunnion.verification.deviations.linearization import LinearizationErrors
from trunnion.verification.deviations.point_deviations import DeviationSummary
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.axis_motion import AxisMotion
from trunnion.verification.results import Check


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """What is known of any program.

    errors  between points
    motion  of the axes
    """

    context: Context
    errors: LinearizationErrors
    motion: AxisMotion


@dataclass(frozen=True, slots=True, eq=False)
class Compared(Measured):
    """What is known of a program that is compared with CL files.

    original   the path of the CL files with their own feeds; that of the context has those that are declared
    accepted   deviations that the post declares
    tip, axis  how far points are off
    """

    context: ComparedContext
    original: ExpectedPath
    accepted: AcceptedDeviations
    tip: DeviationSummary
    axis: DeviationSummary


_Needed = TypeVar("_Needed", bound=Measured)


@dataclass(frozen=True, slots=True)
class CheckEntry:
    """One check.

    key      as results, ``docs/checks.md`` and explanations have it
    needs    what it takes: ``Compared`` where it compares with CL files
    run      makes it, or none where it is no question of the program
    bases    what somebody has to state; without one of them it is not checked, or only in part
    kinds    values of the definition that its answer stands on
    is_named  in results that compare with no CL file, too: as not checked
    """

    key: str
    needs: type[Measured]
    run: Callable[[Any], Iterable[Check]]
    bases: tuple[Basis, ...] = ()
    kinds: tuple[ValueKind, ...] = ()
    is_named: bool = True

    def checks(self, seen: Measured, unmeasured: Iterable[MarkedValue]) -> Iterator[Check]:
        """Make the check, as far as what it needs is there; ``unmeasured`` values matter to the program."""
        if isinstance(seen, self.needs):
            missing = missing_of(self.bases, seen.context.run)
            values = tuple(value.said for value in unmeasured if kind_of(value) in self.kinds)
            for check in self.run(seen):
                answer = replace(check, missing=(*missing, *check.missing))
                # What was not answered stands on nothing.
                yield replace(answer, stands_on=values) if check.answer else answer
        elif self.is_named:
            yield Check(self.key, True, None, missing=(phrase("no_cl_file"),))


def _check(
    key: str, needs: type[_Needed], run: Callable[[_Needed], Check], *bases: Basis, on: tuple[ValueKind, ...] = ()
) -> CheckEntry:
    return CheckEntry(key, needs, lambda seen: (run(seen),), bases, on)


CHECKS: Final = (
    _check("order", Compared, lambda seen: check_order(seen.context)),
    _check("tip", Compared, lambda seen: check_tip(seen.context, seen.tip), on=(ValueKind.ANGLES,)),
    _check("axis", Compared, lambda seen: check_axis(seen.context, seen.axis, seen.accepted), on=(ValueKind.ANGLES,)),
    _check("kind", Compared, lambda seen: check_kind(seen.context)),
    _check("feed", Compared, lambda seen: check_feed(seen.context, seen.accepted, seen.original)),
    _check("spindle", Compared, lambda seen: check_spindle(seen.context)),
    _check("tool", Compared, lambda seen: check_tool(seen.context)),
    _check("coolant", Compared, lambda seen: check_coolant(seen.context)),
    _check("compensation", Compared, lambda seen: check_compensation(seen.context)),
    _check("stops", Compared, lambda seen: check_stops(seen.context)),
    _check("offset", Measured, lambda seen: check_work_offset(seen.context)),
    _check("home", Compared, lambda seen: check_home(seen.context), on=(ValueKind.HOME,)),
    _check("holes", Compared, lambda seen: check_holes(seen.context)),
    CheckEntry("normal", Compared, lambda seen: check_normals(seen.context), is_named=False),
    CheckEntry("reach", Compared, lambda seen: check_reach(seen.context, seen.original), is_named=False),
    _check("span", Measured, lambda seen: check_between_points(seen.context, seen.motion, seen.errors)),
    _check(
        "travel", Measured, lambda seen: check_travel(seen.context, seen.motion), TRAVEL, ZERO, TOOL_LENGTH,
        on=(*POSITIONS, ValueKind.TRAVEL),
    ),
    _check(
        "speed", Measured, lambda seen: check_speed(seen.context, seen.motion), RAPID, on=(*POSITIONS, ValueKind.RAPID),
    ),
    _check(
        "acceleration", Measured, lambda seen: check_acceleration(seen.context, seen.motion), ACCELERATION,
        on=(*POSITIONS, ValueKind.ACCELERATION),
    ),
    _check("rpm", Measured, lambda seen: check_spindle_range(seen.context), SPINDLE, on=(ValueKind.SPINDLE,)),
    _check("turns", Measured, lambda seen: check_turns(seen.context)),
    _check("modal", Measured, lambda seen: check_modal_state(seen.context)),
    _check("words", Measured, lambda seen: check_words(seen.context)),
    CheckEntry("basis", Measured, lambda seen: check_basis(seen.context)),
)  # fmt: skip


#: Checks of what a program has at the points of the CL files.
_AT_POINTS: Final = frozenset({"kind", "feed", "spindle", "tool", "coolant", "compensation", "stops"})


def _at_no_point(check: Check) -> Check:
    """Return a check of a program that goes to no point of its CL files: it has nothing to compare there."""
    if check.key not in _AT_POINTS or not check.passed:
        return check
    return Check(check.key, True, None, missing=(phrase("no_point_reached"),))


def all_checks(seen: Measured) -> tuple[Check, ...]:
    """Every check; those that need more than is known are not checked."""
    run = seen.context.run
    unmeasured = unmeasured_values(run.machine, tuple(ValueKind), joint_samples(run))
    checks = tuple(check for entry in CHECKS for check in entry.checks(seen, unmeasured))
    if isinstance(seen, Compared) and len(seen.context.expected) and not len(seen.context.matching.cl):
        checks = tuple(map(_at_no_point, checks))
    return tuple(with_coverage(seen.context, checks)) if isinstance(seen, Compared) else checks
