"""The user's folder for what a program keeps between its runs."""

import os
from pathlib import Path


def user_cache() -> Path | None:
    """The folder of the user's caches (``%LOCALAPPDATA%``, else ``~/.cache``); None: the user has no home.

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
