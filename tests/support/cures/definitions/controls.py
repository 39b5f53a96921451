"""Cures of messages about the control's part of a definition: templates, formats, words, settings, statements."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, define
from tests.support.cures.reading import ended
from tests.support.cures.scripts import script
from tests.support.locations import ROOT
from trunnion.controls import load_control
from trunnion.controls.inches import in_units
from trunnion.errors import TrunnionError


def _in_inches(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Load a definition of a control for programs in inches."""
    file = folder / "ours.toml"
    file.write_text(text, encoding="utf-8")
    try:
        in_units(load_control(trunnion.load_machine(file).control), "inch")
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome((), True)


def _head(base: str) -> str:
    return f'schema = 1\nextends = "{base}"\nname = "Ours"\n'


def _own(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Load a machine whose control is that of the library, with a text in place of the entry of the feed's word."""
    library = (ROOT / "src/trunnion/controls/library/sinumerik_840d.toml").read_text(encoding="utf-8")
    assert _FEED_WORD in library
    (folder / "control.toml").write_text(library.replace(_FEED_WORD, text), encoding="utf-8")
    machine = folder / "ours.toml"
    machine.write_text(f'{_head("yl569")}[control]\nextends = "control.toml"\n', encoding="utf-8")
    return ended(lambda: load_control(trunnion.load_machine(machine).control))


_FEED_WORD: Final = '[[word]]\nname = "feed"\nletter = "F"\nformat = "feed"\n'


def _lines(message: str, lines: str, cured: str, base: str = "yl569") -> Cure:
    """Lines of a definition that extends a shipped one, and what stands in their place."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, define, f"{_head(base)}{lines}\n", ((f"{lines}\n", cured and f"{cured}\n"),))


def _key(message: str, table: str, line: str, cured: str, base: str = "yl569") -> Cure:
    """A line of a table, and what stands in its place."""
    return _lines(message, f"[{table}]\n{line}", f"[{table}]\n{cured}", base)


def _text(message: str, line: str, cured: str, place: str = "before_operation") -> Cure:
    """A line of a template, and what stands in its place."""
    table = "[control.templates]\n{} = '''\n{}\n'''"
    return _lines(message, table.format(place, line), table.format(place, cured))


def _inches(variant: str, lines: str, old: str, new: str) -> Cure:
    return Cure("DEF540", variant, _in_inches, _head("matsuura_mx330") + lines, ((old, new),))


_END: Final = "[control.templates]\nprogram_end = '''\nM9\n{}\nM30\n%\n'''\n"
_INCH_ANGLE: Final = '[[control.format]]\nname = "angle"\ninch = { decimals = 4 }\n'

CURES: Final = (
    Cure("DEF530", "no_entry_programs", _own, "# none\n", (("# none\n", _FEED_WORD),)),
    _text("DEF510 lone_brace", ";{title!r}", ";{title}"),
    _text("DEF510 lone_brace", ";{5:coordinate", ";{5:coordinate}"),
    _text("DEF510 lone_brace", ";[[{title}", ";[[{title}]]"),
    _text("DEF510 no_field", ";{nosuch}", ";{title}"),
    _lines("DEF510 no_field", "[control.templates]\nbefore_operation = ';{nosuch}'",
           "[control.templates]\nbefore_operation = ';{nosuch}'\n[control.settings]\nnosuch = 'A'"),
    _text("DEF510 no_field_but_near", ";{titel}", ";{title}"),
    _text("DEF510 no_value_but_near", "{% if titel %}\n;A\n{% endif %}", "{% if title %}\n;A\n{% endif %}"),
    _lines("DEF510 no_value_but_near", "[control.templates]\nbefore_operation = '{% if titel %}A{% endif %}'",
           "[control.templates]\nbefore_operation = '{% if titel %}A{% endif %}'\n[control.settings]\ntitel = 'A'"),
    _text("DEF510 no_filter", ";{{ title | zzzzz }}", ";{{ title | upper }}"),
    _text("DEF510 no_filter_but_near", ";{{ title | uper }}", ";{{ title | upper }}"),
    _text("DEF510 no_format", ";{home_x:zzzzz}", ";{home_x:coordinate}"),
    _text("DEF510 no_format_but_near", ";{home_x:coordinat}", ";{home_x:coordinate}"),
    _text("DEF510 not_begun", "M8 %}", "{% if title %}\nM8\n{% endif %}"),
    _text("DEF510 not_begun", "M8 %}", "M8"),
    _text("DEF570 cannot_be_read", "{% if title = 'A' %}\nM8\n{% endif %}", "{% if title == 'A' %}\nM8\n{% endif %}"),
    _lines("DEF515 format_nothing", '[[control.format]]\nname = "zzzzz"\ndecimals = 4',
           '[[control.format]]\nname = "coordinate"\ndecimals = 4'),
    _lines("DEF515 format_nothing_prints", '[[control.format]]\nname = "coordinat"\ndecimals = 4',
           '[[control.format]]\nname = "coordinate"\ndecimals = 4'),
    _lines("DEF515 format_nothing_prints", '[[control.format]]\nname = "coordinat"\ndecimals = 4\nzero = "0"',
           '[[control.format]]\nname = "coordinat"\ndecimals = 4\nzero = "0"\n[control.templates]\n'
           'before_operation = ";{home_x:coordinat}"'),
    _key("DEF520 explains_no_setting", "control.setting_meanings", 'zzzz = "A"',
         'zzzz = "A"\n[control.settings]\nzzzz = "1"'),
    _key("DEF520 rule_no_setting", "control.setting_rules", 'zzzz = { kind = "number" }',
         'zzzz = { kind = "number" }\n[control.settings]\nzzzz = 1'),
    _key("DEF520 not_allowed", "control.settings", 'units = "cm"', 'units = "inch"'),
    _key("DEF520 not_known_how", "control.settings", 'preselect = "on"', "", base="hs664rt"),
    _key("DEF520 key_of_reading", "control.settings", 'start_modes = "G17"', ""),
    _key("DEF520 near_setting", "control.settings", 'unitz = "inch"', 'units = "inch"'),
    _key("DEF520 near_setting_of_run", "control.settings", 'limit_margn = 5', ""),
    _key("DEF520 setting_run_definition", "control.settings", 'cl_units = "inch"', ""),
    _key("DEF520 template_field_whose", "control.settings", 'home_x = "1"', 'home_x_of_ours = "1"'),
    _lines("DEF530 is", '[[control.word]]\nname = "X"\nletter = "ABCDEFGHI"',
           '[[control.word]]\nname = "X"\nletter = "X"'),
    _key("DEF530 radius_control_s", "control.arcs", 'by = "radius"', "", base="hs664rt"),
    _key("DEF550 line_break_control", "control.statements", '"AUXFUN/31" = "M31\\nM32"', '"AUXFUN/31" = "M31"'),
    _key("DEF550 statement_always_read", "control.statements", 'GOTO = "M31"', ""),
    _key("DEF550 statement_always_read", "cl.words", 'SPINDL = "COOLNT/ON"', ""),
    script("DEF550 not_statement_known", "append ours.toml '[cl.words]\\nAIRBLAST = \"AIR\"\\n'\n"
           "trunnion post part.cls --machine ours.toml", '"AIR"', '"COOLNT/AIR"'),
    script("DEF550 not_event_itself", "append ours.toml '[cl.words]\\nAIRBLAST = \"GOTO/1,2,3\"\\n'\n"
           "trunnion post part.cls --machine ours.toml", "GOTO/1,2,3", "COOLNT/AIR"),
    script("DEF550 not_event_itself", "append ours.toml '[cl.words]\\nAIRBLAST = \"RAPID\"\\n'\n"
           "trunnion post part.cls --machine ours.toml", "RAPID", ""),
    _key("DEF590 template_never_used", "control.templates", 'event_SPINDL = "M3"', 'event_PPRINT = ";{text}"'),
    _key("DEF590 template_not_in_capitals", "control.templates", 'event_auxfun = "M31"', 'event_AUXFUN = "M31"'),
    _key("DEF590 does_not_say", "control.templates", 'subprogram_call = "M98"', 'subprogram_call = "M98 P{subprogram}"',
         base="matsuura_mx330"),
    _key("DEF340 says_same_only", "control.statements", '"AUXFUN/A" = "M1"\n"AUXFUN / A" = "M2"', '"AUXFUN/A" = "M1"'),
    _key("DEF340 says_same_only", "control.statements", 'seqno = "M1"\nSEQNO = "M2"', 'SEQNO = "M2"'),
    _inches("does_not_say", "[control.templates]\nsubprogram_start = '''\n%\nO{subprogram}\nG17\n'''\n",
            "G17", "G17 {unit_word}"),
    _inches("says_millimetres", "[control.templates]\nsubprogram_start = '''\n%\nO{subprogram}\nG21 G17\n'''\n",
            "G21 G17", "{unit_word} G17"),
    _inches("number_may_length", _END.format("G53 G0 Z-25.4"), "Z-25.4", "Z{-25.4:coordinate}"),
    _inches("number_may_length", _END.format("#100=25.4"), "25.4", "{25.4:code}"),
    _inches("prints_length_format", _END.format("(Z{home_z:angle})"), ":angle", ":coordinate"),
    _inches("prints_no_length", _END.format("(S{spindle_speed:coordinate})"), ":coordinate", ":code"),
    _inches("word_no_format", '[[control.word]]\nname = "X"\nformat = "ours"\n[[control.format]]\nname = "ours"\n'
            "decimals = 3\n", "decimals = 3", "decimals = 3\ninch = { decimals = 5 }"),
    _inches("word_no_length", '[[control.word]]\nname = "primary"\nformat = "coordinate"\n', "coordinate", "angle"),
    script("DEF560 template_does_not", "append ours.toml '[control.templates]\\nstop = \"; {text}\"\\n'\n"
           "trunnion post stop.cls --machine ours.toml", "; {text}", "M{number} ;{text}"),
    script("DEF595 motion_in_branch", "append ours.toml '[control.templates]\\nbefore_operation = "
           "\"{% if operation.coolant %}G0 X1{% endif %}\"\\n'\ntrunnion check ours.toml",
           "{% if operation.coolant %}G0 X1{% endif %}", "G0 X1"),
)  # fmt: skip
