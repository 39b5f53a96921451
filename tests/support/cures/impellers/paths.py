"""Cures of messages about the paths of an impeller's machining steps, drawn from the functions that lay them."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.impellers.definitions import IMPELLER, POINTS, written
from tests.support.cures.reading import ended
from tests.support.example_impellers import EXAMPLES
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.material import material_before, order_problems, side_problems
from trunnion.impeller.paths.blade_finish import BladeFinish, blade_finish
from trunnion.impeller.paths.channel import channels_of
from trunnion.impeller.paths.channel_families import hub_finish
from trunnion.impeller.paths.channel_sheets import Ball
from trunnion.impeller.paths.clearance import Margins, tool_body
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.paths.passes import Stepover, Way
from trunnion.impeller.paths.root_blend import RootBlend, root_blend
from trunnion.impeller.paths.shroud import stock_roughing
from trunnion.simulation.tools.profile import Role
from trunnion.simulation.tools.shapes import ball, flat

#: The published impeller with its operations.
WHOLE: Final = (EXAMPLES / "impeller.toml").read_text(encoding="utf-8")
_NOTHING: Final = Margins(0.0, 0.0, 0.0, 1.0)
_COARSE: Final = Stepover(distance=3.0)


@cache
def built(text: str) -> Impeller:
    """The impeller of a definition; a table of points may stand before it."""
    points, _, definition = text.rpartition("#END\n")
    with TemporaryDirectory() as folder:
        return build_impeller(read_impeller(written(definition, Path(folder), points or POINTS)))


def made_of(make: Callable[[Impeller], object]) -> Trial:
    """Return what makes something of the impeller of a definition."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        return ended(lambda: make(built(text)))

    return tried


