"""Cures of messages about settings of posts, conversions and proofs."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569"
_WITHOUT_TCP: Final = "append ours.toml '[control]\\ntcp = false\\n'\ntrunnion post part.cls --machine ours.toml --set "
_SETTING_OF_SHOP: Final = (
    'append ours.toml \'[control.settings]\\npressure = 70\\nnote = "A"\\n'
    '[control.setting_rules.pressure]\\nkind = "number"\\n\'\n'
    "trunnion post part.cls --machine ours.toml --set "
)
_FASTEST: Final = "trunnion.verify('part.mpf', machine='yl569', cl='part.cls', feed='fastest', "


def _set(message: str, setting: str, cured: str, machine: str = "yl569") -> Cure:
    """A setting of a post, and what stands in its place."""
    return script(message, f"trunnion post part.cls --machine {machine} --set '{setting}'", f" --set '{setting}'",
                  cured and f" --set '{cured}'")  # fmt: skip


_TWO_OF_ONE_NAME: Final = (
    "cp part.cls two.cls\n" + _SETTING_OF_SHOP.replace("part.cls", "part.cls two.cls --output out.mpf") + "note=A,OP1:B"
)
_NUMBERED: Final = (
    "trunnion post part.cls two.cls --machine matsuura_mx330 --output out.nc --set first_number=9999 "
    "--set programs=operations"
)

CURES: Final = (
    _set("ARG210 unknown", "colour=1", "tolerance=0.02"),
    script("ARG210 not_of_proof", "trunnion verify part.mpf --machine yl569 --set numbers=on", " --set numbers=on", ""),
    script("ARG210 not_of_reading", "trunnion info part.cls --set spindle=500", " --set spindle=500", ""),
    script("ARG220 length_of_tool_missing",
           "trunnion reach part.cls --machine yl569 --step 30 --zero 0,0,0 --tool-length 2=110", "2=110", "2=110,1=85"),
    script("ARG220 mode_without_tcp", _WITHOUT_TCP + "mode=tcp", "mode=tcp", "mode=tilted"),
    script("ARG220 named_twice", "trunnion verify part.mpf --machine yl569 --tool-length 5=110,5=120", ",5=120", ""),
    script("ARG220 neither_text_nor_number", "trunnion.post('part.cls', machine='yl569', settings={'tolerance': [1]})",
           "[1]", "0.01"),
    script("ARG220 no_feed_limit", _FASTEST + "feed_limit='x')", "'x'", "500"),
    _set("ARG220 no_single_line", "spindle=1\t0", "spindle=500"),
    _set("ARG220 no_travel_left", "limit_margin=900", "limit_margin=1"),
    _set("ARG220 no_whole_number", "first_number=2.5", "first_number=2",
         "matsuura_mx330 --output out.nc --set programs=operations"),
    script("ARG220 no_work_offset", "trunnion verify part.mpf --machine yl569 --work-offset G99", "G99", "G54"),
    script("ARG220 no_work_offset", "trunnion verify part.mpf --machine yl569 --zero G99=0,0,0", "G99", "G54"),
    _set("ARG220 not_of_form", "clearance=x", "clearance=50"),
    script("ARG220 not_of_control", _SETTING_OF_SHOP + "pressure=x", "pressure=x", "pressure=40"),
    _set("ARG220 not_of_control_with_meaning", "orientation=x", "orientation=vector"),
    _set("ARG220 never_preselected", "preselect=on", "", "hs664rt"),
    script("ARG220 one_place", "trunnion place part.cls --machine yl569 --turn 0 --zero G54=0,0,0,G55=1,1,1",
           "G54=0,0,0,G55=1,1,1", "0,0,0"),
    script("ARG220 zero_of_no_offset",
           "trunnion reach part.cls --machine yl569 --step 30 --zero G54=0,0,0,G55=1,1,1 --tool-length 100",
           "G54=0,0,0,G55=1,1,1", "0,0,0"),
    _set("ARG230 cannot_differ", "program=A,OP1:B", "program=A"),
    _set("ARG230 no_operation", "mode=tcp,OP9:tilted", "mode=tcp,OP1:tilted"),
    script("ARG230 two_values_of_all_operations", _SETTING_OF_SHOP + "note=A,B,OP1:C", "A,B,", "A,"),
    _set("ARG250 no_subprograms", "programs=operations", "", "hs664rt"),
    script("ARG250 no_tcp", _WITHOUT_TCP + "tcp=on", "tcp=on", "tcp=off"),
    script("ARG250 no_m114", _WITHOUT_TCP + "tcp=m114", "tcp=m114", "tcp=off"),
    script("ARG250 file_without_number",
           "trunnion post part.cls --machine matsuura_mx330 --set program_from=file --output out.nc", "out.nc",
           "O1001.nc"),
    script("ARG270 operations_of_one_name", _TWO_OF_ONE_NAME, "cp part.cls two.cls\n", ""),
    _set("ARG220 too_small", "split=1", "split=100000", "yl569 --output out.mpf --set programs=operations"),
    script("ARG240 no_program_numbers", _NUMBERED, "=9999", "=1001"),
    script("ARG240 no_program_numbers", _NUMBERED, "first_number=9999 --set programs=operations", "programs=one"),
)  # fmt: skip
