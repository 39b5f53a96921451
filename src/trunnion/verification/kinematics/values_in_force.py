"""Which tool's length, and which work offset's zero, the position of an axis stands on, in words."""

from trunnion.model.run import Run


def values_in_force(run: Run, column: int, row: int) -> str:
    """Return what is in force in a row and counts in an axis; empty where all tools and work offsets are alike."""
    if run.setups is None or run.machine.axes[column].is_rotary:
        return ""
    setup, every = run.setups.at(row), run.setups.each
    length, said = setup.machine.tool_length, ""
    lengths = {each.machine.tool_length for each in every}
    if length is not None and (len(lengths) > 1 or setup.length_source) and run.machine.depends_on_length(column):
        tool = f"tool {setup.tool}" if setup.tool else "a tool"
        said += f" with {tool} of {length:g} mm{setup.length_source and f' ({setup.length_source})'}"
    if setup.work_offset and len({each.machine.workpiece_zero for each in every}) > 1:
        said += f" in {run.work_offset_name(setup.work_offset)}"
    return said
