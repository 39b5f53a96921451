"""The user's folders for what a program keeps between its runs, and for what it keeps while it runs."""

import os
import tempfile
from pathlib import Path


def user_cache() -> Path | None:
    """Return the folder of the user's caches (``%LOCALAPPDATA%``, else ``~/.cache``); None: the user has no home.

    It need not exist. A home that does not exist, as service accounts have, is not made.
    """
    local = os.environ.get("LOCALAPPDATA")
    try:
        home = Path(local) if local else Path.home()
    except RuntimeError:
        return None
    if not home.is_dir():
        return None
    return home if local else home / ".cache"


def user_data() -> Path | None:
    """Return the folder of the user's data (``%LOCALAPPDATA%``, ``$XDG_DATA_HOME``, else ``~/.local/share``);
    as above.
    """
    local = os.environ.get("LOCALAPPDATA") or os.environ.get("XDG_DATA_HOME")
    if local and Path(local).is_absolute():
        return Path(local)
    try:
        home = Path.home()
    except RuntimeError:
        return None
    return home / ".local" / "share" if home.is_dir() else None


def temporary_folder() -> Path | None:
    """Return the folder of temporary files; None: no file can be written there or in the folder of the command."""
    try:
        return Path(tempfile.gettempdir())
    except OSError:
        return None
