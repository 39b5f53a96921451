"""Tables of words: what a record says of several words, and what a later one changes."""

import pytest

from trunnion.readers.program.word_values import one_of
from trunnion.readers.rs274.word_table import Effect, When, Word, WordTable

TABLE = WordTable(
    Word("G17 G18 G19", "plane", act="plane", sets=(2, 1, 0), group="plane"),
    Word("G18", "another plane", act="plane", sets=7, group="plane", values={"Q": one_of(1)}),
    Word("G40 G54.1", effect=Effect.NONE),
    Word("G65", calls=True, when=When.BEHIND_MODES),
    Word("G: smoothness"),
    Word("M100..M102", act="user", own=False),
    modes=When.BEFORE_FEED,
)


def test_a_later_record_of_a_word_counts() -> None:
    assert [(word.text, word.sets, word.does) for word in TABLE.words("G", [170, 180, 190])] == [
        ("G17", 2, "plane"),
        ("G18", 7, "another plane"),
        ("G19", 0, "plane"),
    ]
    assert TABLE.groups == {"G": (frozenset({170, 180, 190}),), "M": ()}


def test_a_range_stands_for_all_words_between_its_ends() -> None:
    assert [word.text for word in TABLE.words("M", [100, 101, 102, 103]) if word.act] == ["M100", "M101", "M102"]


def test_a_word_that_a_table_does_not_have_is_unknown_and_acts_when_modes_do() -> None:
    (word,) = TABLE.words("G", [123])
    assert (word.text, word.effect, word.when) == ("G12.3", Effect.UNKNOWN, When.BEFORE_FEED)
    assert TABLE.words("M", [7])[0].when is When.BEFORE_MOTION


def test_a_meaning_has_a_code_that_no_program_writes() -> None:
    assert TABLE.code("G: smoothness") == TABLE.meanings["G"]["smoothness"] < 0


def test_words_without_effect_on_the_path_are_listed_as_written() -> None:
    assert TABLE.without_path == {"G40", "G54.1"}


@pytest.mark.parametrize(
    ("word", "own"),
    [
        ("G17", True),
        ("G17 X1", True),
        ("G65", True),
        ("G65 P9810", False),
        ("G99", False),
        ("M101", False),
        ("X1.5", True),
        ("CLAMP", False),
    ],
)
def test_own_words_are_those_of_the_table_and_addresses(word: str, own: bool) -> None:
    assert TABLE.is_own(word) is own
