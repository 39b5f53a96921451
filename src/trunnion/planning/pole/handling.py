"""The stage that handles the pole: the tool axis leans so that the rotary axes need not be too fast.

It acts only if the user chooses a strategy. Every row that then differs from the CL file is recorded, so that a proof
can check the program against the record.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.errors import Problem, warning
from trunnion.messages import Wording, phrase
from trunnion.model.deviations import Deviations
from trunnion.model.motion import Decision, DecisionTopic, PoleStrategy
from trunnion.model.toolpath import Kind, Operation
from trunnion.planning.pole.lean_task import LeanedMoves, LeanTask, PoleRegion
from trunnion.planning.pole.tool_axis_lean import lean_tool_axis
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.request import PreparedOperation
from trunnion.records import dataclass

#: Regions that are named one by one.
_NAMED: Final = 20

#: How many angles are tried to find one that is enough, each twice the one before.
_TRIED: Final = 6

_EFFECTS: Final = {
    PoleStrategy.HOLD: "pole_hold",
    PoleStrategy.SPREAD: "pole_spread",
    PoleStrategy.LEAN: "pole_lean",
}


@dataclass(frozen=True, slots=True, eq=False)
class PoleResult:
    """An operation with its poses after this stage; ``problems`` are warnings."""

    operation: Operation
    poses: PlannedPoses
    deviations: Deviations
    log: tuple[Decision, ...] = ()
    problems: tuple[Problem, ...] = ()


def handle_pole(prepared: PreparedOperation, poses: PlannedPoses) -> PoleResult:
    """Lean the tool axis near the pole as the options ask; ``poses`` are those under the CAM's tool axes."""
    options, operation = prepared.request.options, prepared.operation
    if options.pole_strategy is PoleStrategy.OFF:
        return PoleResult(operation, poses, Deviations.none())
    leaned = _lean(prepared, poses, options.pole_strategy, options.pole_angle)
    deviations = replace(
        Deviations.none(),
        max_lean=options.pole_angle,
        leaned_rows=prepared.source_rows[leaned.rows],
        leaned_rotary=leaned.poses.rotary[leaned.rows],
    )
    return PoleResult(
        replace(operation, moves=leaned.moves),
        leaned.poses,
        deviations,
        tuple([_decision(prepared, region) for region in leaned.regions if region.is_solved][:_NAMED]),
        tuple(_problems(prepared, poses, leaned)),
    )


def sufficient_setting(prepared: PreparedOperation, poses: PlannedPoses, angle: float) -> Wording | str:
    """Return what to set if a lean of ``angle`` degrees is not enough, as the cure of a message.

    Without the lower feeds of ``lower_feed`` where all feeds are lowered anyway; then empty if nothing else helps.
    """
    fastest = prepared.request.options.fastest_feed
    for more in angle * 2.0 ** np.arange(1, _TRIED):
        if all(region.is_solved for region in _lean(prepared, poses, PoleStrategy.LEAN, float(more)).regions):
            return phrase("pole_pole_angle", more=more) if fastest else phrase("pole_pole_angle_would", more=more)
    return "" if fastest else phrase("lower_feed_lowers")


def _lean(prepared: PreparedOperation, poses: PlannedPoses, strategy: PoleStrategy, angle: float) -> LeanedMoves:
    request = prepared.request
    task = LeanTask.of(request.machine, prepared.operation, _fixed_rows(prepared), angle, request.keeps_slide_limits)
    return lean_tool_axis(task, poses, strategy)


def _fixed_rows(prepared: PreparedOperation) -> Flags:
    """Rows whose tool axis stays: the ends of arcs, and lines that stand for arcs."""
    arc = prepared.operation.moves.kind == Kind.ARC
    pieces = np.diff(prepared.source_rows, prepend=-1) == 0
    arc |= pieces | np.append(pieces[1:], False)
    return np.asarray(arc | np.append(arc[1:], False))


def _decision(prepared: PreparedOperation, region: PoleRegion) -> Decision:
    line, machine = prepared.operation.moves.line, prepared.request.machine
    name, effect = machine.axes[machine.rotary[0]].name, _EFFECTS[prepared.request.options.pole_strategy]
    said = Wording("decision", effect, axis=name, first=line[region.first], last=line[region.end - 1], lean=region.lean)
    return prepared.decision(region.first, DecisionTopic.POLE, said)


def _problems(prepared: PreparedOperation, poses: PlannedPoses, leaned: LeanedMoves) -> list[Problem]:
    """Regions in which no lean within the angle is enough."""
    unsolved = [region for region in leaned.regions if not region.is_solved]
    if not unsolved:
        return []
    line, machine = prepared.operation.moves.line, prepared.request.machine
    name, angle = machine.axes[machine.rotary[0]].name, prepared.request.options.pole_angle
    cure = sufficient_setting(prepared, poses, angle)
    problems = []
    for region in unsolved[:_NAMED]:
        wording = Wording("PLN410", "no_lean", angle=angle, axis=name, line=line[region.end - 1], cure=cure)
        problems.append(warning(prepared.file, int(line[region.first]), wording))
    return problems
