"""The capabilities of a control for the planner, from its definition and the settings of a run."""

import math
from collections.abc import Mapping
from typing import Final

from trunnion.controls import Control
from trunnion.controls.vocabulary import LINES_FOR_SPLINES, SPLINES_SETTING, UNKNOWN_FEED
from trunnion.model.motion import MachiningMode
from trunnion.model.splines import Spline
from trunnion.output.validation import unsupported_cycle_reasons
from trunnion.planning import ControlCapabilities

#: What lets a control move without TCP if its definition does not state what F counts there.
_FEED_REMEDY: Final = (
    'write feed_without_tcp = "all_axes" or "slides", what F counts while rotary axes turn, under [control] and under'
    " [control.reading] of the machine's definition, if you know it; or post with TCP"
)


def control_capabilities(control: Control, settings: Mapping[str, str]) -> ControlCapabilities:
    """Return what the control can do under the settings of a run."""
    return ControlCapabilities(
        modes=control.modes(settings),
        mode_remedies={MachiningMode.WITHOUT_TCP: _FEED_REMEDY} if control.feed_without_tcp == UNKNOWN_FEED else {},
        negligible_tilt=_negligible_tilt(control),
        only_arcs_about_z=control.arcs.only_about_z,
        helices=control.arcs.helices,
        helices_by_angle="arc_angle" in control.family.WORDS,
        multi_turn_arcs=control.arcs.multi_turn,
        arcs_with_tcp=not (control.vectors_exclude_angles and control.uses_tool_vectors(settings)),
        planes_from_pose=control.plane_from_pose,
        plane_x_from_machine=control.plane_x_from_machine,
        turns_between_holes=control.turns_between_holes(settings),
        cycle_objection=unsupported_cycle_reasons(control, settings),
        takes_spline=_takes_no_spline if _lines_for_splines(control, settings) else control.family.takes_spline,
    )


def _lines_for_splines(control: Control, settings: Mapping[str, str]) -> bool:
    """Whether all splines become lines: as the settings ask, or because rows must fill files of a size."""
    written = {**control.settings, **settings}.get(SPLINES_SETTING, LINES_FOR_SPLINES)
    return written == LINES_FOR_SPLINES or "split" in settings


def _takes_no_spline(spline: Spline) -> bool:
    return False


def _negligible_tilt(control: Control) -> float:
    """Sine of half the last digit of a rotary word."""
    name = next(word.format for word in control.words if word.name == "primary")
    return math.sin(math.radians(0.5 * 10.0 ** -control.number_formats(three_axis=False)[name].decimals))
