"""Cures of messages about what a conversion carries over: settings, work offsets, words of builders, cycles."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

import trunnion
from tests.support.cures.conversion.rows import FANUC, PROGRAMS, converting, edited, within
from tests.support.cures.cure import Cure, Outcome, marked, post
from tests.support.cures.scripts import script
from tests.support.locations import ROOT
from tests.support.posting import FOOT, HEAD
from trunnion.conversion import states


def _written(name: str, *lines: str) -> str:
    """A command that writes a file of lines."""
    return f"write {name} '" + "".join(f"{line}\\n" for line in lines) + "'\n"


def _extended(name: str, extended: str, *lines: str) -> str:
    """A command that writes the definition of a machine."""
    return _written(name, "schema = 1", f'extends = "{extended}"', 'name = "Ours"', *lines)


_SECOND: Final = (HEAD.replace("OP1", "OP2") + FOOT).replace("\n", "\\n")
_TWO: Final = f"append part.cls '{_SECOND}'\n"
_LEANING: Final = "edit part.cls 'RAPID.*END' 'RAPID\\nGOTO/0,0,50,0,0.6,0.8\\nEND'\n"
_POST: Final = "trunnion post part.cls --machine yl569 --output p.mpf"
_ONLY_G54: Final = _extended("ours.toml", "yl569", "[control.setting_rules]", 'work_offset = { one_of = ["G54"] }')
_CONVERT: Final = "trunnion convert p.mpf --machine yl569 --to-machine {} --output {}"
_OURS: Final = _CONVERT.format("ours.toml", "q.mpf")
_SAME_NAMES: Final = "edit p.mpf OP2 OP1\nappend ours.toml ''\n"
_WORD: Final = "edit part.nc 'G1 X10' 'M60\\nG1 X10'\n"
_WORDS: Final = "trunnion convert part.nc --machine a.toml --to-machine b.toml --output q.h"
_JOB: Final = ('results = "out"', "[[job]]", 'action = "convert"', 'files = ["part.mpf"]')
_JOBS: Final = "append part.mpf ''\n{}trunnion batch jobs.toml"
_FIDIA: Final = "G1 X0. Y0. Z50. F3000\nG84 X10. Y0. Z10. E-20. R3. F750\nG80\nG1 Z50. F3000\nM242\nM02\n"
_BORE: Final = "CYCL DEF 208 BORE MILLING Q200=2 Q201=-3 Q206=100 Q334=1 Q203=+0 Q204=50 Q335=20 Q342=0"
_SEVERAL: Final = _CONVERT.format("yl569", "r/q.mpf").replace("p.mpf", "p.mpf --subprograms OP1.spf OP2.spf")


def _posted_again(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Convert a program to a CL file, and post that for the machine of the program."""
    file = folder / "part.nc"
    file.write_text(text, encoding="utf-8")
    trunnion.convert(file, machine=FANUC, to_cl=True, output=folder / "read.cls")
    return post(FANUC)((folder / "read.cls").read_text(encoding="utf-8"), settings, folder)


