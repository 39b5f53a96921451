"""The paths of all steps of an impeller.

In:     ``Impeller`` with its steps and tools; which tool axes a machine reaches.
Out:    ``StepPaths`` for each step: one path for each blade, channel or turn round the part, and what was proven of it.
Units:  mm.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.flank.blade_flank import BladeFlank, mill_blade_flank
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.paths.blade_finish import BladeFinish, blade_finish
from trunnion.impeller.paths.channel import channels_of
from trunnion.impeller.paths.channel_families import channel_roughing, hub_finish
from trunnion.impeller.paths.channel_sheets import Ball
from trunnion.impeller.paths.clear_poses import pose_check
from trunnion.impeller.paths.clearance import SLACK, Margins, Obstacles, obstacles_of, tool_body
from trunnion.impeller.paths.least_clearances import PartClearance, least_clearances
from trunnion.impeller.paths.linking import FreeSpace, IsClear, LinkedPath, Links, Surroundings, link_passes
from trunnion.impeller.paths.passes import Pass, PassFamily
from trunnion.impeller.paths.root_blend import RootBlend, root_blend
from trunnion.impeller.paths.shroud import shroud_finish, shroud_form, stock_roughing
from trunnion.impeller.paths.stock_clearance import is_roughed, stock_before, stock_clearances
from trunnion.impeller.paths.tool_axes import SHARES, ToolAxes, Wanted, choose_axes
from trunnion.impeller.progress import Progress, silent
from trunnion.impeller.steps import ROUND_STEPS, MachiningStep, StepKind
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.tools.library.library import LibraryTool
from trunnion.simulation.tools.profile import Role, ToolShape

#: Which tool axes (n, 3) a machine reaches, (n,).
Reachable = Callable[[Floats], Flags]

#: Parts of a step's tolerance for the chords of its passes, and for the points that are left out of them.
_PASS_SHARE: Final = 0.5
_THINNING_SHARE: Final = 0.5

#: A direct link is as long as so many step-overs at most, or this long, mm.
_LINK_STEPS: Final = 4.0
_LINK: Final = 3.0

#: What helps a part of a tool that mills flanks.
_NOT_CLEAR: Final = {
    Role.CUTTER: "flank_cutter_not_clear",
    Role.SHANK: "flank_shank_not_clear",
    Role.HOLDER: "flank_holder_not_clear",
}

#: A ball this far in the form of the shroud still touches it only, mm.
_NEAR: Final = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class StepPaths:
    """A step as paths.

    radius        from ball centres to tips; 0 where centres are tips
    names, paths  for each blade, channel, or the whole part, in the order of machining
    families      its passes, once for all blades that are alike; none of steps round the part
    axes          of these families, with what was proven of them
    flanks        of flank milling: both sides of the blade, and of the splitter, with what is left of them
    clearance     of a step round the part: shank and holder to the stock, where they are near; of flank milling: each
                  part of the tool, the cutter to what it does not mill
    share         of the wanted clearances that is kept
    left          what a step round the part leaves besides its allowance, where the tool's side would cut too much
    """

    step: MachiningStep
    tool: LibraryTool
    radius: float
    names: tuple[str, ...]
    paths: tuple[LinkedPath, ...]
    families: tuple[PassFamily, ...] = ()
    axes: tuple[ToolAxes, ...] = ()
    flanks: tuple[BladeFlank, ...] = ()
    clearance: tuple[PartClearance, ...] = ()
    share: float = 1.0
    left: float = 0.0


def step_paths(
    impeller: Impeller, reachable: Reachable | None, names: Sequence[str] = (), progress: Progress = silent
) -> Iterator[StepPaths]:
    """Yield the paths of the steps of an impeller, one after another.

    impeller   its definition has the steps and their tools
    reachable  None: every tool axis can be had
    names      of the steps to make; none: all of them
    progress   accompanies the work within each step

    Raises ``InputError`` if a step cannot be made, with its place and cure; or there is none.
    """
    definition = impeller.definition
    if not definition.steps:
        raise InputError(Problem(definition.file, 0, Wording("IMP310", "no_operation")))
    makers = _StepMaker(impeller, reachable, progress)
    for step in definition.steps:
        if names and step.name not in names:
            continue
        try:
            yield makers.make(step)
        except InputError as error:
            raise InputError(
                [
                    Problem(
                        definition.file,
                        step.line,
                        each.wording.within("of", name=step.name),
                        severity=each.severity,
                    )
                    for each in error.problems
                ]
            ) from None


class _StepMaker:
    """Makes steps, with what they share: the bodies that tools keep clear of."""

    def __init__(self, impeller: Impeller, reachable: Reachable | None, progress: Progress) -> None:
        self._impeller, self._reachable, self._progress = impeller, reachable, progress
        self._obstacles: Obstacles | None = None

    def make(self, step: MachiningStep) -> StepPaths:
        """Return the paths of a step."""
        tool = next(each for each in self._impeller.definition.tools if each.number == step.tool)
        if step.kind in ROUND_STEPS:
            return self._round(step, tool)
        return self._flanks(step, tool) if step.kind is StepKind.FLANK_MILLING else self._five_axis(step, tool)

    def _round(self, step: MachiningStep, tool: LibraryTool) -> StepPaths:
        """Return a step that goes round the part."""
        impeller, half, chord = self._impeller, tool.sizes.diameter / 2.0, _PASS_SHARE * step.tolerance
        if step.kind is StepKind.STOCK_ROUGHING:
            width = step.stepover.on(half)
            turned = stock_roughing(impeller, half, step.step_down, width, step.allowance, chord)
            radius = 0.0
        else:
            turned = shroud_finish(impeller, half, step.stepover, step.tilt, step.allowance, chord)
            radius = half
        space = self._space(step, tool.shape(), half, radius, turned.axes)
        around = Surroundings(space, _outside(impeller, radius), step.name)
        before = stock_before(impeller, step, step.stepover.on(half))
        slotting = step.tilt > 0.0 and not is_roughed(impeller.definition, step)
        passes = list(zip(turned.passes, turned.axes, strict=True))
        clearance = stock_clearances(tool.shape(), radius, 0.0 if slotting else half, passes, before)
        path = link_passes(turned.passes, turned.axes, around, _links(step), radius, self._within(step))
        return StepPaths(step, tool, radius, (step.name,), (path,), clearance=clearance, left=turned.left)

    def _space(
        self, step: MachiningStep, shape: ToolShape, half: float, radius: float, axes: Sequence[Floats]
    ) -> FreeSpace:
        elements = [element for section in shape.sections for element in section.outline]
        outline = np.array([point for one in elements for point in (one.start, one.end)]) - [0.0, radius]
        stock = self._impeller.definition.stock
        return FreeSpace.around(stock, step.clearance[3], half, outline, np.concatenate(list(axes)))

    def _five_axis(self, step: MachiningStep, tool: LibraryTool) -> StepPaths:
        """Return a step that is made once and copied to each blade or channel."""
        obstacles = self._bodies()
        shape, radius = tool.shape(), tool.sizes.diameter / 2.0
        cutter, shank, holder, _ = step.clearance
        wanted = Wanted(cutter=cutter, shank=shank, holder=holder, tilt=step.tilt)
        is_clear = pose_check(obstacles, shape, radius, step.tolerance)
        copies: list[tuple[float, LinkedPath]] = []
        families, fields, progress = [], [], self._within(step)
        for family, angles in self._families(step, radius):
            found = choose_axes(family, shape, obstacles, wanted, self._everywhere(angles), progress)
            space = self._space(step, shape, radius, radius, found.axes)
            around = Surroundings(space, is_clear, step.name)
            path = link_passes(family.passes, found.axes, around, _links(step), radius, progress)
            copies += [(angle, path.turned(angle)) for angle in angles]
            families.append(family)
            fields.append(found)
        names, paths = _named(step, copies)
        share = min(one.share for one in fields)
        return StepPaths(step, tool, radius, names, paths, tuple(families), tuple(fields), share=share)

    def _within(self, step: MachiningStep) -> Progress:
        """Progress within a step, which its stages do not name."""
        return lambda stage, total, unit: self._progress(f"{step.name}: {stage}", total, unit)

    def _bodies(self) -> Obstacles:
        if self._obstacles is None:
            self._obstacles = obstacles_of(self._impeller)
        return self._obstacles

    def _flanks(self, step: MachiningStep, tool: LibraryTool) -> StepPaths:
        """Both sides of each blade, with the side of the tool."""
        obstacles, impeller = self._bodies(), self._impeller
        shape, radius = tool.shape(), tool.sizes.diameter / 2.0
        slope = math.sin(math.radians(tool.sizes.side_angle))
        cutter = FlankCutter(radius, slope, shape.flute_length - radius)
        is_clear = pose_check(obstacles, shape, radius, step.overcut, step.overcut + SLACK)
        copies: list[tuple[float, LinkedPath]] = []
        flanks: list[BladeFlank] = []
        clearance, share = list[PartClearance](), 1.0
        body = tool_body(shape, radius, Margins(0.0, 0.0, 0.0, 1.0))
        within = self._within(step)
        for blade in _kinds_of_blades(impeller):
            first, *rest = (angle for each, angle in impeller.blades() if each is blade)
            sides = [mill_blade_flank(impeller, blade, side, cutter, step.overcut, within) for side in (1.0, -1.0)]
            found = [_climbing(one) for one in sides]
            family = PassFamily(tuple(one for one, _ in found), radius, step.way).turned(first)
            turned = [rotated(axis, first) for _, axis in found]
            own = "blade 1" if blade is impeller.blade else "splitter 1"
            clearance += least_clearances(obstacles, body, family.centres(), np.concatenate(turned), [own])
            share = min(share, _kept(step, tool, clearance))
            space = self._space(step, shape, radius, radius, turned)
            around = Surroundings(space, is_clear, step.name)
            path = link_passes(family.passes, turned, around, _links(step), radius, within)
            copies += [(angle, path.turned(angle - first)) for angle in (first, *rest)]
            flanks += sides
        names, paths = _named(step, copies)
        return StepPaths(
            step, tool, radius, names, paths, flanks=tuple(flanks), clearance=tuple(clearance), share=share
        )

    def _everywhere(self, angles: Sequence[float]) -> Reachable | None:
        """Which tool axes a machine reaches in all copies of a family."""
        reachable = self._reachable
        if reachable is None:
            return None

        turns = np.array([[[np.cos(a), np.sin(a), 0.0], [-np.sin(a), np.cos(a), 0.0], [0.0, 0.0, 1.0]] for a in angles])

        def in_all(axes: Floats) -> Flags:
            found = reachable((axes @ turns).reshape(-1, 3))
            return np.asarray(found.reshape(len(angles), -1).all(axis=0))

        return in_all

    def _families(self, step: MachiningStep, radius: float) -> Iterator[tuple[PassFamily, list[float]]]:
        """Yield the families of a step, and the angles of their copies about Z."""
        impeller, chord = self._impeller, _PASS_SHARE * step.tolerance
        pitch = 2.0 * np.pi / impeller.definition.number
        if step.kind in (StepKind.CHANNEL_ROUGHING, StepKind.HUB_FINISH):
            ball = Ball(radius, chord, step.allowance, step.hub_allowance)
            for channel in channels_of(impeller):
                if step.kind is StepKind.CHANNEL_ROUGHING:
                    family = channel_roughing(channel, ball, step.stepover, step.step_down, self._within(step))
                else:
                    family = hub_finish(channel, ball, step.stepover, self._within(step))
                yield family, [k * pitch for k in range(impeller.definition.number)]
            return
        for blade in _kinds_of_blades(impeller):
            # Splitters are described in the frame of a blade: only where they stand is clear what is around them.
            first, *rest = (angle for each, angle in impeller.blades() if each is blade)
            if step.kind is StepKind.BLADE_FINISH:
                wanted = BladeFinish(radius, step.stepover, step.way, step.allowance, chord)
                family = blade_finish(impeller, blade, wanted)
            else:
                family = root_blend(impeller, blade, self._root_blend(step, radius, chord))
            yield family.turned(first), [0.0, *(angle - first for angle in rest)]

    def _root_blend(self, step: MachiningStep, radius: float, chord: float) -> RootBlend:
        """Return what is wanted of a root blend: it reaches as far as the balls that went before could not."""
        largest = {StepKind.HUB_FINISH: radius, StepKind.BLADE_FINISH: radius}
        for other in self._impeller.definition.steps:
            if other.kind in largest:
                tool = next(each for each in self._impeller.definition.tools if each.number == other.tool)
                largest[other.kind] = max(largest[other.kind], tool.sizes.diameter / 2.0 + other.allowance)
        hub, blade = largest[StepKind.HUB_FINISH], largest[StepKind.BLADE_FINISH]
        return RootBlend(radius, step.stepover, hub, blade, step.way, chord)


def _kinds_of_blades(impeller: Impeller) -> list[Blade]:
    """Return the blade, and the splitter if there is one."""
    return [impeller.blade] if impeller.splitter is None else [impeller.blade, impeller.splitter]


def _climbing(flank: BladeFlank) -> tuple[Pass, Floats]:
    """Return the pass of a side with the blade on its right, so that a tool that turns clockwise climbs, and
    its axes.
    """
    one, axis = flank.as_pass()
    return (one.backwards(), axis[::-1]) if flank.side > 0.0 else (one, axis)


def operation_names(impeller: Impeller, step: MachiningStep) -> tuple[str, ...]:
    """Return the names of the operations of a step: one for each blade or channel, or one round the part."""
    if step.kind in ROUND_STEPS:
        return (step.name,)
    return _copy_names(step, impeller.definition.number * len(_kinds_of_blades(impeller)))


def _copy_names(step: MachiningStep, count: int) -> tuple[str, ...]:
    return tuple(f"{step.name}_{k}" for k in range(1, count + 1))


def _named(
    step: MachiningStep, copies: list[tuple[float, LinkedPath]]
) -> tuple[tuple[str, ...], tuple[LinkedPath, ...]]:
    """Names and paths of the copies of a step, by their angles about Z."""
    paths = tuple(path for _, path in sorted(copies, key=lambda each: each[0]))
    return _copy_names(step, len(paths)), paths


def _kept(step: MachiningStep, tool: LibraryTool, clearance: Sequence[PartClearance]) -> float:
    """Return the share of the wanted clearances that is kept.

    Raises ``InputError`` if not even the least is: with the place, what is in the way of which part of the tool, and
    what helps.
    """
    cutter, shank, holder, _ = step.clearance
    wanted = Wanted(cutter=cutter, shank=shank, holder=holder)
    for share in SHARES:
        margins = wanted.margins(share)
        least = {Role.CUTTER: margins.cutter, Role.SHANK: margins.shank, Role.HOLDER: margins.holder}
        missing = [one for one in clearance if one.distance < least[one.part]]
        if not missing:
            return share
    problems = []
    for one in missing:
        x, y, z = one.centre
        at: dict[str, object] = {"x": x, "y": y, "z": z, "distance": one.distance, "least": least[one.part]}
        wording = Wording("IMP323", _NOT_CLEAR[one.part], part=one.part, body=one.body, **at)
        problems.append(Problem(tool.name, 0, wording))
    raise InputError(problems)


def _links(step: MachiningStep) -> Links:
    longest = max(_LINK, _LINK_STEPS * step.stepover.distance)
    return Links(step.lead, step.clearance[3], longest, _THINNING_SHARE * step.tolerance)


def _outside(impeller: Impeller, radius: float) -> IsClear:
    """Whether a ball is outside of the form of the shroud; the end of a flat mill is where its path is."""
    heights, form = shroud_form(impeller)

    def is_clear(centre: Floats, _axis: Floats) -> Flags:
        if not radius:
            return np.ones(len(centre), np.bool_)
        across, up = np.hypot(centre[:, 0], centre[:, 1]), centre[:, 2]
        apart = np.hypot(across[:, None] - form, up[:, None] - heights).min(axis=1) >= radius - _NEAR
        beside = (up >= heights[-1]) | (across >= np.interp(up, heights, form))
        return np.asarray(apart & beside)

    return is_clear
