"""Cures of messages about what a control cannot do without TCP, among holes, in planes, or with its templates."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, marked, post
from tests.support.cures.posting.rows import by_definition, by_lines, by_settings, defined, on_machine
from tests.support.cures.reading import ended
from tests.support.cures.scripts import script
from tests.support.locations import ROOT
from tests.support.posting import CLEAR, FOOT, HEAD, LEANING
from trunnion.errors import Problem
from trunnion.families import FAMILIES, FamilyEntry

_PLACED: Final = {"tcp": "off", "zero": "0,0,100", "tool_length": "50"}
_TURN: Final = "GOTO/11,0,5,0.0,0.5,0.8660254\n"
_SLOW: Final = LEANING + "FEDRAT/MMPM,{}\n" + _TURN
_SECOND: Final = HEAD.replace("OP1", "OP2")
_TAP: Final = "CYCLE/TAP,FEDTO,-10,RAPTO,3,MMPR,1"

#: Two holes into a ball about the zero, each along its own tool axis.
_BALL: Final = "RAPID\nGOTO/80,0,60,0.8,0,0.6\nCYCLE/DRILL,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90\nGOTO/32,0,24,0.8,0,0.6\n"

_NORMALS: Final = (
    HEAD.replace("0.0000,75", "5.0000,75").replace("RAPID\n", "$$ centerline and contact point\nRAPID\n")
    + "GOTO/20,0,5 $$ 20,0,5\nGOTO/40,0,5,0.5,0,0.8660254038 $$ 42.5,0,4.330127\nGOTO/50,0,5 $$ 52.5,0,4.330127\n"
)
_TILTED: Final = CLEAR.replace("0.0,0.0,1.0", "0.0,0.6,0.8") + "FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n"
_HEAD_FIDIA: Final = 'extends = "generic_head_table_bc"\n[control]\nextends = "fidia_nc15"\n'
_ABOVE: Final = CLEAR.replace("0.0,0.0,1.0", "0.0,0.6,0.8")
_TAPPED: Final = f"{_TAP}\nGOTO/32,0,5\nCYCLE/OFF\n{FOOT}"
_BALL2: Final = CLEAR + _BALL + "GOTO/-16,27.712812921,24,-0.4,0.692820323,0.6\nCYCLE/OFF\n" + FOOT


def _without(cl: str) -> Trial:
    """Return what posts a CL file for a Sinumerik without templates of some names."""

    def posted(names: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        control = (ROOT / "src/trunnion/controls/library/sinumerik_840d.toml").read_text(encoding="utf-8")
        fewer = re.sub(rf"(?ms)^({names}) = '''.*?'''\n", "", control)
        (folder / "control.toml").write_text(fewer, encoding="utf-8")
        machine = 'extends = "yl569"\n[control]\nextends = "control.toml"\n'
        return defined(cl, **settings)(machine, {}, folder)

    return posted


_MEASURES: Final = ("limits_mm = [-400, 400]", "home_mm = 0", "rapid_mm_min = 9000", "acceleration_mm_s2 = 900")
_MARKED: Final = [
    line
    for name in "XYZ"
    for line in (
        "[[axis]]",
        f'name = "{name}"',
        *(f"- {measure} # measure: it" for measure in _MEASURES),
        *(f"+ {measure}" for measure in _MEASURES),
    )
]
_PLANES: Final = "[a-z_]*(frames|cycle800)"
_REGISTER: Final = HEAD.replace("ADJUST,1", "ADJUST,5") + FOOT
_TNC: Final = 'extends = "hs664rt"\n[control]\nextends = "heidenhain_tnc640"\n'
_CIRCLING: Final = (
    CLEAR.replace("0.0,0.0,1.0", "0.6,0.0,0.8")
    + "FEDRAT/MMPM,500.0\n"
    + "".join(f"GOTO/{k},0,5,{axis},0.8\n" for k, axis in enumerate(("0.6,0", "0,0.6", "-0.6,0", "0,-0.6", "0.6,0")))
)


def _unread(tried: Trial) -> Trial:
    """Return a trial of a family of controls that has no reader."""

    def posted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        family = "sinumerik_840d"
        with patch.dict(FAMILIES, {family: FamilyEntry(FAMILIES[family].writer, None)}):
            return tried(text, settings, folder)

    return posted


def _forced(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file by force."""
    file, heard = folder / "part.cls", list[Problem]()
    file.write_text(text, encoding="utf-8")
    return ended(
        lambda: heard.extend(trunnion.post(file, machine="yl569", settings=settings, force=True).problems), heard
    )