def _judged(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Judge the order of the operations of a definition."""
    return Outcome(tuple(order_problems(built(text))), True)


def _beside(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Judge a shank 0.32 mm from the hub in the fourth operation."""
    impeller = built(text)
    step, before = impeller.definition.steps[3], material_before(impeller)[3]
    near = PartClearance(Role.SHANK, "the hub", 0.32, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    return Outcome(tuple(side_problems("part.toml", step, before, [near])), True)


def _other(code: str, variant: str, make: Callable[[Impeller], object], better: Callable[[Impeller], object]) -> Cure:
    """What cannot be made of the published impeller, and what the cure has made in its place."""
    return Cure(code, variant, made_of(make), IMPELLER, (), cured_by=made_of(better))


def _finish(radius: float, way: Way = Way.ONE_WAY) -> Callable[[Impeller], object]:
    return lambda one: blade_finish(one, one.blade, BladeFinish(radius, _COARSE, way, tolerance=0.5))


def _hub(radius: float, allowance: float = 0.0) -> Callable[[Impeller], object]:
    return lambda one: hub_finish(channels_of(one)[0], Ball(radius, 0.05, allowance, allowance), _COARSE)


def _rough(step_down: float = 6.0, stepover: float = 15.0, allowance: float = 0.3) -> Callable[[Impeller], object]:
    return lambda one: stock_roughing(one, 10.0, step_down, stepover, allowance, 0.05)


def _blend(radius: float) -> Callable[[Impeller], object]:
    return lambda one: root_blend(one, one.blade, RootBlend(radius, _COARSE, 3.0, radius, tolerance=0.5))


def _order(variant: str, text: str, *changes: tuple[str, str], code: str = "IMP332") -> Cure:
    return Cure(code, variant, _judged, text, changes)


def _operation(kind: str) -> str:
    """The table of an operation of the published impeller."""
    first = WHOLE.index(f'[[operation]]\nkind = "{kind}"')
    end = WHOLE.find("[[operation]]", first + 1)
    return WHOLE[first : end if end > 0 else len(WHOLE)]


_STOCK_ROUGH, _CHANNEL_ROUGH = _operation("stock roughing"), _operation("channel roughing")
_STOCK_FINISH, _HUB_FINISH = _operation("stock finishing"), _operation("hub finish")

#: The tip rises again at the outlet.
_RISING: Final = f"{POINTS.replace('59.049,10.469,14.851', '59.049,10.469,17.5')}#END\n{IMPELLER}"

CURES: Final = (
    _other("IMP320", "ball_radius_mm", _blend(2.5), _blend(2.0)),
    _other("IMP320", "ball_radius_mm_cuts_mm", _finish(5.0), _finish(2.04)),
    _other("IMP320", "ball_smaller_than_fillet", _hub(1.9), _hub(3.0)),
    _other("IMP320", "ball_smaller_than_fillet", _hub(1.9), _hub(1.9, 0.2)),
    _other("IMP320", "ball_does_not_fit", _hub(7.5), _hub(3.0)),
    _other("IMP320", "no_ball_fits", _hub(3.0, 12.0), _hub(3.0, 0.3)),
    _other(
        "IMP321",
        "no_ball_radius",
        lambda _: tool_body(flat(4.0), 2.0, _NOTHING),
        lambda _: tool_body(ball(4.0), 2.0, _NOTHING),
    ),
    _other(
        "IMP326", "cutter_radius_over", lambda _: FlankCutter(0.0, 0.0, 10.0), lambda _: FlankCutter(2.0, 0.0, 10.0)
    ),
    _other("IMP326", "cutter_radius_over", lambda _: FlankCutter(2.0, 1.0, 9.0), lambda _: FlankCutter(2.0, 0.1, 9.0)),
    _other("IMP327", "spiral_trailing_edge", _finish(2.0, Way.SPIRAL), _finish(2.0, Way.BOTH_WAYS)),
    _other("IMP328", "turns_have_million", _rough(step_down=1e-7), _rough(step_down=1.5)),
    _other("IMP328", "turns_have_million", _rough(stepover=1e-9), _rough()),
    _order(
        "up_mm_metal",
        WHOLE.replace(_STOCK_ROUGH, "").replace(_CHANNEL_ROUGH, _STOCK_ROUGH + _CHANNEL_ROUGH),
        (_STOCK_ROUGH, ""),
        (_STOCK_FINISH, _STOCK_ROUGH + _STOCK_FINISH),
    ),
    _order(
        "up_mm_metal_stand",
        WHOLE.replace(_CHANNEL_ROUGH, "").replace(_HUB_FINISH, _HUB_FINISH + _CHANNEL_ROUGH),
        (_CHANNEL_ROUGH, ""),
        (_HUB_FINISH, _CHANNEL_ROUGH + _HUB_FINISH),
    ),
    _order("up_mm_metal_stand_outside", WHOLE.replace(_STOCK_ROUGH, ""), (_STOCK_FINISH, _STOCK_ROUGH + _STOCK_FINISH)),
    _order(
        "up_mm_metal_stand_outside",
        WHOLE.replace(_STOCK_ROUGH, ""),
        ("[stock]\n", '[stock]\npremachined = ["stock roughing"]\n'),
    ),
    _order("up_mm_metal_stand_hub", WHOLE.replace(_CHANNEL_ROUGH, ""), (_HUB_FINISH, _CHANNEL_ROUGH + _HUB_FINISH)),
    _order(
        "up_mm_metal_stand_hub",
        WHOLE.replace(_CHANNEL_ROUGH, ""),
        ("[stock]\n", '[stock]\npremachined = ["channel roughing"]\n'),
    ),
    _order(
        "up_mm_metal_stand_hub_between",
        WHOLE.replace("hub_allowance_mm = 0.3", "hub_allowance_mm = 4.0", 1),
        ("hub_allowance_mm = 4.0", "hub_allowance_mm = 0.3"),
    ),
    _order(
        "up_mm",
        WHOLE.replace("allowance_mm = 0.5", "allowance_mm = 8.0", 1),
        ("allowance_mm = 8.0", "allowance_mm = 0.5"),
    ),
    _order(
        "step_down_mm",
        WHOLE.replace("step_down_mm = 1.5", "step_down_mm = 39", 1),
        ("step_down_mm = 39", "step_down_mm = 1.5"),
        code="IMP331",
    ),
    Cure(
        "IMP333",
        "comes_near_mm",
        _beside,
        WHOLE,
        (("hub_allowance_mm = 0.3", "hub_allowance_mm = 0.1"), ("\nallowance_mm = 0.3", "\nallowance_mm = 0.1")),
    ),
    _other("IMP327", "no_stock_stands", _rough(allowance=60.0), lambda _: None),
    Cure("IMP327", "shroud_rises_towards", made_of(_rough()), _RISING, (), cured_by=made_of(lambda _: None)),
    Cure(
        "IMP320",
        "ball_radius_mm_cuts",
        made_of(_finish(2.0)),
        IMPELLER.replace("fillet_mm = 2.0", "fillet_mm = 4.0"),
        (("fillet_mm = 4.0", "fillet_mm = 2.0"),),
    ),
)
