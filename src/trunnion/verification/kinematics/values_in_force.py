"""Which tool's length, and which work offset's zero, the position of an axis stands on."""

from trunnion.messages import Wording
from trunnion.model.run import Run


def with_values_in_force(at: Wording, run: Run, column: int, row: int) -> Wording:
    """Return a position with what is in force in a row and counts in an axis, unless all tools and work offsets are
    alike.
    """
    if run.setups is None or run.machine.axes[column].is_rotary:
        return at
    setup, every = run.setups.at(row), run.setups.each
    length, source = setup.machine.tool_length, setup.length_source
    lengths = {each.machine.tool_length for each in every}
    if length is not None and (len(lengths) > 1 or source) and run.machine.depends_on_length(column):
        named, other = ("at_with_tool_of", "at_with_a_tool_of") if source else ("at_with_tool", "at_with_a_tool")
        at = Wording("travel", named if setup.tool else other, at=at, tool=setup.tool, length=length, source=source)
    if setup.work_offset and len({each.machine.workpiece_zero for each in every}) > 1:
        at = Wording("travel", "at_in_offset", at=at, offset=run.work_offset_name(setup.work_offset))
    return at
