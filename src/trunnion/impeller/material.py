"""What metal stands before each step, and whether a step is there too early: estimates, without a simulation.

In:     the impeller with its steps in their order.
Out:    ``Material`` before each of them; warnings about steps that another one should have come before.
Units:  mm.

A ball takes metal as high as its radius; where more stands, it goes into the full. What a step leaves is its allowance
and the ridges between its passes.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Annotated, Final

import numpy as np

from trunnion.errors import InputError, Problem, warning
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.paths.shroud import shroud_form
from trunnion.impeller.steps import ROUND_STEPS, MachiningStep, StepKind
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Figure
from trunnion.simulation.tools.profile import Role

#: Points of the shroud at which the depth of the channels is looked at.
_SAMPLES: Final = 201

#: The step that takes most of what stands above the form, and of what fills the channels.
_CLEARS: Final = {True: StepKind.STOCK_ROUGHING, False: StepKind.CHANNEL_ROUGHING}


@dataclass(frozen=True, slots=True)
class Material:
    """What stands, at most.

    form    above the form of the shroud, across
    hub     above the hub; the depth of the channels where nothing has cleared them
    blades  on blades; None: nothing has been along them
    """

    form: Annotated[float, Figure(unit="mm", decimals=6)]
    hub: Annotated[float, Figure(unit="mm", decimals=6)]
    blades: Annotated[float | None, Figure(unit="mm", decimals=6)]


def full_stock(impeller: Impeller) -> Material:
    """Return the stock before anything is cut; without a form that can be milled round Z, it has the form of the
    shroud.
    """
    stock = impeller.definition.stock
    rim = stock.diameter / 2.0
    try:
        heights, form = shroud_form(impeller)
        stands = rim - float(form[heights < stock.top].min())
    except InputError:
        stands = 0.0
    points = impeller.shroud.curve.points(np.linspace(0.0, 1.0, _SAMPLES))
    inside = (points[:, 0] <= rim) & (points[:, 2] <= stock.top) & (points[:, 2] >= stock.bottom)
    depth = impeller.hub.distances(points[inside])[0].max(initial=0.0)
    return Material(max(stands, 0.0), float(depth), None)


def material_before(impeller: Impeller) -> tuple[Material, ...]:
    """Return what stands before each step of the definition, and what after the last one."""
    definition = impeller.definition
    now = full_stock(impeller)
    for kind in definition.premachined:
        now = _after(now, kind, 0.0, 0.0)
    found = [now]
    for step in definition.steps:
        now = _after(now, step.kind, *_leaves(step, _radius(impeller, step)))
        found.append(now)
    return tuple(found)


def order_problems(impeller: Impeller, chosen: Sequence[str] = ()) -> Iterator[Problem]:
    """Warnings about the chosen steps (none: all) that find more metal than they can take."""
    definition = impeller.definition
    for k, (step, before) in enumerate(zip(definition.steps, material_before(impeller), strict=False)):
        if chosen and step.name not in chosen:
            continue
        radius = _radius(impeller, step)
        is_form = step.kind in (StepKind.STOCK_FINISHING, StepKind.CHANNEL_ROUGHING)
        if step.kind is StepKind.STOCK_ROUGHING:
            yield from _one_turn(impeller, step, radius)
            continue
        stands = before.form if is_form else max(before.hub, before.blades or 0.0)
        takes = radius + (step.step_down if is_form else 0.0)
        if stands > takes:
            yield _too_much(definition.file, step, definition.steps, k, (stands, radius))


def _one_turn(impeller: Impeller, step: MachiningStep, radius: float) -> Iterator[Problem]:
    """Yield the warning about a step down that takes all that stands beside the form in one turn."""
    definition, stock = impeller.definition, impeller.definition.stock
    try:
        heights, form = shroud_form(impeller, step.allowance)
    except InputError:  # the step itself says so
        return
    stands = form < stock.diameter / 2.0
    height = stock.top - float(heights[stands].min(initial=stock.top))
    if step.step_down >= height > radius:
        yield warning(
            definition.file,
            step.line,
            Wording("IMP331", "step_down_mm", step=step.name, step_down=step.step_down, height=height),
        )


def side_problems(
    file: str, step: MachiningStep, before: Material, clearance: Sequence[PartClearance]
) -> Iterator[Problem]:
    """Warnings about a step whose shank or holder comes nearer to a blade or the hub than metal stands there."""
    if before.blades is None or step.kind in ROUND_STEPS:
        return
    for one in clearance:
        left = before.hub if one.body == "the hub" else before.blades
        if one.part is not Role.CUTTER and one.distance < left:
            yield warning(
                file,
                step.line,
                Wording(
                    "IMP333",
                    "comes_near_mm",
                    step=step.name,
                    part=one.part,
                    distance=one.distance,
                    body=one.body,
                    left=left,
                ),
            )


def _too_much(
    file: str, step: MachiningStep, steps: Sequence[MachiningStep], place: int, sizes: tuple[float, float]
) -> Problem:
    """Return the warning about a step that finds more than it can take: how much, its ball's radius."""
    stands, radius = sizes
    is_form = step.kind in (StepKind.STOCK_FINISHING, StepKind.CHANNEL_ROUGHING)
    clears = _CLEARS[is_form]
    before = [one for one in steps[:place] if one.kind is clears]
    behind = [one for one in steps[place + 1 :] if one.kind is clears]
    if before:
        return warning(
            file,
            step.line,
            Wording("IMP332", "up_mm", step=step.name, stands=stands, radius=radius, before=before[-1].name)
            if is_form
            else Wording(
                "IMP332",
                "up_mm_metal_stand_hub_between",
                step=step.name,
                stands=stands,
                radius=radius,
                before=before[-1].name,
            ),
        )
    return warning(
        file,
        step.line,
        (
            Wording("IMP332", "up_mm_metal", step=step.name, stands=stands, radius=radius, behind=behind[0].name)
            if is_form
            else Wording(
                "IMP332", "up_mm_metal_stand", step=step.name, stands=stands, radius=radius, behind=behind[0].name
            )
        )
        if behind
        else (
            Wording("IMP332", "up_mm_metal_stand_outside", step=step.name, stands=stands, radius=radius, clears=clears)
            if is_form
            else Wording("IMP332", "up_mm_metal_stand_hub", step=step.name, stands=stands, radius=radius, clears=clears)
        ),
    )


