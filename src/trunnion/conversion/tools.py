"""The cutter of an operation, from the values in its header and the tool that the program calls."""

from trunnion.controls.definition import Control
from trunnion.conversion.settings import parse_number
from trunnion.model.toolpath import Tool


def build_tool(values: dict[str, str], called: str, control: Control) -> Tool:
    """Return the cutter of an operation.

    values   values of the header; gets the settings with which the tool is called as in the program
    called   the tool as the program calls it, by number or name; empty if it calls none
    """
    kinds = {text: kind for kind, text in control.tool_types.items()}
    kind = kinds.get(values.get("tool_type", ""), "UNKNOWN")
    diameter = parse_number(values.get("tool_diameter"))
    if kind == "BALL" or (kind == "UNKNOWN" and diameter):
        kind = "MILL"
    by_name = bool(called) and (not called.isdigit() or values.get("tool", "").startswith('"'))
    values.pop("tool", None)
    name = values.get("tool_name", "") or (called if by_name else "")
    if called:
        values["tool_call"] = "name" if by_name and name == called else "number"
    if by_name and name != called:
        values["tool"] = f'"{called}"'
    return Tool(
        kind=kind,
        name=name,
        diameter=diameter or 0.0,
        corner_radius=parse_number(values.get("tool_corner_radius")) or 0.0,
        length=parse_number(values.get("tool_length")) or 0.0,
    )
