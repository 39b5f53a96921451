"""What tries a cure with one function: it reads a file or a text, and warns or refuses."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from trunnion.errors import Problem, TrunnionError


def ended(call: Callable[[], object], heard: list[Problem] | None = None) -> Outcome:
    """Return what a call says: what was heard of it, and its refusal."""
    found = [] if heard is None else heard
    try:
        call()
    except TrunnionError as error:
        return Outcome((*found, *error.problems), False)
    return Outcome(tuple(found), True)


def text_of(read: Callable[..., object]) -> Trial:
    """Return what gives a text to a function, and settings as its arguments."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        return ended(lambda: read(text, **settings))

    return tried


def file_of(name: str, read: Callable[..., object], *, warns: bool = False, **how: Any) -> Trial:
    """Return what writes a text into a file of a name and has it read; a letter is a byte if the name is no text's.

    warns  the function takes ``warn``, which hears what is odd
    how    further arguments
    """
    encoding = "utf-8" if name.endswith((".toml", ".csv", ".txt", ".cls")) else "latin-1"

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file, heard = folder / name, list[Problem]()
        file.write_bytes(text.encode(encoding))
        hears = {"warn": heard.append} if warns else {}
        return ended(lambda: read(file, **hears, **how, **settings), heard)

    return tried


def limited(trial: Trial, module: ModuleType, name: str, limit: float) -> Trial:
    """Return a trial under a limit that small files reach."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.object(module, name, limit):
            return trial(text, settings, folder)

    return tried


def whole(code: str, trial: Trial) -> Callable[[str, str, str], Cure]:
    """Return what makes rows of a code from a variant, a text, and the text in its place."""
    return lambda variant, text, cured: Cure(code, variant, trial, text, ((text, cured),))
