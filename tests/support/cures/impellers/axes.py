"""Cures of messages about tool axes between plates, and about the ways of a tool to its passes and from them."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final
from unittest.mock import patch

import numpy as np

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.impellers.definitions import IMPELLER, MIXED
from tests.support.cures.impellers.paths import WHOLE, built, made_of
from tests.support.cures.reading import ended
from tests.support.plates import bent_slot, floor, necked, slot
from trunnion.arrays import Flags, Floats
from trunnion.impeller import machining
from trunnion.impeller.definition import StockSize
from trunnion.impeller.flank import blade_flank
from trunnion.impeller.flank.blade_flank import BladeFlank
from trunnion.impeller.impeller import rotated
from trunnion.impeller.machining import StepPaths
from trunnion.impeller.paths import axis_field, tool_axes
from trunnion.impeller.paths.around import side_end
from trunnion.impeller.paths.channel_sheets import Ball, sheets_of
from trunnion.impeller.paths.clear_poses import pose_check
from trunnion.impeller.paths.clearance import Margins, Obstacles, tool_body
from trunnion.impeller.paths.least_clearances import least_clearances
from trunnion.impeller.paths.linking import FreeSpace, Links, Surroundings, link_passes
from trunnion.impeller.paths.passes import PassFamily
from trunnion.impeller.paths.tool_axes import Wanted, choose_axes
from trunnion.impeller.steps import StepKind
from trunnion.jobs.impeller import cutting
from trunnion.simulation.tools.profile import ToolShape


def _chosen(family: PassFamily, *given: Any, **how: Any) -> Trial:
    """Return what chooses the axes of a tool between plates, and asks few places and directions why there are none."""

    @cache
    def outcome() -> Outcome:
        with patch.multiple(tool_axes, SHARES=(1.0,), _DIRECTIONS=64, _ASKED=1):
            return ended(lambda: choose_axes(family, *given, **how))

    return lambda text, settings, folder: outcome()


def _sideways(axes: Floats) -> Flags:
    """Which axes a machine reaches that can only cut from the side."""
    return np.asarray(np.abs(axes[:, 2]) < 0.1)


_NOTHING: Final = Margins(0.0, 0.0, 0.0, 1.0)
_LEANS: Final = Wanted(tilt=30.0)
_LITTLE: Final = Wanted(0.1, 0.1, 0.2, 0.05, 1.0, tilt=60.0)
_SLOT: Final = slot(6.0, 60.0)
_FITS: Final = _chosen(floor(1.0), necked(4.0, 25.0, 75.0), _SLOT, _LEANS)


def _searched(wanted: Wanted) -> Trial:
    """Return what chooses axes in a slot within fewer iterations than are allowed, so that they can run out."""
    attempts = (("highs-ipm", {"maxiter": 15}),)

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with (
            patch.multiple(tool_axes, SHARES=(1.0,), _DIRECTIONS=256, _ASKED=1),
            patch.object(axis_field, "INTERIOR_POINT", attempts),
        ):
            return ended(lambda: choose_axes(floor(1.0), necked(4.0, 25.0, 75.0), _SLOT, wanted))

    return tried


def _bent(length: float) -> Trial:
    """Return what chooses axes for so much of the floor of a slot whose sides lean to the other side half-way."""
    return _chosen(floor(0.2, length=length), necked(4.0, 25.0, 75.0), bent_slot(6.0, 60.0, 20.0), Wanted(tilt=60.0))


def _blocked(variant: str, tool: ToolShape, plates: Obstacles, code: str = "IMP323", **how: Any) -> Cure:
    """A tool that finds no room, and a longer and thinner one in a wide slot that does."""
    return Cure(code, variant, _chosen(floor(0.2), tool, plates, _LEANS, **how), "", (), cured_by=_FITS)


def _milled(tool: ToolShape, plates: Obstacles, radius: float = 2.0) -> Trial:
    """Return what holds a tool that mills a flank against what is beside it: its clearances are measured."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        step, family = built(WHOLE).definition.steps[-1], floor(0.2, 1)
        own, body = built(WHOLE).definition.tools[-1], tool_body(tool, radius, _NOTHING)
        axes = np.tile([0.0, 0.0, 1.0], (len(family.centres()), 1))
        return ended(lambda: machining._kept(step, own, least_clearances(plates, body, family.centres(), axes)))

    return tried


def _flank(variant: str, tool: ToolShape, better: ToolShape, plates: Obstacles, radius: float = 2.0) -> Cure:
    return Cure("IMP323", variant, _milled(tool, plates, radius), "", (), cured_by=_milled(better, plates))


def _linked(tool: ToolShape) -> Trial:
    """Return what leads a tool to its passes between two plates."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        family, is_clear = floor(0.2, 1), pose_check(slot(3.0, 30.0), tool, 2.0, 0.01)
        axes = [np.tile([0.0, 0.0, 1.0], (len(each.centre), 1)) for each in family.passes]
        space = FreeSpace.around(
            StockSize(90.0, 35.0, 0.0, 0.0), 2.0, 2.0, np.array([[3.0, 40.0]]), np.concatenate(axes)
        )
        around = Surroundings(space, is_clear, "BLADE_FINISH")
        return ended(lambda: link_passes(family.passes, axes, around, Links(0.0, 2.0, 3.0, 0.01), 2.0))

    return tried


def _between_blades(radius: float) -> Trial:
    """Return what mills the flank of a blade with a cutter whose axis goes through the middle of a channel."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        impeller = built(IMPELLER)
        points = rotated(impeller.blade.sides(np.array([0.5]), np.array([0.5]), 1.0)[0], np.pi / 6.0)
        neighbour = blade_flank._neighbour(impeller, impeller.blade, points, np.array([radius]))
        line = np.linspace([0.0, 0.0, 0.0], [9.0, 0.0, 0.0], 500)
        path = SimpleNamespace(poses=lambda at: (line[: len(at)], np.tile([0.0, 0.0, 1.0], (len(at), 1))))
        cut: Any = SimpleNamespace(path=path)
        return ended(lambda: BladeFlank(cut, 1.0, 1.0, 0.0, neighbour).as_pass())

    return tried


