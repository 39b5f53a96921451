"""Cures of messages about command lines: words that no command takes, or takes otherwise."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569"
_VERIFY: Final = "trunnion verify part.mpf --machine yl569"


def _typed(variant: str, line: str, old: str, new: str) -> Cure:
    return script(f"ARG120 {variant}", line, old, new)


CURES: Final = (
    script("ARG110 no_such_code", "trunnion explain XYZ999", "XYZ999", "CL110"),
    script("ARG110 no_such_code", "trunnion explain XYZ999", "XYZ999", "modal"),
    script("ARG110 no_such_code_but_near", "trunnion explain CL11", "CL11", "CL110"),
    _typed("no_command", "trunnion", "trunnion", "trunnion --help"),
    _typed("unknown_command", "trunnion mill", "mill", "--help"),
    _typed("unknown_command_but_near", "trunnion verfy part.mpf --machine yl569", "verfy", "verify"),
    _typed("unknown_option", f"{_VERIFY} --qqq", "--qqq", "--help"),
    _typed("unknown_option_but_near", f"{_VERIFY.replace('--machine', '--machne')}", "--machne", "--machine"),
    _typed("option_of_other", f"{_VERIFY} --tiles 3", "--tiles 3", "--help"),
    _typed("option_of_others", f"{_VERIFY} --output a.txt", "--output a.txt", "--help"),
    _typed("several_options", f"{_VERIFY} --to 5=110", "--to ", "--tool-length "),
    _typed("one_too_many", f"{_VERIFY} other.mpf", " other.mpf", ""),
    _typed("one_too_many", f"{_VERIFY} --set R5=1 R6=2", " R6", " --set R6"),
    _typed("one_too_many", f"{_POST} two.cls --output out.mpf", "part.cls --machine yl569 two.cls",
           "part.cls two.cls --machine yl569"),
    _typed("number_apart", f"{_VERIFY} --zero 1 2 3", "1 2 3", "1,2,3"),
    _typed("missing", "trunnion diff part.mpf --machine yl569", "part.mpf", "part.mpf part.mpf"),
    _typed("missing_behind_data", "trunnion info --json part.cls", "part.cls", "- part.cls"),
    _typed("wrong_value", f"{_VERIFY} --tolerance x", "--tolerance x", "--tolerance 0.1"),
    _typed("no_value", "trunnion verify part.mpf --machine", "--machine", "--machine yl569"),
    _typed("value_of_switch", f"{_POST} --force=yes", "--force=yes", "--force"),
    _typed("either", "trunnion convert part.mpf --machine yl569 --to-cl --to-machine dmu65", " --to-machine dmu65", ""),
    _typed("two_values", f"{_VERIFY} --machine dmu65", " --machine dmu65", ""),
    _typed("setting_twice", f"{_POST} --set tolerance=0.01 --set tolerance=0.02", " --set tolerance=0.02", ""),
    _typed("setting_twice", f"{_POST} --set mode=tcp --set mode=auto", "=tcp --set mode=auto", "=tcp,OP1:auto"),
    script("ARG210 unknown_but_near", f"{_POST} --set tool.mode=tcp", "tool.mode", "mode"),
    _typed("written_twice", f"{_VERIFY} --set R5=1 --set R5=2", " --set R5=2", ""),
    _typed("option_and_setting", f"{_POST} --set cl_units=mm --units mm", " --set cl_units=mm", ""),
    _typed("option_and_setting", f"{_POST} --set cl_units=mm --units mm", " --units mm", ""),
    _typed("project_among_files", "trunnion post project.toml two.cls", " two.cls", ""),
    _typed("forced_project", "trunnion post project.toml --force", "project.toml", "part.cls --machine yl569"),
    _typed("not_with_project", "trunnion post project.toml --machine yl569", " --machine yl569", ""),
    _typed("not_with_project", "trunnion post project.toml --machine yl569", "project.toml", "part.cls"),
)  # fmt: skip
