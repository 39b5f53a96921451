"""Cures of messages about the files of definitions, and about axes and bodies of machines."""

from typing import Final

from tests.support.cures.cure import Cure, define
from tests.support.cures.scripts import script

_CHECK: Final = "trunnion check ours.toml"
_MODEL: Final = "trunnion impeller model {} --output a.stl"
_WHEEL: Final = "write wheel.toml 'extends = \"abc\"'\ntrunnion check wheel.toml"
_IMPELLER: Final = "trunnion check {}"
_HEAD: Final = 'schema = 1\nextends = "yl569"\nname = "Ours"\n'


def _lines(message: str, lines: str, cured: str, base: str = "yl569") -> Cure:
    """Lines of a definition that extends a shipped one, and what stands in their place."""
    code, _, variant = message.partition(" ")
    head = _HEAD.replace("yl569", base)
    return Cure(code, variant, define, f"{head}{lines}\n", ((f"{lines}\n", cured and f"{cured}\n"),))


def _axis(message: str, axis: str, line: str, cured: str) -> Cure:
    """A key of an axis, and what stands in its place."""
    table = f'[[axis]]\nname = "{axis}"\n'
    return _lines(message, table + line, table + cured)


def _body(message: str, old: str, new: str, cured: str) -> Cure:
    """A body with something wrong in it, and what stands in its place."""
    return _lines(message, _BODY.replace(old, new), _BODY.replace(old, cured))


_BODY: Final = '[[body]]\nname = "Table"\nlink = "C"\nshape = "box"\nsize_mm = [10, 10, 10]\ncentre_mm = [0, 0, -5]'
_SECOND: Final = _BODY.replace("Table", "Vice")
#: A definition of its own, whose axes are all in it.
_SOUND: Final = """\
schema = 1
name = "Test"
[control]
extends = "sinumerik_840d"
[[axis]]
name = "C"
kind = "rotary"
carries = "part"
direction = [0, 0, 1]
point_mm = [0, 0, 0]
endless = true
[[axis]]
name = "B"
kind = "rotary"
carries = "part"
direction = [0, 1, 0]
point_mm = [0, 0, -50]
limits_deg = [-11, 100]
[[axis]]
name = "X"
kind = "linear"
carries = "tool"
direction = [1, 0, 0]
[[axis]]
name = "Y"
kind = "linear"
carries = "tool"
direction = [0, 1, 0]
[[axis]]
name = "Z"
kind = "linear"
carries = "tool"
direction = [0, 0, 1]
"""
_C, _B = _SOUND.split("[[axis]]\n")[1:3]
_TURNED: Final = _SOUND.replace(_C, "?").replace(_B, _C).replace("?", _B)
_QUILL: Final = (
    'append ours.toml \'[[axis]]\\nname = "W"\\nkind = "linear"\\ncarries = "tool"\\ndirection = [0, 0, 1]\'\n'
    'write mine.toml \'extends = "ours.toml"\\nname = "M"\\n[[axis]]\\nname = "W"\\nremove = false\'\n'
    "trunnion check mine.toml"
)

