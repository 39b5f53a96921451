"""Packages of optional extras, imported when something needs them."""

import importlib
import sys
from typing import Any

from trunnion.errors import MissingExtraError, Problem
from trunnion.messages import Wording


def import_extra(module: str, extra: str) -> Any:
    """Import a module of an optional extra.

    Raises ``MissingExtraError`` if it is not installed, with the command that installs it.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        missing = Wording("ARG150", "needs_not_installed", module=module, extra=extra, python=sys.executable)
        raise MissingExtraError(Problem("trunnion", 0, missing)) from None
