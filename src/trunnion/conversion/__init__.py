"""Conversion of NC programs into toolpaths, from what the reader found about them."""

from trunnion.conversion.length_words import TOOL, unsaid_positions, unsaid_registers, with_registers
from trunnion.conversion.machine_words import carry_machine_words
from trunnion.conversion.notices import take_notices, with_whole_notices
from trunnion.conversion.settings import transfer_settings
from trunnion.conversion.toolpath_builder import Conversion, convert
from trunnion.conversion.work_offsets import carry_work_offset

__all__ = [
    "TOOL",
    "Conversion",
    "carry_machine_words",
    "carry_work_offset",
    "convert",
    "take_notices",
    "transfer_settings",
    "unsaid_positions",
    "unsaid_registers",
    "with_registers",
    "with_whole_notices",
]
