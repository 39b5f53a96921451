"""Packages of optional extras, imported when something needs them."""

import importlib
from typing import Any

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording


def import_extra(module: str, extra: str) -> Any:
    """Import a module of an optional extra.

    Raises ``InputError`` if it is not installed, with the command that installs it.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        raise InputError(
            Problem("trunnion", 0, Wording("ARG150", "needs_not_installed", module=module, extra=extra))
        ) from None