def _layered(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Look at a channel that is roughed in one layer with a ball of 3 mm."""
    impeller = built(text)
    step = next(each for each in impeller.definition.steps if each.kind is StepKind.CHANNEL_ROUGHING)
    paths = StepPaths(step, impeller.definition.tools[-1], 3.0, (), (), families=(floor(0.2),))
    return Outcome(tuple(cutting._one_layer("part.toml", paths)), True)


def _shared(tool: ToolShape) -> Trial:
    """Return what says how much of the clearances of a step a tool keeps beside plates."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        impeller, family = built(WHOLE), floor(0.2, 1)
        step, own = impeller.definition.steps[-1], impeller.definition.tools[-1]
        axes = np.tile([0.0, 0.0, 1.0], (len(family.centres()), 1))
        body = tool_body(tool, 2.0, _NOTHING)
        share = machining._kept(step, own, least_clearances(slot(3.2, 30.0), body, family.centres(), axes))
        paths = StepPaths(step, own, 2.0, (), (), share=share)
        return Outcome((cutting._shared("part.toml", paths),) if share < 1.0 else (), True)

    return tried


def _trailing(reach: float) -> Trial:
    """Return what looks how far sides go for a ball whose centre is so far from the blade."""
    return made_of(lambda one: side_end(one, one.blade, reach))


def _sheets(allowance: float = 0.3) -> Trial:
    return made_of(lambda one: sheets_of(one, Ball(3.0, 0.05, 0.3, allowance), None))


_CUT: Final = 'trailing_edge = "cut"'
_WIDE: Final = (
    MIXED.replace("bottom_mm = -4.0", "bottom_mm = -200.0")
    .replace("height_mm = 42.0", "height_mm = 238.0")
    .replace("diameter_mm = 108.0", "diameter_mm = 300.0")
)
_ROUGH: Final = WHOLE.replace("step_down_mm = 1.0", "step_down_mm = 19")
_TALL: Final = IMPELLER.replace("height_mm = 35.0", "height_mm = 200.0\nbottom_mm = -100.0")

CURES: Final = (
    _blocked("no_tool_axis", necked(4.0, 25.0), _SLOT, "IMP322", reachable=_sideways),
    _blocked("cutter_not_clear", necked(4.0, 25.0), slot(2.05, 20.0)),
    _blocked("shank_not_clear", necked(4.0, 12.0), slot(2.6, 40.0)),
    _blocked("holder_not_clear", necked(4.0, 25.0, 30.0), _SLOT),
    _flank("flank_cutter_not_clear", necked(6.4, 25.0), necked(4.0, 35.0), slot(3.0, 30.0), 3.2),
    _flank("flank_shank_not_clear", necked(4.0, 12.0), necked(4.0, 35.0), slot(2.9, 30.0)),
    _flank("flank_holder_not_clear", necked(4.0, 25.0, 30.0), necked(4.0, 25.0, 75.0), slot(6.0, 60.0)),
    Cure("IMP325", "tool_cannot_pass", _linked(necked(4.0, 12.0)), "", (), cured_by=_linked(necked(4.0, 35.0))),
    Cure("IMP326", "cutter_does_not", _between_blades(30.0), "", (), cured_by=_between_blades(2.0)),
    Cure(
        "IMP326",
        "ball_radius_mm",
        made_of(lambda one: blade_flank._until(one, one.blade, 1.0, 40.0)),
        IMPELLER,
        (),
        cured_by=made_of(lambda one: blade_flank._until(one, one.blade, 1.0, 2.0)),
    ),
    Cure("IMP327", "no_stock_between_blades", _sheets(25.0), IMPELLER, (), cured_by=_sheets()),
    Cure("IMP327", "no_way_out_at_inlet", _sheets(), _TALL, ((_TALL, IMPELLER),)),
    Cure("IMP327", "no_way_out_at_outlet", _sheets(), _WIDE, ((_WIDE, MIXED),)),
    Cure("IMP327", "ball_does_not", _trailing(60.0), IMPELLER, ((_CUT, _CUT.replace("cut", "round")),)),
    Cure("IMP324", "tool_axes_clear", _bent(40.0), "", (), cured_by=_bent(12.0)),
    Cure("IMP324", "no_smooth_field", _searched(_LEANS), "", (), cured_by=_searched(_LITTLE)),
    Cure("IMP330", "clearances_kept_in_part", _shared(necked(4.0, 20.0)), "", (), cured_by=_shared(necked(4.0, 35.0))),
    Cure("IMP331", "whole_depth_in_one_layer", _layered, _ROUGH, (("step_down_mm = 19", "step_down_mm = 1.0"),)),
)
