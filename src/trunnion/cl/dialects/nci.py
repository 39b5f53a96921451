"""Mastercam NCI: pairs of lines, the code of a record and below it its values."""

from collections.abc import Mapping
from typing import Final

from trunnion.cl.builder import NoAxis
from trunnion.cl.conventions import CycleWords
from trunnion.cl.dialect import Dialect, Handler, marks
from trunnion.cl.pair_scan import scan_pairs
from trunnion.cl.pair_statement import PARAMETERS, TOOL_LENGTHS, TOOL_NAME, parse_pair
from trunnion.cl.statements import nci_cycles, nci_motion, nci_records
from trunnion.cl.text_format import TextFormat

_UNREAD: Final = ("1016", "1017", "1020", *PARAMETERS.values())

_HANDLERS: Final[Mapping[str, Handler]] = {
    **dict.fromkeys(_UNREAD, nci_records.unread),
    **dict.fromkeys(("0", "1"), nci_motion.line),
    **dict.fromkeys(("2", "3"), nci_motion.arc),
    "4": nci_motion.dwell,
    "11": nci_motion.five_axis,
    "80": nci_cycles.end,
    "81": nci_cycles.begin,
    "100": nci_cycles.repeat,
    **dict.fromkeys(("200", "201"), nci_records.lathe),
    **dict.fromkeys(("1000", "1001", "1002"), nci_records.tool_change),
    "1003": nci_records.end_of_file,
    "1004": nci_motion.compensation_off,
    **dict.fromkeys(("1005", "1007"), nci_records.comment),
    "1006": nci_records.literal,
    "1008": nci_records.operation_comment,
    **dict.fromkeys(("1011", "1012"), nci_records.miscellaneous),
    "1013": nci_records.cutter,
    "1014": nci_records.tool_plane,
    **dict.fromkeys(("1018", "1019"), nci_records.subprogram),
    "1025": nci_records.canned_text,
    "1027": nci_records.work_system,
    "1050": nci_records.header,
    TOOL_NAME: nci_records.tool_name,
    TOOL_LENGTHS: nci_records.tool_lengths,
}

NCI: Final = Dialect(
    name="nci",
    title="Mastercam NCI",
    marks=marks(rb"1050[ \t]*\Z"),
    handlers=_HANDLERS,
    text=TextFormat(scan_pairs, parse_pair, "the file ends after the code of a record"),
    cycles=CycleWords({}),
    end="record 1003",
    no_axis=NoAxis.UPRIGHT,
)
