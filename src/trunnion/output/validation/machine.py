"""What a machine's definition leaves open that a program for it would take for granted."""

from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.output.coordinates.approach_leg import ApproachLegs, tilts_tool
from trunnion.output.program import Program

#: Values without a measure that one warning names.
_MOST_SHOWN = 12


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
    if unlimited:
        problems.append(_warning(program, Wording("CTL720", "travel_not_stated", unlimited=tuple(unlimited))))
    legs = ApproachLegs(program)
    tilted = dict.fromkeys(motion.operation.name for motion in program.motions if tilts_tool(machine, motion))
    if tilted and not (legs.placed and legs.goes_home):
        variant = "way_not_known" if legs.goes_home else "retract_not_known"
        problems.append(_warning(program, Wording("CTL730", variant, operations=tuple(tilted)[:_MOST_SHOWN])))
    return problems


def _warning(program: Program, wording: Wording) -> Problem:
    return warning(program.machine.key, 0, wording)
