"""The language of the command line: ``--language``, ``TRUNNION_LANGUAGE``, else that of the terminal or the system."""

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

from trunnion.messages import ENGLISH, LANGUAGES

#: The option, which every command has.
LANGUAGE: Final = "--language"

#: What states the language for all commands.
_OWN_VARIABLE: Final = "TRUNNION_LANGUAGE"

#: What says the language of messages, the first that is set: as POSIX orders them.
_VARIABLES: Final = ("LC_ALL", "LC_MESSAGES", "LANG")

#: Primary languages of Windows, as the low ten bits of a language identifier have them.
_OF_WINDOWS: Final = {0x04: "zh", 0x07: "de", 0x09: "en"}

#: Letters of each language that a terminal without them cannot show.
_LETTERS: Final = {"zh": "中文", "de": "äöüß"}

_SPOKEN: Final[ContextVar[str]] = ContextVar("language", default=ENGLISH)
_STATED: Final[ContextVar[str]] = ContextVar("stated", default="")


def spoken_language() -> str:
    """Return the language of the command that runs."""
    return _SPOKEN.get()


def stated_language() -> str:
    """Return the language that the user has stated; empty if only the surroundings say one."""
    return _STATED.get()


@contextmanager
def speaking(language: str) -> Iterator[None]:
    """Have the command line speak a language; empty: that of the surroundings."""
    spoken, stated = _SPOKEN.set(language or _of_surroundings()), _STATED.set(language)
    try:
        yield
    finally:
        _SPOKEN.reset(spoken)
        _STATED.reset(stated)


def is_language_option(name: str) -> bool:
    """Whether a word is the option, or an abbreviation of it."""
    return name.startswith("--lang") and LANGUAGE.startswith(name)


def with_language(words: Sequence[str]) -> tuple[list[str], str]:
    """Return the words without a language that is known, and the language that is stated; the last one counts.

    Words that name none stay, and the parser says what is wrong with them. The language is empty where neither words
    nor ``TRUNNION_LANGUAGE`` state one.
    """
    rest, chosen, k = [], "", 0
    while k < len(words) and words[k] != "--":
        name, equals, value = words[k].partition("=")
        apart = not equals and k + 1 < len(words)
        if is_language_option(name) and (value or (words[k + 1] if apart else "")) in LANGUAGES:
            chosen = value or words[k + 1]
            k += 2 if apart else 1
            continue
        rest.append(words[k])
        k += 1
    return [*rest, *words[k:]], chosen or _named(os.environ.get(_OWN_VARIABLE, ""))


def _named(stated: str) -> str:
    """Return the language of a locale such as ``zh_CN.UTF-8``; empty if there is none of ours in it."""
    language = stated[:2].lower() if stated[2:3] in ("", "_", "-", ".", "@") else ""
    return language if language in LANGUAGES else ""


def _of_surroundings() -> str:
    """Return the language of the terminal or the system, where a terminal can show its letters."""
    stated = next((value for name in _VARIABLES if (value := os.environ.get(name))), "")
    language = _named(stated)
    if not stated and sys.platform == "win32":
        import ctypes  # nothing else needs it

        language = _OF_WINDOWS.get(ctypes.windll.kernel32.GetUserDefaultUILanguage() & 0x3FF, ENGLISH)
    return language if language and _is_shown(language) else ENGLISH


def _is_shown(language: str) -> bool:
    for stream in (sys.stdout, sys.stderr):
        try:
            _LETTERS.get(language, "").encode(getattr(stream, "encoding", None) or "utf-8")
        except (UnicodeEncodeError, LookupError):
            return False
    return True


def follow_terminals() -> None:
    """Write what each stream can show: a terminal in its encoding, files and pipes in UTF-8.

    ``PYTHONIOENCODING`` has the last word. What an encoding lacks becomes a question mark.
    """
    stated = os.environ.get("PYTHONIOENCODING", "").partition(":")[0]
    for stream in (sys.stdout, sys.stderr):
        if not hasattr(stream, "reconfigure"):
            continue
        if stream.isatty() and not stated:
            stream.reconfigure(errors="replace")
            continue
        try:
            stream.reconfigure(encoding=stated or "utf-8", errors="replace")
        except LookupError:
            stream.reconfigure(encoding="utf-8", errors="replace")
