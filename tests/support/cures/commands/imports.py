"""Cures of messages about posts and machine data of others."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Cure, Outcome
from tests.support.cures.reading import ended, limited
from tests.support.cures.scripts import script
from trunnion.foreign import machine as foreign
from trunnion.foreign.nx_post import read_nx_post

_LINES: Final = (
    'set mom_kin_machine_type "5_axis_dual_table"\\nset mom_kin_output_unit "MM"\\nset mom_kin_4th_axis_leader "B"\\n'
    'set mom_kin_4th_axis_plane "ZX"\\nset mom_kin_5th_axis_leader "C"\\nset mom_kin_5th_axis_plane "XY"\\n'
)
_RUN: Final = "trunnion import mill.tcl --output ours"
_POST: Final = f"write mill.tcl '{_LINES}'\n{_RUN}"
_DATA: Final = (
    "write nck.arc '$MA_POS_LIMIT_MINUS[AX1]=-250\\n$MA_POS_LIMIT_PLUS[AX1]=250\\n'\n"
    "trunnion import nck.arc --like yl569 --output ours"
)
_PST: Final = "write mill.pst 'fs2 2 0.4 0.3\\nfmt X 2 xabs\\nsg00 G0\\n'"
_LIKE: Final = " --like yl569 --output ours"
_KIND: Final = 'set mom_kin_machine_type "5_axis_dual_table"\\n'
_LETTER: Final = 'set mom_kin_4th_axis_leader "B"\\n'
_TCL: Final = _LINES.replace("\\n", "\n")


def _read(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    (folder / "mill.tcl").write_text(text, encoding="utf-8")
    return ended(lambda: read_nx_post([folder / "mill.tcl"]))


CURES: Final = (
    script("DEF610 unreadable", f"write mill.tcl '{_LINES}'\ntrunnion import will.tcl --output ours", "will", "mill"),
    Cure("DEF610", "no_text", _read, f"\0{_TCL}", (("\0", ""),)),
    Cure("DEF610", "too_large", limited(_read, foreign, "MOST_BYTES", 400), f"{_TCL}{' ' * 400}", ((" " * 400, ""),)),
    script("DEF620 no_kinematics", _POST.replace(_KIND, ""), "'set", f"'{_KIND}set"),
    script("DEF620 other_kind", _POST.replace("5_axis_dual_table", "3_axis_mill"), "3_axis_mill", "5_axis_dual_table"),
    script("DEF620 no_letter", _POST.replace(_LETTER, ""), "'set", f"'{_LETTER}set"),
    script("DEF620 one_letter", _POST.replace('5th_axis_leader "C"', '5th_axis_leader "B"'),
           '5th_axis_leader "B"', '5th_axis_leader "C"'),
    script("DEF630 no_data_of_axes", _DATA.replace("$MA_POS_LIMIT", "$MA_OTHER"), "$MA_OTHER", "$MA_POS_LIMIT"),
    script("DEF630 inches", _DATA.replace("'$MA_POS", "'$MN_SCALING_SYSTEM_IS_METRIC=0\\n$MA_POS", 1),
           "METRIC=0", "METRIC=1"),
    script("DEF640 no_such_machine", _POST.replace('4th_axis_leader "B"', '4th_axis_leader "W"'),
           " --output", " --like yl569 --output"),
    script("DEF610 encrypted", f"{_PST}\nwrite mill.psb 'x'\ntrunnion import mill.psb{_LIKE}", "import mill.psb",
           "import mill.pst"),
    script("DEF635 no_post", f"write none.pst '# nothing'\n{_PST}\ntrunnion import none.pst{_LIKE}", "import none",
           "import mill"),
    script("DEF650 unknown_files", _POST.replace("mill.tcl", "mill.cps"), "mill.cps", "mill.tcl"),
)  # fmt: skip
