"""Functions at places of output, for what published posts have custom commands: post … --hooks shop_texts.py."""

from trunnion.hooks import Place


def at_tool_change(place: Place) -> list[str]:
    """Say the tool and its diameter behind its call."""
    return [*place.lines, f";TOOL {place.tool.call} D{place.tool.diameter:g}"]


def at_first_cut(place: Place) -> str:
    """Say how long the operation cuts."""
    return f";CUTS {place.operation.name} FOR {place.operation.time}"