CURES: Final = (
    script("DEF110 no_shipped", "trunnion verify part.mpf --machine zzzzz", "zzzzz", "yl569"),
    script("DEF110 no_shipped", "trunnion verify part.mpf --machine zzzzz", "zzzzz", "ours.toml"),
    script("DEF110 no_shipped_name", "trunnion verify part.mpf --machine yl560", "yl560", "yl569"),
    script("DEF110 no_shipped_machine", "trunnion new mill.toml --like yl560", "yl560", "yl569"),
    script("DEF110 no_shipped_machine_name", "trunnion new mill.toml --like zzzzz", "zzzzz", "yl569"),
    script("DEF110 nothing_shipped", "trunnion check zzzzz", "zzzzz", "yl569"),
    script("DEF110 nothing_shipped_but_near", "trunnion check yl560", "yl560", "yl569"),
    Cure("DEF120", "more_bytes", define, _HEAD + "# a comment\n" * 100_000, (("# a comment\n" * 90_000, ""),)),
    script("DEF120 nests_too_deeply", f"append ours.toml 'x = {'[' * 3000}{']' * 3000}'\n{_CHECK}",
           "x = " + "[" * 3000 + "]" * 3000, ""),
    _lines("DEF120 whole_number_more", f"[spindle]\nmax_rpm = {'9' * 4200}", "[spindle]\nmax_rpm = 9000"),
    script("DEF120 not_utf_8", f"latin ours.toml '# Größe'\n{_CHECK}", "latin", "append"),
    script("DEF120 ", f"latin ours.toml '# Größe'\n{_CHECK}", "latin", "append"),
    _lines("DEF130 key_without_quotation_marks", '[control.statements]\nAUXFUN/31 = "M31"',
           '[control.statements]\n"AUXFUN/31" = "M31"'),
    _lines("DEF130 no_key", "our key = 5", ""),
    _lines("DEF130 refused", "description = 5 5", "description = '5'"),
    _lines("DEF130 table_does_not_end_in_line", '[control.setting_rules]\npressure = { kind = "number",\n}\n'
           "[control.settings]\npressure = 5",
           '[control.setting_rules]\npressure = { kind = "number" }\n[control.settings]\npressure = 5'),
    _lines("DEF130 text_never_ends", "[control.templates]\nbefore_operation = '''\n;A",
           "[control.templates]\nbefore_operation = '''\n;A\n'''"),
    script("DEF140 control_for_machine", "write c.toml 'extends = \"sinumerik_840d\"\\nname = \"C\"'\n"
           "append ours.toml '[control]\\nextends = \"c.toml\"'\ntrunnion verify part.mpf --machine c.toml",
           "--machine c.toml", "--machine ours.toml"),
    script("DEF140 folder_not", "mkdir mill\ntrunnion verify part.mpf --machine mill/", "--machine mill/",
           "--machine ours.toml"),
    script("DEF140 folder_not", "mkdir mill\ntrunnion verify part.mpf --machine mill/", "--machine mill/",
           "--machine yl569"),
    script("DEF140 not_whose_name", "cp ours.toml mill.TOML\ntrunnion verify part.mpf --machine mill.TOML",
           "mill.TOML", "mill.toml"),
    script("DEF140 not_whose_name_ends_toml", "cp ours.toml mill.txt\ntrunnion verify part.mpf --machine mill.txt",
           "mill.txt", "mill.toml"),
    script("DEF140 nothing_to_check", "trunnion check part.mpf", "part.mpf", "ours.toml"),
    script("DEF140 nothing_to_check", "trunnion check part.cls", "check", "info"),
    script("DEF210 extends_not_file",
           "cp ours.toml mill.TOML\nappend mine.toml 'extends = \"mill.TOML\"\\nname = \"M\"'\n"
           "trunnion check mine.toml", "mill.TOML", "mill.toml"),
    script("DEF210 extends_leads_out_folder", "mkdir a\nlink ../ours.toml a/base.toml\nwrite a/mine.toml "
           "'extends = \"base.toml\"\\nname = \"M\"'\ntrunnion check a/mine.toml", "link ../", "cp "),
    script("DEF210 extends_text_letters", f"write mine.toml 'extends = \"{'a' * 5000}\"\\nname = \"M\"'\n"
           "trunnion check mine.toml", "a" * 5000, "yl569"),
    script("DEF220 extends_goes_circle",
           "write mine.toml 'extends = \"./mine.toml\"\\nname = \"M\"'\ntrunnion check mine.toml",
           "./mine.toml", "yl569"),
    _lines("DEF230 ", '[[axis]]\nname = "BB"\nremove = true', '[[axis]]\nname = "B"\nlimits_deg = [-11, 90]'),
    Cure("DEF310", "missing", define,
         'extends = "yl569"\nname = "Ours"\n[[body]]\nname = "Table"\n' + _BODY[23:].replace('shape = "box"\n', ""),
         (('link = "C"\n', 'link = "C"\nshape = "box"\n'),)),
    _lines("DEF320 belongs_control", '[known]\nM88 = "no effect"', '[control.known]\nM88 = "no effect"'),
    Cure("DEF320", "belongs_whole_file", define, f'{_HEAD}[spindle]\nmax_rpm = 9000\ndescription = "A"\n',
         (('[spindle]\nmax_rpm = 9000\ndescription = "A"\n', 'description = "A"\n[spindle]\nmax_rpm = 9000\n'),)),
    _axis("DEF330 axis_output_never", "C", 'output = "0..360"\nhome_deg = 400', 'output = "0..360"\nhome_deg = 40'),
    _lines("DEF330 ", '[spindle]\nmax_rpm = "fast"', "[spindle]\nmax_rpm = 9000"),
    _lines("DEF330 coolant_is_other_word", "[control.coolant]\nTHRU = 4", "[control.coolant]\nTHRU = 88", "dmu65"),
    _lines("DEF330 coolant_is_other_word", "[control.coolant]\nTHRU = 4", '[control.coolant]\nTHRU = "none"', "dmu65"),
    _lines("DEF330 coolant_is_other_coolant", "[control.coolant]\nFLOOD = 7\nMIST = 8\nTAP = 7",
           "[control.coolant]\nFLOOD = 7\nMIST = 8\nTAP = 7\nON = 7", "yl569"),
    _lines("DEF330 coolant_is_other_coolant", "[control.coolant]\nON = 7",
           "[control.coolant]\nFLOOD = 7\nMIST = 8\nTAP = 7\nON = 7", "yl569"),
    _lines("DEF330 coolant_is_own_word", "[control.coolant]\nTHRU = 128", "[control.coolant]\nTHRU = 88", "dmu65"),
    _lines("DEF330 coolant_is_own_word", "[control.coolant]\nTHRU = 128", '[control.coolant]\nTHRU = "none"', "dmu65"),
    _lines("DEF330 coolant_is_declared", '[control.known]\nM88 = "coolant off"\n[control.coolant]\nTHRU = 88',
           '[control.known]\nM88 = "coolant through"\n[control.coolant]\nTHRU = 88', "dmu65"),
    _lines("DEF330 coolant_is_declared", '[control.known]\nM88 = "coolant off"\n[control.coolant]\nTHRU = 88',
           "[control.coolant]\nTHRU = 88", "dmu65"),
    _lines("DEF330 control_counts_all", "[control.block_numbers]\nstart = 100", "[control.block_numbers]\nstart = 0",
           "dmu65"),
    _lines("DEF330 control_takes_no", "[control.block_numbers]\nhighest = 100000",
           "[control.block_numbers]\nhighest = 99999",
           "haas_umc750"),
    _lines("DEF330 but_numbers_start", "[control.block_numbers]\nstart = 500\nhighest = 300",
           "[control.block_numbers]\nstart = 500\nhighest = 900", "matsuura_mx330"),
    _lines("DEF330 lacks_lines_begin", '[control.block_numbers]\nunnumbered = "("',
           '[control.block_numbers]\nunnumbered = "(%O"',
           "matsuura_mx330"),
    _lines("DEF330 true_numbers_without", '[control.block_numbers]\nletter = ""\nnumbered = true',
           '[control.block_numbers]\nletter = "N"\nnumbered = true'),
    _lines("DEF330 given_numbers_without", "[control.block_numbers]\nevery = 5", "", "dmu65"),
    _lines("DEF330 no_two_lengths", "[facts]\ntable_size_mm = [0, 5]", "[facts]\ntable_size_mm = [5, 5]"),
    _lines("DEF330 no_extension", '[control]\nextension = "mpf"', '[control]\nextension = ".mpf"'),
    _lines("DEF330 no_axis_at_home", '[proof]\nhome_at_end = ["Q"]', '[proof]\nhome_at_end = ["Z"]'),
    _lines("DEF330 no_start_mode", '[control.reading]\nstart_modes = ["Q"]',
           '[control.reading]\nstart_modes = ["G17"]'),
    _lines("DEF330 no_basis", '[proof]\nrequire = ["luck"]', '[proof]\nrequire = ["zero"]'),
    _axis("DEF330 decimal_commas", "B", "limits_deg = [-11,5, 90,5]", "limits_deg = [-11.5, 90.5]"),
    _axis("DEF330 not_allowed_but_near", "B", 'positive = "reverse"', 'positive = "reversed"'),
    _axis("DEF330 not_allowed", "B", 'positive = "zzzzzzz"', 'positive = "reversed"'),
    _axis("DEF330 too_large", "X", "limits_mm = [0, 1e12]", "limits_mm = [0, 1e3]"),
    _lines("DEF330 text_for_list", '[control.units]\nsettings = "home"', "[control.units]\nsettings = []"),
    script("DEF410 linear_rotary_axes", _QUILL, "remove = false", "remove = true"),
    _axis("DEF410 linear_rotary", "Z", "remove = true", "limits_mm = [0, 500]"),
    _axis("DEF410 part_but_before", "Z", 'carries = "part"\n[[axis]]\nname = "Y"\ncarries = "tool"', ""),
    _axis("DEF420 makes_count_another", "X", 'positive = "reversed"', 'positive = "standard"'),
    _axis("DEF420 makes_count_another_way", "X", "direction = [-1, 0, 0]", "direction = [1, 0, 0]"),
    _axis("DEF420 parallel_machine_could", "B", "direction = [0, 0, 1]", "direction = [0, 1, 0]"),
    _axis("DEF420 those_other_linear", "X", "direction = [0, 1, 0]", "direction = [1, 0, 0]"),
    _body("DEF430 begins_ends_blanks", '"Table"', '" Table"', '"Table"'),
    _lines("DEF430 name_another_body", f"{_BODY}\n{_BODY.replace('Table', 'TABLE')}", f"{_BODY}\n{_SECOND}"),
    _lines("DEF430 name_too", '[[axis]]\nname = "b"\nkind = "linear"\ncarries = "tool"\ndirection = [0, 0, 1]', ""),
    _lines("DEF440 above_max_rpm", "[[spindle.gear]]\nmin_rpm = 99\nmax_rpm = 9",
           "[[spindle.gear]]\nmin_rpm = 9\nmax_rpm = 99"),
    _lines("DEF440 above_max_rpm", "[spindle]\nmin_rpm = 99\nmax_rpm = 9", "[spindle]\nmin_rpm = 9\nmax_rpm = 99"),
    _axis("DEF440 axis_limits", "B", 'output = "0..360"', ""),
    Cure("DEF440", "missing", define, _SOUND.replace("limits_deg = [-11, 100]\n", ""),
         (("point_mm = [0, 0, -50]", "point_mm = [0, 0, -50]\nlimits_deg = [-11, 100]"),)),
    Cure("DEF440", "missing", define, _SOUND.replace("limits_deg = [-11, 100]\n", ""),
         (("point_mm = [0, 0, -50]", "point_mm = [0, 0, -50]\nendless = true"),)),
    Cure("DEF420", "parallel_spindle_turns", define, _TURNED, ((_TURNED, _SOUND),)),
    Cure("DEF440", "outside_limits_0", define, _SOUND.replace("[-11, 100]", "[5, 100]"),
         (("[5, 100]", "[5, 100]\nhome_deg = 90"),)),
    _body("DEF450 given_shape", "centre_mm", "length_mm = 5\ncentre_mm", "centre_mm"),
    _body("DEF450 side_not_above", "[10, 10, 10]", "[10, 0, 10]", "[10, 10, 10]"),
    Cure("DEF450", "tables", define, _SOUND + "\n".join(_BODY.replace("Table", f"T{k}") for k in range(65)),
         ((_BODY.replace("Table", "T64"), ""),)),
    _lines("DEF455 is", '[[body]]\nname = "Table"\nlink = "C"\nshape = "file"\nfile = "table.txt"',
           '[[body]]\nname = "Table"\nlink = "C"\nshape = "file"\nfile = "table.stl"'),
    _lines("DEF455 leads_out_folder", '[[body]]\nname = "Table"\nlink = "C"\nshape = "file"\nfile = "../table.stl"',
           '[[body]]\nname = "Table"\nlink = "C"\nshape = "file"\nfile = "meshes/table.stl"'),
)  # fmt: skip
