"""What a machine's definition leaves open that a program for it would take for granted."""

from trunnion.errors import Problem, warning
from trunnion.machines import Axis
from trunnion.messages import Wording
from trunnion.output.coordinates.approach_leg import ApproachLegs, tilts_tool
from trunnion.output.program import Program

#: Values without a measure that one warning names.
_MOST_SHOWN = 12

#: Home within this distance of a limit is at the end of the travel, mm.
_NEAR_END = 10.0


def machine_problems(program: Program) -> list[Problem]:
    """Return warnings of what nobody has measured or stated: home positions, travel, the way to planes."""
    machine = program.machine
    printed = {name for template in program.control.templates.values() for name, _ in template.fields()}
    slides = [axis for axis in machine.axes if not axis.is_rotary]
    homeless = [axis.name for axis in slides if not axis.home_is_stated and f"home_{axis.name.lower()}" in printed]
    unlimited = [axis.name for axis in slides if not axis.has_limits]
    problems = []
    if machine.unmeasured:
        shown, more = map(str, machine.unmeasured[:_MOST_SHOWN]), len(machine.unmeasured) - _MOST_SHOWN
        problems.append(
            _warning(
                program,
                Wording("CTL720", "definition_marks_values", shown=tuple(shown), more=more)
                if more > 0
                else Wording("CTL720", "definition_marks_values_not", shown=tuple(shown)),
            )
        )
    if homeless:
        problems.append(_warning(program, Wording("CTL720", "home_not_stated", homeless=tuple(homeless))))
    marked = {value.of for value in (*machine.unmeasured, *machine.assumed) if value.key == "home_mm"}
    if "home_z" in printed and any(axis.name == "Z" and _is_midway(axis) for axis in slides if axis.name in marked):
        problems.append(_warning(program, Wording("CTL720", "retract_is_assumed")))
    if unlimited:
        problems.append(_warning(program, Wording("CTL720", "travel_not_stated", unlimited=tuple(unlimited))))
    legs = ApproachLegs(program)
    tilted = dict.fromkeys(
        motion.operation.name
        for motion in program.motions
        if tilts_tool(machine, motion) and not (legs.is_placed(motion) and legs.goes_home)
    )
    if tilted:
        variant = "way_not_known" if legs.goes_home else "retract_not_known"
        problems.append(_warning(program, Wording("CTL730", variant, operations=tuple(tilted)[:_MOST_SHOWN])))
    return problems


def _is_midway(axis: Axis) -> bool:
    """Whether home is at no end of the travel."""
    return axis.low + _NEAR_END < axis.home < axis.high - _NEAR_END


def _warning(program: Program, wording: Wording) -> Problem:
    return warning(program.machine.key, 0, wording)
