"""What an operation needs at its start: a spindle speed, a tool, templates for its machining mode, a tolerance."""

from itertools import pairwise

import numpy as np

from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, LoadTool, Operation, SpindleOff, SpindleOn
from trunnion.output.program import Program


def spindle_problems(program: Program, operation: Operation, turns: bool | None) -> list[Problem]:
    """Refuse the first cut of an operation for which the spindle stands: before the first SPINDL, or after SPINDL/OFF.

    A check of the program without its CL files would fail it as well. An operation without a speed is warned of.

    ``turns`` is whether the spindle turns when the operation begins, by the operations before; None: no SPINDL yet.
    """
    switches = [event for event in operation.events if isinstance(event, SpindleOn | SpindleOff)]
    for event, following in pairwise([None, *switches, None]):
        start = event.row if event else 0
        on = turns if event is None else isinstance(event, SpindleOn)
        cuts = operation.moves.kind[start : following.row if following else None] != Kind.RAPID
        if on or not cuts.any():
            continue
        if program.effective_setting("standing_spindle") != "allowed":
            line = int(operation.moves.line[start + int(np.argmax(cuts))])
            return [
                Problem(
                    program.file_of(operation),
                    line,
                    Wording("CTL510", "operation_cuts_while", operation=operation.name)
                    if event is None and turns is None
                    else Wording("CTL510", "operation_cuts_while_spindle", operation=operation.name),
                )
            ]
        break
    if turns is None and not any(isinstance(event, SpindleOn) for event in switches):
        return [
            warning(
                program.file_of(operation),
                operation.line,
                Wording("CTL520", "operation_no_spindle", operation=operation.name),
            )
        ]
    return []


def other_speed_problems(program: Program, operation: Operation, before: str, number: int) -> list[Problem]:
    """Warn of an operation that changes the tool, and cuts with the spindle speed of the one before.

    ``before`` is the name of that, empty if its spindle stands; ``number`` that of the tool, 0 if there was none.
    """
    loads = [event for event in operation.events if isinstance(event, LoadTool) and event.row == 0]
    speeds = [event.row for event in operation.events if isinstance(event, SpindleOn)]
    cuts = np.flatnonzero(operation.moves.kind != Kind.RAPID)
    if not (before and loads and number not in (0, loads[0].number) and len(cuts)) or (speeds and speeds[0] <= cuts[0]):
        return []
    return [
        warning(
            program.file_of(operation),
            loads[0].line,
            Wording("CTL520", "operation_loads_tool", operation=operation.name, number=loads[0].number, before=before),
        )
    ]


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


def machining_mode_problems(program: Program, motion: Motion) -> list[Problem]:
    """Refuse a machining mode for which the control has no templates."""
    if program.template_suffix(motion):
        return []
    operation = motion.operation
    return [
        Problem(
            program.file_of(operation),
            operation.line,
            Wording(
                "CTL210", "operation_no_words", operation=operation.name, control=program.control.name, mode=motion.mode
            ),
        )
    ]


def _is_of_holes(operation: Operation) -> bool:
    """Whether an operation makes holes by cycles, and cuts nothing between them."""
    between, is_open = np.ones(len(operation.moves), np.bool_), False
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff):
            is_open = isinstance(event, CycleOn)
            between[event.row :] = not is_open
    cuts = operation.moves.kind != Kind.RAPID
    return not between.all() and not bool((cuts & between).any())


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
