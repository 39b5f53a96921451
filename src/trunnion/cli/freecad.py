"""``trunnion freecad``: puts the post for FreeCAD where FreeCAD looks, and takes it back."""

import json
import os
import sys
from importlib.resources import files
from pathlib import Path
from typing import Final

from trunnion.cli.printing import print_result
from trunnion.cli.wording import in_words
from trunnion.files import output_group, resolve_output
from trunnion.jobs.job import Given
from trunnion.messages import phrase

_POST: Final = "trunnion_post.py"
_COMMAND: Final = "trunnion_post.json"


def macro_folder() -> Path:
    """Return the folder of macros of FreeCAD, in which it looks for posts."""
    if sys.platform == "win32":
        data = Path(os.environ.get("APPDATA", Path.home()))
    elif sys.platform == "darwin":
        data = Path.home() / "Library" / "Application Support"
    else:
        data = Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share")
    return data / "FreeCAD" / "Macro"


def run(given: Given) -> int:
    """Write the post and the command that it runs, or remove both."""
    folder = Path(given.folder) if given.folder else macro_folder()
    names = (_POST, _COMMAND)
    if given.remove:
        found = [folder / name for name in names if (folder / name).is_file()]
        for path in found:
            path.unlink()
        print_result(in_words(phrase("post_removed" if found else "post_not_there", folder=str(folder))))
        return 0
    folder.mkdir(parents=True, exist_ok=True)
    post = files("trunnion").joinpath("doors", _POST).read_text(encoding="utf-8")
    command = json.dumps({"command": [sys.executable, "-E", "-m", "trunnion"]}, indent=1)
    with output_group(remembers=False) as group:
        for name, text in ((_POST, post), (_COMMAND, command + "\n")):
            with group.open(resolve_output(folder / name)) as output:
                output.main.write(text.encode())
    print_result(in_words(phrase("post_installed", folder=str(folder))))
    return 0
