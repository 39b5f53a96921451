"""Cures of messages about projects: their keys, their programs, and what is compared with released ones."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script

_POST: Final = "trunnion post p.toml"
_HEAD: Final = 'machine = "yl569"\ncl = ["part.cls"]\noutput = "out.mpf"\n'
_SETUPS: Final = (
    'machine = "yl569"\n[[setup]]\nname = "top"\ncl = ["part.cls"]\noutput = "a.mpf"\n'
    '[[setup]]\nname = "side"\ncl = ["two.cls"]\noutput = "b.mpf"\n'
)
_CUT: Final = 'stock = "box:9,9,9"\ncell_mm = 1\nzero_mm = [0, 0, 0]\ntool_length_mm = 100\n'
_CASE: Final = (
    "mkdir c\ncp part.cls c/part.cls\nwrite c/part.toml '" + _HEAD.replace("\n", "\\n") + "'\ntrunnion post c/part.toml"
)
_RELEASED: Final = "trunnion post part.cls --machine yl569 --output r.mpf\ncp r.mpf s.mpf\n"
_ONE_SETUP: Final = '[[setup]]\nname = "last"\ncl = ["part.cls"]\noutput = "last.mpf"\n'
_MANY_SETUPS: Final = "".join(_ONE_SETUP.replace("last", f"s{k}") for k in range(200))
_MANY_SETTINGS: Final = "settings = { " + ", ".join(f"a{k} = 1" for k in range(2000)) + " }\n"
_RENAMED: Final = "trunnion post project.toml\nedit project.toml out.mpf b.mpf"


def _project(message: str, text: str, old: str, new: str, command: str = _POST, before: str = "") -> Cure:
    """A project that is posted, and what stands in place of a part of it; both CL files are there."""
    wrap = [each.replace("\n", "\\n") for each in (text, old, new)]
    return script(
        message, f"append part.cls ''\nappend two.cls ''\n{before}write p.toml '{wrap[0]}'\n{command}", *wrap[1:]
    )


CURES: Final = (
    _project("DEF330 posts_nothing", 'machine = "yl569"\nprograms = ["part.mpf"]\n' + _CUT, 'programs = ["part.mpf"]',
             'cl = ["part.cls"]\noutput = "out.mpf"', before="append part.mpf ''\n"),
    _project("DEF330 output_missing", _SETUPS.replace('output = "a.mpf"\n', ""), '["part.cls"]',
             '["part.cls"]\noutput = "a.mpf"'),
    _project("DEF330 cl_missing", _HEAD.replace('cl = ["part.cls"]\n', ""), "output", 'cl = ["part.cls"]\noutput'),
    _project("DEF330 no_output", _HEAD.replace("out.mpf", ""), '""', '"out.mpf"'),
    _project("DEF330 output_is_folder", _HEAD, '"out.mpf"', '"out.mpf/a.mpf"', before="mkdir out.mpf\n"),
    _project("DEF330 no_machine", _SETUPS.replace('machine = "yl569"\n', ""), "[[setup]]\nname = \"top\"",
             'machine = "yl569"\n[[setup]]\nname = "top"'),
    _project("DEF330 no_setups", f"setup = []\n{_HEAD}", "setup = []\n", ""),
    _project("DEF330 setup_name_twice", _SETUPS.replace("side", "top"), '"top"\ncl = ["two.cls"]',
             '"side"\ncl = ["two.cls"]'),
    _project("DEF330 beside_setups", f'output = "x.mpf"\n{_SETUPS}', 'output = "x.mpf"\n', ""),
    _project("DEF330 names_nothing", _HEAD + 'hooks = [""]\n', 'hooks = [""]\n', 'hooks = ["shop.py"]\n',
             before="write shop.py 'def on_block(block, context): return None'\n"),
    _project("DEF330 names_no_file", _HEAD.replace("part.cls", "other.cls"), "other.cls", "part.cls"),
    _project("DEF330 leads_out_of_project", _HEAD.replace("part.cls", "../part.cls"), "../", ""),
    _project("DEF330 word_to_fill", _HEAD + 'settings = { spindle = "OP1:RPM" }\n', "RPM", "900",
             "trunnion check p.toml"),
    _project("DEF330 setting_has_key", _HEAD + 'settings = { zero = "0,0,0" }\n', 'settings = { zero = "0,0,0" }',
             "zero_mm = [0, 0, 0]"),
    _project("DEF330 no_stock", _HEAD + 'stock = ""\n[checks]\nsimulate = "warn"\n', 'stock = ""', _CUT),
    _project("DEF330 ends_early", _HEAD + _CUT + 'until = 5\n[checks]\nsimulate = "warn"\n', "until = 5\n", ""),
    _project("DEF330 too_many_settings", _HEAD + _MANY_SETTINGS, _MANY_SETTINGS, ""),
    _project("DEF330 too_many_setups", 'machine = "yl569"\n' + _MANY_SETUPS + _ONE_SETUP, _MANY_SETUPS, ""),
    _project("DEF330 of_posted_program", 'machine = "yl569"\nprograms = ["part.mpf"]\nlisting = "a.html"\n' + _CUT,
             'listing = "a.html"\n', "",
             command="append part.mpf ''\ntrunnion check p.toml"),
    _project("DEF330 beside_output", _HEAD + 'programs = ["part.mpf"]\n', 'programs = ["part.mpf"]\n', "",
             before="append part.mpf ''\n"),
    _project("DEF330 one_paper_of_operations",
             _HEAD.replace("out.mpf", "out") + 'divide = "operations"\nlisting = "a.html"\n', 'listing = "a.html"\n',
             ""),
    _project("HOK150 runs_hooks", _HEAD + 'hooks = ["shop.py"]\n', 'hooks = ["shop.py"]\n', "",
             before="write shop.py 'def on_block(block, context): return None'\n"),
    script("PRJ310 no_folder_of_cases", f"{_CASE}\ntrunnion test part.cls", "test part.cls", "test c"),
    script("PRJ310 no_case", f"{_CASE}\nmkdir d\ntrunnion test d", "mkdir d",
           "mkdir d\ncp part.cls d/part.cls\ncp c/part.toml d/part.toml\ntrunnion post d/part.toml"),
    _project("PRJ230 takes_too_long", _HEAD + "[checks]\nlongest_s = 1\n", "longest_s = 1", "longest_s = 1000"),
    _project("PRJ220 moves_otherwise", _HEAD + 'released = ["part.mpf"]\n', '"part.mpf"', '"r.mpf"',
             before=f"append part.mpf ''\n{_RELEASED}"),
    _project("DEF210 extends_no_name", 'extends = "zzz"\n' + _HEAD, 'extends = "zzz"', 'extends = "project.toml"',
             before="append project.toml ''\n"),
    _project("DEF330 too_many_files", _HEAD.replace('"part.cls"', '"part.cls", ' * 1100), '"part.cls", ' * 1099, ""),
    _project("FIL220 no_such_folder_for", _HEAD.replace("out.mpf", "x/out.mpf"), "x/out.mpf", "out.mpf"),
    script("FIL220 no_such_folder_for", "edit project.toml out.mpf x/out.mpf\ntrunnion post project.toml",
           "edit", "mkdir x\nedit"),
    _project("FIL340 name_impossible", _HEAD.replace("out.mpf", "aux.mpf"), "aux.mpf", "top.mpf"),
    script("PRJ155 file_left_over", f"{_RENAMED}\ntrunnion post project.toml", _RENAMED, f"{_RENAMED}\nrm out.mpf"),
)  # fmt: skip
