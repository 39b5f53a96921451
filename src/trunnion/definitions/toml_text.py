"""Values and keys as TOML."""

import json
import re
from typing import Final

from trunnion.transliteration import is_seen

_BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]+")

#: Of a text of several lines: what cannot stand in it as it is.
_ESCAPES: Final = re.compile(r'[\\\x00-\x08\x0b-\x1f\x7f]|"""')


def written(value: object) -> str:
    """Return a value as TOML; a number without a point where it is whole."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(map(written, value))}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{written_key(key)} = {written(item)}' for key, item in value.items())} }}"
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    if isinstance(value, str):
        return _lines(value) if "\n" in value else _quoted(value)
    return str(value)


def written_key(step: object) -> str:
    """Return a key as TOML, in quotes where it needs them."""
    text = str(step)
    return text if _BARE_KEY.fullmatch(text) else _quoted(text)


def _quoted(text: str) -> str:
    return _visible(json.dumps(text, ensure_ascii=False))


def _visible(text: str) -> str:
    """Return a text with an escape for each character that nobody sees, or that a terminal obeys; line ends and tabs
    stay.
    """
    if text.isprintable():
        return text
    return "".join(letter if is_seen(letter) or letter in "\n\t" else _escape(letter) for letter in text)


def _escape(letter: str) -> str:
    return f"\\u{ord(letter):04x}" if ord(letter) < 0x10000 else f"\\U{ord(letter):08x}"


def _lines(text: str) -> str:
    def escape(match: re.Match[str]) -> str:
        found = match.group()
        return '""\\"' if found == '"""' else "\\\\" if found == "\\" else f"\\u{ord(found):04x}"

    escaped = _visible(_ESCAPES.sub(escape, text))
    return f'"""\n{escaped}"""' if not escaped.endswith('"') else f'"""\n{escaped[:-1]}\\""""'
