"""Translations have the parameters of the English texts, and completed rooms have no text that is missing or stale."""

import re
from collections import Counter

import pytest

from tests.support.translations import (
    TRANSLATED,
    completed,
    english,
    missing,
    rooms,
    stale,
    translated,
    wrong_fields,
)
from trunnion import messages
from trunnion.jobs.describe.controls import describe_control
from trunnion.messages import DECLARED, LANGUAGES, Wording, Words, catalogue, declared, said_in


class Spoken(Words):
    def __init__(self, language: str) -> None:
        self.language = language


@pytest.mark.parametrize("language", TRANSLATED)
def test_parameters_are_those_of_the_english_text(language: str) -> None:
    assert not wrong_fields(language), "\n".join(wrong_fields(language))


@pytest.mark.parametrize("language", TRANSLATED)
def test_files_are_named_as_in_english(language: str) -> None:
    assert set(rooms(language)) <= {*rooms(), DECLARED}


def lag(language: str) -> dict[str, list[str]]:
    """What is missing or stale, by the rooms that are completed."""
    done = set(completed()[language])
    behind = [key for key in (*missing(language), *stale(language)) if key.room in done]
    return {room: [key.path for key in behind if key.room == room] for room in sorted({key.room for key in behind})}


@pytest.mark.parametrize("language", TRANSLATED)
def test_completed_rooms_lag_by_few_texts(language: str) -> None:
    """Who changes an English message need not know the other languages; nightly wants them all."""
    sizes = Counter(key.room for key in english())
    far = {room: paths for room, paths in lag(language).items() if len(paths) > max(5, sizes[room] // 20)}
    assert not far, f"python -m tests.support.translations {language}\n{far}"
    assert set(completed()[language]) <= {*rooms(), DECLARED}


@pytest.mark.nightly
@pytest.mark.parametrize("language", TRANSLATED)
def test_completed_rooms_have_nothing_missing_or_stale(language: str) -> None:
    assert not lag(language), f"python -m tests.support.translations {language}"


@pytest.mark.parametrize("language", TRANSLATED)
def test_translations_keep_what_is_typed_and_read_by_machines(language: str) -> None:
    """Codes, options, keys in brackets and what stands in backquotes are those of the English text."""
    behind = set(stale(language))
    changed = [
        f"{key.room} {key.path}: {sorted(typed(english()[key]) ^ typed(text))}"
        for key, text in translated(language).items()
        if key not in behind and typed(english()[key]) != typed(text)
    ]
    assert not changed, "\n".join(changed)


def typed(text: str) -> set[str]:
    """What is typed: options, and code in backquotes."""
    return set(re.findall(r"`[^`]+`|(?<![\w-])--[a-z][a-z-]+", text))


@pytest.mark.parametrize(
    "entry", [{"": {}}, {"FIL130": {}}, {"FIL130": {"folder_not": {"what": "{none}"}}}, {"FIL130": "odd"}]
)
def test_a_language_that_lacks_a_text_says_it_in_english(
    entry: dict[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    wording = Wording("FIL130", "folder_not", subject="x")
    said = wording.text("what")
    monkeypatch.setattr(
        messages, "catalogue", lambda language, name: entry if language == "zh" else catalogue(language, name)
    )
    assert wording.text("what", Spoken("zh")) == said


def test_a_text_without_parameters_falls_back_as_well() -> None:
    assert said_in("en", "help", "words", "usage") == "usage:"
    assert said_in("zh", "help", "no", "such", english="as declared") == "as declared"
    assert said_in("xx", "help", "words", "usage") == "usage:"


@pytest.mark.parametrize("language", LANGUAGES)
def test_parts_are_said_in_the_language_of_the_whole(language: str) -> None:
    inner = Wording("FIL130", "folder_not", subject="x")
    outer = Wording("", "with_cure", fault=inner)
    assert inner.text("what", Spoken(language)) in outer.text("what", Spoken(language))


def test_what_stands_where_it_is_declared_is_said_in_the_language_and_what_anybody_else_declares_as_it_is() -> None:
    control = describe_control("linuxcnc")
    tool = next(setting for setting in control.settings if setting.name == "tool")
    assert tool.meant.text("what", Spoken("en")) == tool.meaning
    assert "LOAD/TOOL" in tool.meant.text("what", Spoken("zh")) != tool.meaning
    assert declared("Ours.", "meanings", "tool").text("what", Spoken("zh")) == "Ours."
