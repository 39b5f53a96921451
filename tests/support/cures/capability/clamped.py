"""Cures of messages about places of a part: what heads of programs say of it, and the bodies that it stands among."""

from typing import Final

from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569"
_TURNED: Final = f"{_POST} --turn 30 --output q.mpf"
_AT_ZERO: Final = f"{_POST} --turn 30 --set zero=10,-5,-60 --set tool_length=120 --output q.mpf"
_CLAMPED: Final = (
    f"{_TURNED}\ntrunnion convert q.mpf --machine yl569 --to-cl --output c.cls\n"
    "trunnion post c.cls --machine yl569 --turn 15 --output t.mpf"
)
_COMPARED: Final = "trunnion verify q.mpf --machine yl569 --cl part.cls"
_PLACE: Final = "trunnion place part.cls --machine yl569 --turn 0"
_SIMULATED: Final = (
    "trunnion simulate q.mpf --machine yl569 --stock box:40,40,10,-20,-20,-4 --cell 2 "
    "--tool 1=flat:10,length=60,flutes=30"
)
_NOTICE: Final = "$$ PART TURNED 45 DEG ABOUT Z, CLOCKWISE SEEN FROM ABOVE, FROM +Z"
_IN_CL: Final = f'edit part.cls ^ "{_NOTICE}\\n"\ntrunnion info part.cls'
_DAMAGED: Final = f"{_TURNED}\nedit q.mpf COUNTER-CLOCKWISE CLOCKWISE\ntrunnion verify q.mpf --machine yl569"
_BLOCK: Final = "append part.mpf ''\nedit part.mpf 'G1 X10 F100' '{}'\ntrunnion place part.mpf --machine yl569 --turn 0"
_PROJECT: Final = (
    "append project.toml 'zero_mm = [10, -5, -60]\\ntool_length_mm = 120\\nturn_deg = 30\\n'\n"
    "trunnion place project.toml --turn 0"
)
_POSTED: Final = (
    "trunnion.post_placed(trunnion.place('part.cls', machine='yl569', turns=[90], tool_length=100, "
    "stock='box:500,100,40'), machine='yl569')"
)
_TOOL: Final = "--tool 1=flat:10,length=60,flutes=30,gauge=60"
_LONG: Final = _TOOL.replace("gauge=60", "gauge=90")
_FIXTURE: Final = "--fixture jaw.stl"
_JAW: Final = "box jaw.stl -20,20,-10 20,40,-5\n"
_HIGH: Final = "box jaw.stl -20,-2,-10 20,40,20\n"
_ON: Final = "trunnion place part.cls --machine {} --turn 0 --tool-length 60"
_OWN: Final = _ON.format("own.toml")
_BARE: Final = 'write own.toml \'schema = 1\\nextends = "xyzac_trt"\\nname = "Ours"\\nbody = []\\n\'\n'
_BODIES: Final = _BARE.replace("body = []", "[spindle]\\ngauge_point_mm = [0, 0, 100]")
_FORMLESS: Final = "edit part.cls 'TLDATA[^\\n]*\\n' ''\n"


CURES: Final = (
    script("PLC120 ", _BLOCK.format("G1 X10 ZZZ5"), "G1 X10 ZZZ5", "G1 X10 F100"),
    script(
        "PLC140 program_stays", "trunnion place part.mpf --machine yl569 --turn 0 --apply a.mpf", "part.mpf", "part.cls"
    ),
    script("PLC150 fits_nowhere", _POSTED, "[90]", "[0]"),
    script("PLC180 beyond_travel_of_machine", _BLOCK.format("SUPA G0 X9999"), "9999", "0"),
    script(
        "PLC210 fits_depend_on_length",
        "trunnion fit part.cls --machines yl569,hs664rt --turns 180",
        "--turns",
        "--tool-length 120 --turns",
    ),
    script("PLC220 clamped_otherwise", f"{_TURNED}\n{_COMPARED}", "--cl part.cls", "--cl part.cls --turn 30"),
    script(
        "PLC220 clamped_otherwise_than_cl_file",
        f"{_CLAMPED}\ntrunnion verify t.mpf --machine yl569 --cl c.cls",
        "--cl c.cls",
        "--cl c.cls --turn 15",
    ),
    script(
        "PLC220 clamped_otherwise_than_given",
        f"{_CLAMPED}\ntrunnion verify t.mpf --machine yl569 --cl c.cls --turn 5",
        "--turn 5",
        "--turn 15",
    ),
    script("PLC230 head_says_part", f"{_TURNED}\n{_SIMULATED}", "--stock", "--turn 30 --stock"),
    script(
        "PLC240 head_says_slides",
        f"{_AT_ZERO}\ntrunnion verify q.mpf --machine yl569 --zero=0,0,-60 --tool-length 120",
        "=0,0,",
        "=10,-5,",
    ),
    script("PLC250 damaged_in_cl", _IN_CL, ", CLOCKWISE", ", COUNTER-CLOCKWISE"),
    script("PLC250 damaged_in_cl", _IN_CL, f'edit part.cls ^ "{_NOTICE}\\n"', "append part.cls ''"),
    script(
        "PLC250 damaged_in_program", _DAMAGED, "trunnion verify", f"{_TURNED} --set edited=replace\ntrunnion verify"
    ),
    script(
        "PLC310 clamped_otherwise",
        f"{_TURNED}\n{_POST} --turn 40 --output r.mpf\ntrunnion place q.mpf r.mpf --machine yl569 --turn 0",
        "--turn 40",
        "--turn 30",
    ),
    script(
        "PLC310 clamping_not_stated",
        f"{_TURNED}\ntrunnion place q.mpf part.mpf --machine yl569 --turn 0",
        "q.mpf part.mpf --machine",
        "q.mpf --machine",
    ),
    script("PLC330 zero_of_turned_part", _PROJECT, "--turn 0", "--turn 0 --zero 10,-5,-60"),
    script("PLC190 no_two_bodies", f"{_BARE}{_JAW}{_OWN} --goal collisions", "--goal", f"{_TOOL} {_FIXTURE} --goal"),
    script("PLC190 no_two_bodies", f"{_BARE}{_OWN} --goal collisions", _BARE, _BODIES),
    script(
        "PLC260 no_table_stated", f"{_BARE}{_OWN} --stock box:9,9,9", "body = []", "[facts]\\ntable_diameter_mm = 300"
    ),
    script("PLC270 bodies_always_alike", f"{_BARE}{_JAW}{_OWN} {_TOOL} {_FIXTURE} --goal collisions", _BARE, _BODIES),
    script(
        "PLC280 tool_not_kept_apart",
        f"{_FORMLESS}{_JAW}{_ON.format('generic_head_head_ca')} {_FIXTURE}",
        _FIXTURE,
        f"{_TOOL} {_FIXTURE}",
    ),
    script(
        "PLC290 lengths_differ",
        f"{_JAW}{_ON.format('generic_head_head_ca')} {_LONG} {_FIXTURE}",
        "--tool-length 60 ",
        "",
    ),
    script("PLC300 touch_best_place", f"{_HIGH}{_ON.format('generic_head_head_ca')} {_TOOL} {_FIXTURE}", _HIGH, _JAW),
)