def _own(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Convert a program of another work offset for a control whose definition is a text in place of "work_offset"."""
    library = (ROOT / "src/trunnion/controls/library/sinumerik_840d.toml").read_text(encoding="utf-8")
    if text == "without":
        library = re.sub(r"(?m)^work_offset = .*\n", "", library).replace("{work_offset}", "G54")
    (folder / "control.toml").write_text(library, encoding="utf-8")
    (folder / "ours.toml").write_text(
        'schema = 1\nextends = "yl569"\nname = "Ours"\n[control]\nextends = "control.toml"\n'
    )
    program = "".join(PROGRAMS[FANUC]).replace("G54", "G55")
    return converting(machine=FANUC, to_machine=str(folder / "ours.toml"))(program, settings, folder)


def _without_row(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Convert a program with an event of which no row says what becomes of it."""
    with patch.dict(states._BY_KIND):
        states._BY_KIND.pop("tolerance")
        return converting(machine="yl569", to_cl="yes")(text, settings, folder)


_NC: Final = PROGRAMS[FANUC]

CURES: Final = (
    script("CNV110 cl_say_where", _JOBS.format(_written("jobs.toml", *_JOB, 'machine = "yl569"')),
           'machine = "yl569"', 'machine = "yl569"\\nto_cl = true'),
    script("CNV110 missing", _JOBS.format(_written("jobs.toml", *_JOB, 'to_machine = "yl569"')),
           'to_machine = "yl569"', 'to_machine = "yl569"\\nmachine = "yl569"'),
    script("CNV140 setting_not_carried_over",
           f"{_LEANING}{_POST} --set plane=frames\n{_CONVERT.format('dmu65', 'q.h')}",
           "--output q.h", "--set plane=spatial --output q.h"),
    script("CNV140 setting_impossible_there",
           "trunnion post part.cls --machine haas_umc750 --set program=12345 --output p.nc\n"
           f"trunnion convert p.nc --machine haas_umc750 --to-machine {FANUC} --output q.nc",
           "--output q.nc", "--set program=12 --output q.nc"),
    script("CNV142 one_program_one", f"{_TWO}{_POST} --set tolerance=0.02,OP2:0.05\n{_SAME_NAMES}{_OURS}",
           "edit p.mpf OP2 OP1\n", ""),
    script("CNV142 one_program", f"{_TWO}{_POST} --set cycle832=_ROUGH,OP2:_FINISH\n{_SAME_NAMES}{_OURS}",
           "edit p.mpf OP2 OP1\n", ""),
    script("CNV143 offsets_of_operations_impossible",
           f"{_TWO}{_POST} --set work_offset=G54,OP2:G55\n{_ONLY_G54}{_OURS}",
           "--output q.mpf", "--set work_offset=G54 --output q.mpf"),
    Cure("CNV141", "no_such_offset", _own, "without", (("without", "work_offset"),)),
    script("CNV150 not_carried_over",
           _WORD + _extended("a.toml", FANUC, "[control.known]", 'M60 = "no effect: conveyor"')
           + _extended("b.toml", "mikron_600u", "[control.known]", 'M71 = "no effect: lamp"') + _WORDS,
           "lamp", "conveyor"),
    script("CNV150 not_carried_over_no",
           _WORD + _extended("a.toml", FANUC, "[control.known]", 'M60 = "no effect"')
           + _extended("b.toml", "mikron_600u", "[control.known]", 'M71 = "no effect: conveyor"') + _WORDS,
           'M60 = "no effect"', 'M60 = "no effect: conveyor"'),
    Cure("CNV152", "words_builder_kept", converting(machine=FANUC, to_cl="yes"), _NC[0] + "M60\n" + _NC[1], (),
         cured_by=_posted_again),
    within("CNV160 other_rotary_positions", "TRAORI", "G54", "G0 X0 Y0 Z50 B0 C0", "G1 X1 C90 F100", "X2 C0", "TRAFOOF",
           "G54", on="yl569"),
    script("CNV162 becomes_one_program", f"mkdir r\n{_TWO}{_POST} --set programs=operations\n{_SEVERAL}",
           "--output r/q", "--set programs=operations --output r/q"),
    marked("CNV170 unknown_state", _without_row, "- CTOL=0.01",
           head=PROGRAMS["yl569"][0], foot=PROGRAMS["yl569"][1]),
    marked("CNV176 thread_bore_while", converting(machine="hs664rt", to_cl="yes"), "- S500", "+ M3 S500",
           head="G71\nM306 T.5\nG55 O1\nM242\n", foot=_FIDIA),
    edited("CNV172 without_radius", f"L Z+5 FMAX\n{_BORE}\nM99\nL Z-1 F100", "L Z-1 F100", on="dmu65"),
)  # fmt: skip