def _radius(impeller: Impeller, step: MachiningStep) -> float:
    tool = next(each for each in impeller.definition.tools if each.number == step.tool)
    return tool.sizes.diameter / 2.0


def _leaves(step: MachiningStep, radius: float) -> tuple[float, float]:
    """Return what a step leaves at most on the form or the blades, and on the hub."""
    across = _ridge(radius, step.stepover.scallop, step.stepover.distance)
    match step.kind:
        case StepKind.STOCK_ROUGHING:
            return step.allowance + step.step_down, 0.0  # stairs of a flat mill
        case StepKind.CHANNEL_ROUGHING:
            return step.allowance + _ridge(radius, 0.0, step.step_down), step.hub_allowance + across
        case StepKind.HUB_FINISH:
            return step.allowance, step.hub_allowance + across
        case _:
            return step.allowance + across, 0.0


def _ridge(radius: float, scallop: float, apart: float) -> float:
    """Return the height of the ridge between passes of a ball on a plane."""
    if scallop:
        return scallop
    return radius - math.sqrt(max(radius**2 - apart**2 / 4.0, 0.0))


def _after(now: Material, kind: StepKind, side: float, hub: float) -> Material:
    """Return what stands after a step that leaves so much on the form or the blades, and on the hub."""
    blades = side if now.blades is None else min(now.blades, side)
    match kind:
        case StepKind.STOCK_ROUGHING | StepKind.STOCK_FINISHING:
            return replace(now, form=min(now.form, side))
        case StepKind.CHANNEL_ROUGHING:
            return Material(now.form, min(now.hub, hub), blades)
        case StepKind.HUB_FINISH:
            return replace(now, hub=min(now.hub, hub), blades=side if now.blades is None else now.blades)
        case StepKind.BLADE_FINISH | StepKind.FLANK_MILLING:
            return replace(now, blades=blades)
        case StepKind.ROOT_BLEND:
            return now
