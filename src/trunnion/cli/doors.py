"""``trunnion freecad`` and ``trunnion fusion``: put a post where a CAM system looks, and take it back."""

import json
import os
import sys
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from trunnion.cli.printing import print_result, tell_problem
from trunnion.cli.wording import in_words, problem_line
from trunnion.errors import InputError, argument_problem, warning
from trunnion.files import EarlierJob, output_group, resolve_output
from trunnion.files.places import cannot_write
from trunnion.jobs.job import Given
from trunnion.messages import Wording, phrase

_FREECAD_POST: Final = "trunnion_post.py"
_FREECAD_COMMAND: Final = "trunnion_post.json"
_FUSION_POST: Final = "trunnion.cps"

#: Where FreeCAD's settings have the folder of macros that the user has chosen.
_MACRO_PATH: Final = ".//FCParamGroup[@Name='BaseApp']/FCParamGroup[@Name='Preferences']/FCParamGroup[@Name='Macro']"

#: Settings that are larger are not read.
_MOST_BYTES: Final = 50_000_000


def macro_folder() -> Path:
    """Return the folder of FreeCAD's macros, in which it looks for posts: the one that its user has chosen, or its own.

    FreeCAD 1.1 has folders of settings and data with its version in their names; the newest one counts.
    """
    settings, data = _freecad_folders()
    found = [*settings.glob("v*-*/user.cfg"), settings / "user.cfg"]
    written = sorted((file for file in found if file.is_file()), key=lambda file: file.stat().st_mtime)
    if not written:
        return data / "Macro"
    version = written[-1].parent.relative_to(settings)
    return _chosen_folder(written[-1]) or data / version / "Macro"


def _freecad_folders() -> tuple[Path, Path]:
    """Return FreeCAD's folders of settings and of data."""
    if sys.platform == "win32":
        both = Path(os.environ.get("APPDATA", Path.home())) / "FreeCAD"
        return both, both
    if sys.platform == "darwin":
        library = Path.home() / "Library"
        return library / "Preferences" / "FreeCAD", library / "Application Support" / "FreeCAD"
    own = Path.home()
    settings = Path(os.environ.get("XDG_CONFIG_HOME") or own / ".config")
    data = Path(os.environ.get("XDG_DATA_HOME") or own / ".local" / "share")
    return settings / "FreeCAD", data / "FreeCAD"


def _chosen_folder(settings: Path) -> Path | None:
    """Return the folder of macros that settings of FreeCAD state; None where they state none."""
    if settings.stat().st_size > _MOST_BYTES:
        return None
    try:
        group = ElementTree.parse(settings).find(_MACRO_PATH)
    except (ElementTree.ParseError, OSError):
        return None
    texts = [] if group is None else [each for each in group if each.get("Name") == "MacroPath"]
    text = (texts[0].text or "").strip() if texts else ""
    return Path(text) if text and Path(text).is_absolute() else None


def posts_folder() -> Path | None:
    """Return the folder of Fusion's local posts; None where Fusion does not run."""
    system: str = sys.platform
    if system == "win32":
        above = [Path(os.environ.get("APPDATA", Path.home()))]
    elif system == "darwin":
        above = [Path.home(), Path.home() / "Library" / "Application Support"]
    else:
        return None
    folders = [each / "Autodesk" / "Fusion 360 CAM" / "Posts" for each in above]
    return next((each for each in folders if each.is_dir()), folders[0])


def run_freecad(given: Given) -> int:
    """Write the post for FreeCAD and the command that it runs, or remove both."""
    command = json.dumps({"command": [sys.executable, "-E", "-m", "trunnion"]}, indent=1) + "\n"
    folder = Path(given.folder) if given.folder else macro_folder()
    return _install(
        given, folder, {_FREECAD_POST: _shipped(_FREECAD_POST), _FREECAD_COMMAND: command}, "post_installed"
    )


def run_fusion(given: Given) -> int:
    """Write the post for Fusion, HSMWorks and Inventor CAM, or remove it."""
    folder = Path(given.folder) if given.folder else posts_folder()
    if folder is None:
        raise InputError(argument_problem("folder", Wording("ARG140", "no_fusion_here")))
    return _install(given, folder, {_FUSION_POST: _shipped(_FUSION_POST)}, "fusion_post_installed")


def _shipped(name: str) -> str:
    return files("trunnion").joinpath("doors", name).read_text(encoding="utf-8")


def _install(given: Given, folder: Path, texts: Mapping[str, str], done: str) -> int:
    """Write files into a folder, or remove them there."""
    if given.remove:
        found = [folder / name for name in texts if (folder / name).is_file()]
        for path in found:
            path.unlink()
        print_result(in_words(phrase("post_removed" if found else "post_not_there", folder=str(folder))))
        return 0
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(str(folder), error) from None
    with output_group() as group:
        for name, text in texts.items():
            place = resolve_output(folder / name)
            # What was edited since it was installed is kept; what no installation is known to have written is replaced.
            edited = "keep" if EarlierJob(place.path).has_edited(place.path) else "replace"
            with group.open(place, edited=edited) as output:
                output.main.write(text.encode())
            for at, kept in output.kept:
                tell_problem(problem_line(warning(at.name, 0, Wording("FIL250", "kept", name=kept.path.name))))
    print_result(in_words(phrase(done, folder=str(folder))))
    return 0
