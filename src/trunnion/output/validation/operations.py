"""What an operation needs at its start: a tool, templates for its machining mode, a tolerance."""

from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOn, Kind, LoadTool, Operation
from trunnion.output.program import Program
from trunnion.output.validation.spindle import cycle_rows


def tool_problems(program: Program, operation: Operation, in_spindle: str) -> list[Problem]:
    """Warn of a tool without LOAD/TOOL, and refuse a name by which the control cannot call it.

    ``in_spindle`` is the name of the tool of the operation before.
    """
    problems, name = list[Problem](), operation.tool.name
    loaded = any(isinstance(e, LoadTool) for e in operation.events) or program.effective_setting("tool", operation)
    stays = not loaded and name == in_spindle
    if not loaded and name and not stays:
        problems.append(
            warning(
                program.file_of(operation),
                operation.line,
                Wording("CTL140", "operation_no_load", operation=operation.name),
            )
        )
    if name and (not (loaded or stays) or program.effective_setting("tool_call", operation) == "name"):
        try:
            program.control.family.tool_call(0, name, by_name=True)
        except UnsupportedFeatureError as why:
            wording = why.wording.within("of", name=program.control.name)
            problems.append(Problem(program.file_of(operation), operation.line, wording))
    return problems


def _is_of_holes(operation: Operation) -> bool:
    """Whether an operation makes holes by cycles, and cuts nothing between them."""
    in_cycle = cycle_rows(operation)
    return bool(in_cycle.any()) and not bool(((operation.moves.kind != Kind.RAPID) & ~in_cycle).any())


def tolerance_problems(program: Program, motion: Motion) -> list[Problem]:
    """Warn of an operation without a tolerance, if its templates print one."""
    operation = motion.operation
    given = operation.intol is not None and operation.outtol is not None
    # Holes are made along a line: no tolerance of the path counts in them.
    if (
        given
        or _is_of_holes(operation)
        or not _prints_tolerance(program, motion)
        or program.effective_setting("tolerance", operation)
    ):
        return []
    fallback = program.effective_setting("fallback_tolerance", operation)
    return [
        warning(
            program.file_of(operation),
            operation.line,
            Wording("CTL530", "operation_no_intol", operation=operation.name, fallback=fallback),
        )
    ]


def _prints_tolerance(program: Program, motion: Motion) -> bool:
    """Whether the templates at the start of an operation print its tolerance, and no setting has another one."""
    names = "operation_start", f"approach_{program.template_suffix(motion)}"
    templates = [program.control.templates[name] for name in names if name in program.control.templates]
    fields = {name for template in templates for name, _ in template.fields()}
    own = "three_axis_tolerance" in fields and program.effective_setting("three_axis_tolerance", motion.operation)
    return bool(fields & {"tolerance", "three_axis_tolerance"}) and not own


def plane_entry_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse a cut as the first motion in a tilted plane, where the control wants a rapid; a hole begins with one."""
    moves, events = motion.operation.moves, motion.operation.events
    if motion.plane is None or not program.control.rapid_into_planes or moves.kind[0] == Kind.RAPID:
        return []
    if any(isinstance(event, CycleOn) and event.row == 0 for event in events):
        return []
    return [
        Problem(
            program.file_of(motion.operation),
            int(moves.line[0]),
            Wording("CTL540", "cut_first_motion", control=program.control.name),
        )
    ]


def next_axis_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse an operation that continues from home with another tool axis, if there is no template for that."""
    suffix = program.template_suffix(motion)
    if motion.plane is not None or not suffix or f"next_axis_{suffix}" in program.control.templates:
        return []
    moves, name = motion.operation.moves, program.control.name
    return [
        Problem(
            program.file_of(motion.operation),
            int(moves.line[0]),
            Wording("CTL550", "holes_along_another", mode=motion.mode, name=name, suffix=suffix),
        )
    ]
