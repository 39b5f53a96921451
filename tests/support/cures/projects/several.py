"""Cures of messages about projects of several programs, and files of jobs."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script
from tests.support.example_impellers import EXAMPLES

_POST: Final = "trunnion post p.toml"
_IMPELLER: Final = repr((EXAMPLES / "impeller.toml").as_posix())
_HEAD: Final = 'machine = "yl569"\ncl = ["part.cls"]\noutput = "out.mpf"\n'
_EACH: Final = _HEAD.replace("part.cls", 'part.cls", "two.cls').replace('"out.mpf"', '"out.mpf"\ndivide = "operations"')
_SETUPS: Final = (
    'machine = "yl569"\n[[setup]]\nname = "top"\ncl = ["part.cls"]\noutput = "a.mpf"\n'
    '[[setup]]\nname = "side"\ncl = ["two.cls"]\noutput = "b.mpf"\n'
)
_CUT: Final = 'stock = "box:9,9,9"\ncell_mm = 1\nzero_mm = [0, 0, 0]\ntool_length_mm = 100\n'
_CASE: Final = (
    "mkdir c/a\nmkdir c/b\ncp part.cls c/a/part.cls\ncp part.cls c/b/part.cls\ncp project.toml c/a/case.toml\n"
    "cp project.toml c/b/case.toml\ntrunnion post c/a/case.toml\ntrunnion post c/b/case.toml\n"
    "set trunnion.jobs.post_project.cases._MOST_CASES 1\ntrunnion test c"
)
_RENAMED: Final = "trunnion post p.toml\nedit p.toml out.mpf b.mpf\nedit p.toml a.html c.html"
_JOBS: Final = 'results = "out"\n[[job]]\naction = "verify"\nfiles = ["part.mpf"]\nmachine = "yl569"\n'
_FEW: Final = "set trunnion.jobs.post.left_over_files._MOST_NAMED 1\n"
_SECOND: Final = '[[job]]\nname = "b"\nfiles = ["part.mpf"]\nmachine = "yl569"\naction = "verify"\n'


def _project(message: str, text: str, old: str, new: str, command: str = _POST, before: str = "") -> Cure:
    """A project that is posted, and what stands in place of a part of it; both CL files are there."""
    wrap = [each.replace("\n", "\\n") for each in (text, old, new)]
    return script(
        message, f"append part.cls ''\nappend two.cls ''\n{before}write p.toml '{wrap[0]}'\n{command}", *wrap[1:]
    )


def _after(message: str, text: str, command: str, old: str, new: str, before: str = "") -> Cure:
    """A project, and what is changed in the commands that follow it."""
    lines = text.replace("\n", "\\n")
    return script(
        message, f"append part.cls ''\nappend two.cls ''\n{before}write p.toml '{lines}'\n{command}", old, new
    )


def _jobs(message: str, text: str, old: str, new: str, before: str = "") -> Cure:
    wrap = [each.replace("\n", "\\n") for each in (text, old, new)]
    return script(
        message, f"append part.mpf ''\n{before}write jobs.toml '{wrap[0]}'\ntrunnion batch jobs.toml", *wrap[1:]
    )


CURES: Final = (
    script("DEF110 file_not_found", "trunnion.load_impeller('zzz')", "'zzz'", _IMPELLER),
    script("DEF140 definition_is_folder", "mkdir in\ntrunnion.load_impeller('in')", "'in'", _IMPELLER),
    script("DEF140 not_whose", "trunnion.load_impeller('part.cls')", "'part.cls'", _IMPELLER),
    script(
        "DEF140 not_whose_name_ends", "cp project.toml p.TOML\ntrunnion.load_impeller('p.TOML')", "'p.TOML'", _IMPELLER
    ),
    _project("DEF330 pose_of_first", _SETUPS.replace('"top"', '"top"\npose = "A90"'), 'pose = "A90"\n', ""),
    _project(
        "DEF330 no_programs",
        'machine = "yl569"\nprograms = []\n' + _CUT,
        "[]",
        '["part.mpf"]',
        before="append part.mpf ''\n",
        command="trunnion check p.toml",
    ),
    _project(
        "DEF330 setting_and_key",
        _HEAD + 'work_offset = "G54"\nsettings = { work_offset = "G54" }\n',
        'settings = { work_offset = "G54" }\n',
        "",
    ),
    _jobs(
        "DEF330 tables",
        _JOBS.replace("action", 'name = "a"\naction') + _SECOND,
        _SECOND,
        "",
        before="set trunnion.batch.jobs_file._MOST_JOBS 1\n",
    ),
    _jobs("DEF330 leads_out_folder", _JOBS.replace('"out"', '"l"'), '"l"', '"out"', before="mkdir x/y\nlink .. l\n"),
    _project(
        "PRJ110 too_many_files",
        _EACH,
        'part.cls", "two.cls',
        "part.cls",
        before="set trunnion.jobs.project.paths._MOST_NAMES 2\n",
    ),
    _after(
        "PRJ120 leads_out_of_folder",
        _EACH,
        f"link ../a.spf out_1_OP1.mpf\n{_POST}",
        "trunnion",
        "rm out_1_OP1.mpf\ntrunnion",
    ),
    script("PRJ310 too_many_cases", _CASE, "trunnion test c", "trunnion test c/a"),
    _after(
        "PRJ150 operation_gone",
        _EACH,
        "trunnion post p.toml\nedit p.toml ', \"two.cls\"' ''\ntrunnion post p.toml",
        "''\ntrunnion",
        "''\nrm out_2_OP2.mpf\ntrunnion",
    ),
    _after(
        "PRJ155 files_left_over",
        _HEAD + 'listing = "a.html"\n',
        f"{_RENAMED}\n{_POST}",
        _RENAMED,
        f"{_RENAMED}\nrm out.mpf\nrm a.html",
    ),
    _after(
        "PRJ155 many_files_left_over",
        _HEAD + 'listing = "a.html"\n',
        f"{_FEW}{_RENAMED}\n{_POST}",
        _RENAMED,
        f"{_RENAMED}\nrm out.mpf\nrm a.html",
    ),
    _project(
        "PRJ220 other_number_of_programs",
        _EACH + 'released = ["r.mpf"]\n',
        '"r.mpf"',
        '"r.mpf", "s.mpf"',
        before="trunnion post part.cls --machine yl569 --output r.mpf\n"
        "trunnion post two.cls --machine yl569 --output s.mpf\n",
    ),
)
