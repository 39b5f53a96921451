"""Packages of optional extras, imported when something needs them."""

import importlib
from typing import Any

from trunnion.errors import InputError, Problem


def import_extra(module: str, extra: str) -> Any:
    """Import a module of an optional extra.

    Raises
    ------
    InputError
        If it is not installed, with the command that installs it.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        what, cure = f"needs {module}, which is not installed", f'pip install "trunnion[{extra}]"'
        raise InputError(Problem("trunnion", 0, what, cure, code="ARG150")) from None
