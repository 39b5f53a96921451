"""What a machine's definition leaves open that a program for it would take for granted."""

from trunnion.errors import Problem, Severity
from trunnion.output.program import Program

#: Values without a measure that one warning names.
_MOST_SHOWN = 12


def machine_problems(program: Program) -> list[Problem]:
    """Return warnings of what nobody has measured, of assumed home positions, and of slides without checked travel."""
    machine = program.machine
    printed = {name for template in program.control.templates.values() for name, _ in template.fields()}
    slides = [axis for axis in machine.axes if not axis.is_rotary]
    homeless = [axis.name for axis in slides if not axis.home_is_stated and f"home_{axis.name.lower()}" in printed]
    unlimited = [axis.name for axis in slides if not axis.has_limits]
    problems = []
    if machine.unmeasured:
        shown, more = machine.unmeasured[:_MOST_SHOWN], len(machine.unmeasured) - _MOST_SHOWN
        values = ", ".join(shown) + (f" and {more} more" if more > 0 else "")
        what = f"the definition marks values as not measured yet, and the program is proven with them: {values}"
        problems.append(_warning(program, what, "measure them at the machine, write them there, and remove the marks"))
    if homeless:
        what = f"home of {', '.join(homeless)} is not stated: 0 is assumed, and the program goes there"
        problems.append(_warning(program, what, "write home_mm of these axes in the definition"))
    if unlimited:
        what = f"travel of {', '.join(unlimited)} is not stated: nothing checks it"
        problems.append(_warning(program, what, "write limits_mm of these axes in the definition"))
    return problems


def _warning(program: Program, what: str, cure: str) -> Problem:
    return Problem(program.machine.key, 0, what, cure, Severity.WARNING, code="CTL720")
