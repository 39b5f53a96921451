"""From toolpaths to motions, stage by stage."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from trunnion.errors import InputError, Problem, RefusedError, setting_problem
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Plan
from trunnion.model.toolpath import Frame, Operation, Toolpath
from trunnion.planning.linearization.point_insertion import LinearizedMotion, linearize
from trunnion.planning.linearization.slide_requirements import check_slides_are_known
from trunnion.planning.operation_plan import PlannedOperation, plan_operation
from trunnion.planning.options import ControlCapabilities, PlanOptions
from trunnion.planning.plan_problems import spindle_speed_problems, travel_problems, unknown_speed_problems
from trunnion.planning.preparation import prepare_operations
from trunnion.planning.request import PlanRequest
from trunnion.planning.skipped_turns import turns_past_skipped

#: An MSYS that is tilted by less stands upright, degrees.
_LEAST_TILT: Final = 0.01


def plan(
    toolpaths: Sequence[Toolpath],
    machine: Machine,
    chord_tolerance: float,
    options: PlanOptions | None = None,
    capabilities: ControlCapabilities | None = None,
    machine_of: Callable[[Operation], Machine] | None = None,
) -> Plan:
    """Plan all operations of one program.

    toolpaths        in the order in which they are cut. The coordinate system of the first operation is the program's,
                     unless the options ask for the absolute one; all operations are carried over into it
    machine          with a known workpiece zero its slides keep their limits; without, their travel must be long enough
                     somewhere
    chord_tolerance  the greatest distance between an arc and the lines that replace it, mm
    options          what the user asks; by default the defaults of ``PlanOptions``
    capabilities     what the control can be told; by default everything
    machine_of       the machine with the tool and the work offset of an operation; by default it is the same for all

    Raises ``InputError`` when nothing is to be planned, an option names an operation that is not there, or slide
    positions depend on something unknown (without TCP).

    Raises ``RefusedError`` when no position of the machine gives a tool axis, or an operation cannot be made in its
    mode, or a cycle not at all. No program is possible then.
    """
    options, capabilities = options or PlanOptions(), capabilities or ControlCapabilities()
    sources = [(path.file, operation) for path in toolpaths for operation in path.operations if len(operation.moves)]
    if not sources:
        raise InputError(Problem(toolpaths[0].file, 0, Wording("CL140", "no_motion")))
    _check_names(options, sources)
    remedy = _frame_remedy(sources[0][1].frame, options)
    request = PlanRequest(machine, chord_tolerance, options, capabilities, remedy)
    requests = [
        request if machine_of is None else replace(request, machine=machine_of(operation)) for _, operation in sources
    ]
    prepared = prepare_operations(sources, requests)
    planned = [plan_operation(operation) for operation in prepared]
    problems = _check_reach_and_travel(planned, request)
    linearized = _linearize(planned)
    # Where an operation has errors at CL points, those between them only follow from these.
    problems += [problem for operation, one in linearized if not operation.has_errors for problem in one.problems]
    log = [decision for operation in planned for decision in operation.log]
    log += [decision for _, one in linearized for decision in one.log]
    return Plan(tuple(one.motion for _, one in linearized), tuple(problems), tuple(log))


def _check_names(options: PlanOptions, sources: Sequence[tuple[str, Operation]]) -> None:
    """Raise ``InputError`` if a mode is set for an operation that is not there."""
    names = [operation.name for _, operation in sources]
    unknown = [name for name in options.mode_by_operation if name not in names]
    if unknown:
        known = tuple(dict.fromkeys(names))
        raise InputError(
            [setting_problem("mode", Wording("ARG230", "no_operation", name=name, known=known)) for name in unknown]
        )


def _check_reach_and_travel(planned: Sequence[PlannedOperation], request: PlanRequest) -> list[Problem]:
    """Problems so far, warnings included. Raises ``RefusedError`` with them if some tool axis is out of reach."""
    problems = [warning for operation in planned for warning in operation.prepared.warnings]
    problems += unknown_speed_problems(planned[0].prepared.file, request)
    for one in planned:
        problems += spindle_speed_problems(one.prepared.file, one.prepared.original, one.prepared.request.machine)
    problems += [problem for operation in planned for problem in operation.problems]
    if any(operation.is_out_of_reach for operation in planned):
        raise RefusedError(problems)
    anywhere = [one for one in planned if not one.prepared.request.keeps_slide_limits]
    for machine in dict.fromkeys(one.prepared.request.machine for one in anywhere):
        alike = [one for one in anywhere if one.prepared.request.machine is machine]
        operations = [(one.prepared.file, one.operation.moves, one.poses) for one in alike]
        problems += travel_problems(operations, machine)
    return problems


def _frame_remedy(first: Frame, options: PlanOptions) -> Wording | str:
    """Return what helps, besides tilting the workpiece, if the first operation's MSYS is tilted; empty if it is
    upright.
    """
    upright = float(first.matrix()[2, 2])
    tilt = math.degrees(math.acos(min(max(upright, -1.0), 1.0)))
    if options.absolute_frame or tilt < _LEAST_TILT:
        return ""
    return phrase("write_frame_msys", tilt=tilt)


def _linearize(planned: Sequence[PlannedOperation]) -> list[tuple[PlannedOperation, LinearizedMotion]]:
    """Return the motions of all operations with the points that they need between CL points."""
    motions = [(operation, motion) for operation in planned for motion in operation.motions()]
    without_tcp = [(one, motion) for one, motion in motions if motion.mode.goes_straight]
    for machine in dict.fromkeys(one.prepared.request.machine for one, _ in without_tcp):
        operations = [motion.operation for one, motion in without_tcp if one.prepared.request.machine is machine]
        check_slides_are_known(planned[0].prepared.file, operations, machine)
    found = [(one, motion, linearize(one.prepared.file, motion, one.prepared.request)) for one, motion in motions]
    return [
        (one, replace(new, problems=(*new.problems, *turns_past_skipped(one.prepared, motion, new.motion))))
        for one, motion, new in found
    ]
