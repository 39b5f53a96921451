"""What a program is expected to be by its settings, where its CL files leave it open.

Posts and verifications ask the same function; each adds what it alone knows.
"""

import math
from collections.abc import Mapping
from typing import Final

from trunnion.compensation.stretches import RegisterValue
from trunnion.controls import Control
from trunnion.controls.vocabulary import PROGRAM_CHOICES, RADIUS_REGISTER_SETTING
from trunnion.jobs.inputs.control_settings import greatest_feed
from trunnion.jobs.inputs.settings import m_code, work_offset_setting
from trunnion.machines import Machine
from trunnion.model.axis_tolerance import AxisTolerance
from trunnion.verification import ExpectedValues, OperationSettings

#: Settings for the tolerance of the control's own smoothing, and for what tool calls add to the tool, by their words.
_SMOOTHING: Final = ("tolerance", "three_axis_tolerance", "fallback_tolerance")
_TOOL_DELTAS: Final = {"delta_length": "DL", "delta_radius": "DR"}


def expected_values(
    control: Control | None,
    machine: Machine,
    settings: Mapping[str, str],
    own_settings: Mapping[str, Mapping[str, str]],
) -> ExpectedValues:
    """Return what a program is expected to be.

    control       None: programs for the machine can be read but not written
    machine       runs the program
    settings      in force in it. Without a work offset or an edge, it may have any
    own_settings  in force in single operations, by their names

    Raises ``InputError`` if a work offset is none of the control's.
    """
    every = _operation_settings(settings, machine, control)
    everywhere = (settings, *own_settings.values())
    rapid_feed = float(settings["rapid_feed"]) if settings.get("rapid_feed") else None
    inverse_time = control.formats.get("inverse_time") if control else None
    slower = None if rapid_feed is None or control is None else rapid_feed - control.formats["feed"].five_axis.digit
    return ExpectedValues(
        tool=every.tool,
        work_offset=every.work_offset,
        edge=every.edge,
        radius_offset=every.radius_offset,
        register_holds=RegisterValue(settings.get(RADIUS_REGISTER_SETTING) or RegisterValue.UNKNOWN),
        last_edge=every.last_edge,
        by_operation={name: _operation_settings(own, machine, control) for name, own in own_settings.items()},
        swivel_data=tuple({each["swivel_data"] for each in everywhere if "swivel_data" in each}),
        rapid_feed=rapid_feed,
        max_feed=greatest_feed(control),
        max_inverse_time_feed=inverse_time.five_axis.greatest if inverse_time else None,
        clearance=float(settings["operation_clearance"]) if settings.get("same_tool") == "clearance" else None,
        operation_clearance=float(settings.get("operation_clearance") or math.inf),
        in_turn=settings.get("first_approach") == "in_turn",
        stop_between=settings.get("stop_between") == "on",
        below_rapid_feed=slower,
        coolant=control.coolant if control else {},
        has_settings=frozenset((*control.settings, *PROGRAM_CHOICES) if control else ()),
        smoothing=max(float(each.get(key) or 0.0) for each in everywhere for key in _SMOOTHING),
        tool_deltas={
            word: tuple({_as_printed(control, key, float(each[key])) for each in everywhere if each.get(key)})
            for key, word in _TOOL_DELTAS.items()
        },
        rigid_tap=m_code(settings.get("rigid_tap", "")),
        blocks_in_compensation=control.blocks_in_compensation if control else 1,
        stops_in_compensation=control.stops_in_compensation if control else False,
        texts=tuple(line for each in control.templates.values() for line in each.pattern_lines()) if control else (),
        axis_tolerance=control.axis_tolerance if control else AxisTolerance(),
    )


def _operation_settings(settings: Mapping[str, str], machine: Machine, control: Control | None) -> OperationSettings:
    """Tool, work offset, edge and register of the radius as settings give them."""
    offset = work_offset_setting(settings["work_offset"], machine) if "work_offset" in settings else None
    edge = int(settings["edge"]) if "edge" in settings else None
    radius_offset = int(settings.get("radius_offset") or 0)
    by_register = control is not None and settings.get("edge_from") == "adjust"
    last_edge = int(control.setting_rule("edge").at_most or 0) if control and by_register else 0
    return OperationSettings(settings.get("tool", "").strip('"'), offset, edge, radius_offset, last_edge)


def _as_printed(control: Control | None, name: str, value: float) -> float:
    """Return a setting as the digits of its templates print it."""
    if control is None:
        return value
    fields = {field for template in control.templates.values() for field in template.fields()}
    formats = [
        control.formats[number_format] for field, number_format in sorted(fields) if field == name and number_format
    ]
    return formats[0].three_axis.rounded(value) if formats else value
