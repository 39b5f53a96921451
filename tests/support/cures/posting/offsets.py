"""Cures of messages about programs that are posted: the work offsets that operations of CL files state."""

from typing import Final

from tests.support.cures.cure import Cure, marked, post
from tests.support.cures.posting.rows import on_machine

_HEAD: Final = "$$-> TRUNNION / 1\nUNITS/MM\n"
_CUT: Final = (
    "LOADTL/4", "SPINDL/RPM,5000,CLW", "RAPID", "GOTO/0,0,50", "FEDRAT/MMPM,500", "GOTO/0,0,0", "RAPID", "GOTO/0,0,50",
    "END-OF-PATH",
)  # fmt: skip
_TOOL: Final = "$$-> TOOL / MILL,DIAMETER,10,LENGTH,60"
_SECOND: Final = "$$-> WORK-OFFSET / 2"

#: A program that ends with its only work offset.
_OF_PROGRAM: Final = """extends = "yl569"
[control.templates]
program_end = '''
;{work_offset}
M30
'''
"""

CURES: Final[tuple[Cure, ...]] = (
    marked("CL490 not_so_many", post(), "TOOL PATH/A,TOOL,B", _TOOL, "- $$-> WORK-OFFSET / 100", f"+ {_SECOND}", *_CUT,
           head=_HEAD, foot="FINI\n"),
    marked("CL490 none_by_operation", on_machine(_OF_PROGRAM), "TOOL PATH/A,TOOL,B", _TOOL, f"- {_SECOND}", *_CUT,
           head=_HEAD, foot="FINI\n"),
    marked("CL490 two_of_one_name", post(), "TOOL PATH/A,TOOL,B", _TOOL, _SECOND, *_CUT,
           "- TOOL PATH/A,TOOL,B", "+ TOOL PATH/C,TOOL,B", _TOOL, "$$-> WORK-OFFSET / 1", *_CUT, head=_HEAD,
           foot="FINI\n"),
    Cure("CL495", "setting_wins", post(), "\n".join((_HEAD + "TOOL PATH/A,TOOL,B", _TOOL, _SECOND, *_CUT, "FINI\n")),
         ({"work_offset": None},), {"work_offset": "A:G54"}),
)  # fmt: skip
