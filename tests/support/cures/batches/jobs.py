"""Cures of messages about batches: files of jobs, folders, and places for results."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script

_HEAD: Final = 'results = "out"\n[[job]]\naction = "verify"\nfiles = ["*.mpf"]\nmachine = "yl569"\n'
_FOLDER: Final = "mkdir in\ncp part.mpf in/a.mpf\ntrunnion batch in --action verify --machine yl569 --results out"

_SECOND: Final = '[[job]]\nname = "a"\nfiles = ["*.mpf"]\nmachine = "yl569"\naction = "verify"\n'
_MANY_SETTINGS: Final = "settings = { " + ", ".join(f"a{k} = 1" for k in range(2000)) + " }\n"
_LINKED: Final = (
    "mkdir in/b\ncp part.mpf in/b/a.mpf\nmkdir out\nmkdir x\nlink ../x out/b\n"
    + _FOLDER.rpartition("\n")[2]
    + " --report json"
)
_BESIDE: Final = (
    "mkdir in\ncp part.mpf in/a.mpf\ncp part.mpf real.spf\nlink ../real.spf in/a.spf\nwrite in/jobs.toml '"
    + (_HEAD + 'subprograms = ["{folder}/{stem}.spf"]\n').replace("\n", "\\n")
    + "'\ntrunnion batch in/jobs.toml"
)


def _jobs(message: str, text: str, old: str, new: str, before: str = "") -> Cure:
    """A file of jobs beside a program, and what stands in place of a part of it."""
    wrap = [each.replace("\n", "\\n") for each in (text, old, new)]
    return script(
        message, f"append part.mpf ''\n{before}write jobs.toml '{wrap[0]}'\ntrunnion batch jobs.toml", *wrap[1:]
    )


CURES: Final = (
    _jobs("BAT110 stated_besides_settings", _HEAD.replace("verify", "post").replace("*.mpf", "part.cls")
          + 'tool_length_mm = 100\nsettings = { tool_length = "100" }\n', "tool_length_mm = 100\n", ""),
    _jobs("BAT110 turns_cl_files", _HEAD + "turn_deg = 5\n", "turn_deg = 5\n", ""),
    _jobs("BAT110 no_meaning_action", _HEAD + 'stock = "box:9,9,9"\n', 'stock = "box:9,9,9"\n', ""),
    _jobs("BAT120 matches_nothing", _HEAD.replace("*.mpf", "*.xyz"), "*.xyz", "*.mpf"),
    _jobs("BAT120 matches_no_file", _HEAD.replace("*.mpf", "*.toml"), "*.toml", "*.mpf"),
    _jobs("BAT120 matches_no", _HEAD.replace("*.mpf", "out/*.mpf"), "out/*.mpf", "*.mpf",
          before="mkdir out\ncp part.mpf out/a.mpf\n"),
    _jobs("BAT380 result_would_another",
          _HEAD.replace("verify", "convert").replace('"*.mpf"', '"a.mpf", "a.MPF"') + "to_cl = true\n", ', "a.MPF"', "",

          before="cp part.mpf a.mpf\ncp part.mpf a.MPF\n"),
    _jobs("DEF330 twice", _HEAD.replace("action", 'name = "a"\naction') + _SECOND, 'name = "a"\nfiles',
          'name = "b"\nfiles'),
    _jobs("DEF330 keys", _HEAD + _MANY_SETTINGS, _MANY_SETTINGS, ""),
    _jobs("DEF330 no_pattern", _HEAD.replace("*.mpf", "/*.mpf"), "/*.mpf", "*.mpf"),
    _jobs("DEF330 no_patterns", _HEAD.replace('"*.mpf"', ""), "[]", '["**/*.mpf"]'),
    _jobs("DEF330 patterns", _HEAD.replace('"*.mpf"', ", ".join(['"*.mpf"'] * 2000)), ", ".join(['"*.mpf"'] * 2000),
          '"*.mpf"'),
    _jobs("DEF330 no_name_beside", _HEAD + 'subprograms = ["/a.spf"]\n', "/a.spf", "{folder}/{stem}.spf",
          before="cp part.mpf part.spf\n"),
    script("FIL120 goes_leads_out", _BESIDE, "link ../real.spf", "cp real.spf"),
    script("BAT120 no_files", _FOLDER.replace("in/a.mpf", "in/a.xyz"), "--machine", "--files '**/*.xyz' --machine"),
    script("BAT120 no_files_match", _FOLDER + " --files '*.nc'", "*.nc", "**/*.mpf"),
    script("BAT320 result_would_leads", _LINKED, "link ../x out/b\n", ""),
    script("BAT130 no_place_results", f"{_FOLDER[:-3]}zzz://bucket/folder", "zzz://bucket/folder", "out"),
    _jobs("FIL340 no_folder_name", _HEAD.replace('"out"', '"~/out"'), "~/out", "out"),
    _jobs("FIL340 name_of_no_folder", _HEAD.replace('"out"', '"aux"'), "aux", "out"),
    script("FIL230 file", f"append part.cls ''\n{_FOLDER[:-3]}part.cls", "--results part.cls", "--results out"),
    script("FIL250 already_no_summary", f"write s.sqlite ours\n{_FOLDER} --summary s.sqlite", "--summary s.sqlite",
           "--summary t.sqlite"),
    script("FIL240 result_over_input",
           _FOLDER.replace("verify", "convert --to-machine yl569 --files '*.mpf'").replace("results out", "results in"),

           "--results in", "--results out"),
)  # fmt: skip