def _reported(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file by force, and write a report of it."""
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    return ended(lambda: trunnion.post(file, machine="yl569", force=True).write_report(folder / "report.html"))


CURES: Final = (
    Cure("CTL920", "", _unread(post()), HEAD + FOOT, (), cured_by=post()),
    Cure("CTL930", "", _unread(_forced), HEAD + FOOT, (), stays=True),
    Cure("CTL920", "nothing_times_feeds", _unread(_forced), HEAD + FOOT, ({"feed": None},), {"feed": "fastest"}),
    Cure("CTL920", "nothing_proven", _unread(_reported), HEAD + FOOT, (), cured_by=_reported),
    Cure(
        "CTL115",
        "line_brings_block_number",
        on_machine('extends = "matsuura_mx330"\n[control.block_numbers]\nstart = 1\nstep = 1\n'),
        HEAD + "INSERT/N3 (A)\n" + FOOT,
        ({"numbers": "off"},),
    ),
    by_lines(
        "CTL340 f_block_would",
        "- FEDRAT/MMPM,0.000001",
        "+ FEDRAT/MMPM,100",
        _TURN.strip(),
        head=LEANING,
        on="dmu65",
        **_PLACED,
    ),
    by_lines(
        "CTL340 block_takes_minutes",
        "- FEDRAT/MMPM,0.0001",
        "+ FEDRAT/MMPM,100",
        _TURN.strip(),
        head=LEANING,
        **_PLACED,
    ),
    by_lines(
        "CTL340 f_block_up",
        "- FEDRAT/MMPM,0.0001",
        "+ FEDRAT/MMPM,100",
        _TURN.strip(),
        head=LEANING,
        on="dmu65",
        **_PLACED,
    ),
    by_settings("CTL340 rotary_axes_turn", {"units": "mm"}, LEANING, "dmu65", units="inch", **_PLACED),
    by_settings(
        "CTL340 block_so_short",
        {"axis_tolerance": "5", "tip_tolerance": "1"},
        LEANING.replace("500.0", "9000") + _TURN,
        "matsuura_mx330",
        axis_tolerance="0.001",
        tcp="off",
        zero="0,0,300",
    ),
    by_lines(
        "CTL370 without_tcp",
        "+ RAPID",
        "- GOTO/20,0,50,0,0.6,0.8",
        _TAP,
        "GOTO/20,0,5,0,0.6,0.8",
        "CYCLE/OFF",
        head=LEANING.replace("GOTO/10.0,0.0,5.0,0.0,0.6,0.8\n", ""),
        on="dmu65",
        **_PLACED,
    ),
    by_lines(
        "CTL380 straight_way_hole",
        "+ RAPID",
        "+ GOTO/96,0,72,0.8,0,0.6",
        "+ RAPID",
        "+ GOTO/-48,83.138438763,72,-0.4,0.692820323,0.6",
        "GOTO/-16,27.712812921,24,-0.4,0.692820323,0.6",
        "CYCLE/OFF",
        head=CLEAR + _BALL,
        holes="torot",
    ),
    by_settings(
        "CTL560 tool_s_vector",
        {"orientation": "angles"},
        HEAD + "GOTO/11,0,5,0.05,0,0.998749218\nGOTO/12,0,5,-0.04,0.03,0.998749218\n",
        "matsuura_mx330",
        orientation="vector",
    ),
    Cure("CTL715", "length_is_that_of_tool", post("hs664rt"), _REGISTER, ((",ADJUST,5", ""),)),
    Cure("CTL715", "length_is_that_of_tool", post("hs664rt"), _REGISTER, ((",ADJUST,5", ",ADJUST,1"),)),
    by_definition(
        "CTL720 home_not_stated",
        'extends = "hs664rt"',
        "[control]",
        'extends = "heidenhain_tnc640"',
        *(f'+ [[axis]]\nname = "{name}"\nhome_mm = 0' for name in "XYZ"),
    ),
    Cure(
        "CTL110",
        "number_beyond_format",
        on_machine(_TNC),
        (HEAD + FOOT).replace("RPM,4000", "RPM,4000000"),
        (("RPM,4000000", "RPM,4000"),),
    ),
    by_definition(
        "CTL630 rotary_axis_goes",
        'extends = "xyzac_trt"',
        "[[axis]]",
        'name = "C"',
        '- output = "0..360"',
        '+ output = "none"',
        text=_CIRCLING,
        tcp="off",
        zero="0,0,0",
    ),
    by_definition(
        "CTL457 mode_not_stated_again", 'extends = "yl569"', "[control.templates]", '- after_approach = "COMPCAD"'
    ),
    by_definition(
        "CTL457 template_changes_something",
        'extends = "yl569"',
        "[control.templates]",
        '- first_cut = "G91"',
        '+ first_cut = "M61"',
        "[control.known]",
        'M61 = "no effect"',
    ),
    by_settings(
        "CTL640 projected_unknown",
        {"plane": "spatial"},
        _TILTED,
        "mikron_600u",
        plane="projected",
    ),
    Cure(
        "CTL640",
        "projected_too_steep",
        on_machine('extends = "mikron_600u"\n[control]\nprojected_angles = "turning"\n'),
        _TILTED.replace("0.0,0.6,0.8", "0.0,0.96,0.28") + FOOT,
        ({"plane": "spatial"},),
        {"plane": "projected"},
    ),
    Cure(
        "CTL640",
        "axial_other_x",
        post("mikron_600u"),
        HEAD
        + FOOT
        + _SECOND.replace("1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0", "0,0.8,-0.6,-1,0,0.0")
        + FOOT,
        ({"plane": "spatial"},),
        {"plane": "axial"},
    ),
    by_settings(
        "CTL610 point_between_cl",
        {"axis_tolerance": None},
        _NORMALS,
        "dmu65",
        normals="contact",
        orientation="vector",
        axis_tolerance="0.05",
    ),
    marked(
        "CTL730 retract_not_known",
        on_machine(_HEAD_FIDIA),
        _TILTED.rstrip(),
        foot=FOOT,
        zero="0,0,100",
        tool_length="50",
    ),
    Cure(
        "CTL370",
        "hole_without_tilted_plane",
        _without(_ABOVE + _TAPPED),
        _PLANES,
        ({"holes": "torot"},),
        {"mode": "tcp"},
    ),
    Cure(
        "CTL550",
        "holes_along_another",
        _without(_BALL2),
        f"next_axis_five_axis|{_PLANES}",
        (("next_axis_five_axis|", ""),),
    ),
    by_definition(
        "CTL720 definition_marks_values_not",
        'extends = "yl569"',
        "[spindle]",
        "- max_rpm = 9000 # measure: it",
        "+ max_rpm = 9000",
    ),
    by_definition(
        "CTL720 definition_marks_values",
        'extends = "yl569"',
        *_MARKED,
        "[spindle]",
        "- max_rpm = 9000 # measure: it",
        "+ max_rpm = 9000",
    ),
    script(
        "CTL910 nothing_written",
        "append ours.toml '[control.templates]\\nprogram_start=\"G91\"'\nedit project.toml yl569 "
        "ours.toml\ntrunnion post project.toml",
        '\\nprogram_start="G91"',
        "",
    ),
)
