"""Texts of any script in the characters that a program can have."""

from hypothesis import given
from hypothesis import strategies as st

from trunnion.encoding import ENCODINGS
from trunnion.transliteration import lacking, spelled


def test_texts_are_spelled() -> None:
    expected = [
        ("plain (text); %", "ascii", "plain (text); %"),
        ("Gehäuse schlichten", "ascii", "Gehaeuse schlichten"),
        ("GRÖSSE", "ascii", "GROESSE"),
        ("Öffnung", "ascii", "Oeffnung"),
        ("ÜBERMASS Ä", "ascii", "UEBERMASS Ae"),
        ("a\u0308", "ascii", "ae"),  # an umlaut in two characters
        ("Maß", "ascii", "Mass"),
        ("轮毂粗加工", "ascii", "LunGuCuJiaGong"),
        ("轮毂 ä", "latin-1", "LunGu ä"),
        ("轮毂 ä", "gbk", "轮毂 ae"),
        ("轮毂 ä €", "utf-8", "轮毂 ä €"),
        ("Фреза Ø10", "ascii", "Freza O10"),
        ("\ue000", "ascii", "_"),  # nobody knows what it stands for
        ("a\nb\x85c\u2028d\x00e", "utf-8", "a b c d e"),
        ("hub\u202egnp.\u200f\ufeff", "utf-8", "hubgnp."),
        ("\udcff", "utf-8", ""),
        (
            "a\u034f\u17b4\u180e\ufe0f\U000e0041\ufdd0\U0001ffffb",
            "utf-8",
            "ab",
        ),  # joiners, selectors, tags, no characters
        ("a\u2800b\u3164c", "utf-8", "a b c"),  # letters that show nothing
        ("\ue000\U0010fffd", "utf-8", "__"),
        ("a\tb", "ascii", "a\tb"),
    ]
    assert [(text, encoding, spelled(text, encoding)) for text, encoding, _ in expected] == expected


@given(st.text(), st.sampled_from(ENCODINGS))
def test_every_text_can_be_written_and_is_one_line(text: str, encoding: str) -> None:
    found = spelled(text, encoding)
    assert found.encode(encoding).decode(encoding) == found
    assert not lacking(found, encoding)
    assert len(f"{found}.".splitlines()) == 1
    assert "?" not in found or "?" in text or not text.isascii()
    assert spelled(found, encoding) == found


def test_what_an_encoding_lacks_is_named() -> None:
    assert lacking("Maß 轮", "ascii") == "ß"
    assert lacking("Maß 轮", "latin-1") == "轮"
    assert lacking("Maß 轮", "utf-8") == ""
