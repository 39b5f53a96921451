"""Functions at places of output, for what published posts have custom commands: post … --hooks shop_texts.py."""


def at_tool_change(place):
    """The tool and its diameter stand behind its call."""
    return [*place.lines, f";TOOL {place.tool.call} D{place.tool.diameter:g}"]


def at_first_cut(place):
    """Each operation says how long it takes."""
    return f";CUTS {place.operation.name} FOR {place.operation.time}"
