"""Text templates: lines with ``{name}`` and ``{name:format}`` in them.

A template can print values and nothing else: it computes nothing and reads nothing. A line that names a value which
is absent is left out whole, so that a program without a date has no line for one; a part in double brackets, such as
``TOOL CALL {tool}[[ S{speed}]]``, is left out alone.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from trunnion.controls.words import NumberFormat
from trunnion.errors import InputError, Problem

Value = str | float | None

_OPTIONAL_PART = re.compile(r"\[\[(.*?)\]\]")
_FIELD = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)(?::([A-Za-z_][A-Za-z0-9_]*))?\}")


@dataclass(frozen=True, slots=True)
class Template:
    """The lines of one template, and where it stands in its definition."""

    name: str
    lines: tuple[str, ...]
    file: str = ""
    line: int = 0

    def fields(self) -> set[tuple[str, str]]:
        """Every (name, format) that the template asks for; format is empty where none is named."""
        return {(name, form or "") for text in self.lines for name, form in _FIELD.findall(text)}

    def expand(self, values: Mapping[str, Value], formats: Mapping[str, NumberFormat]) -> list[str]:
        """The lines with their values; those that name an absent value are left out, and so are such parts of them.

        Raises
        ------
        InputError
            When a value that must be a number is none.
        """

        def printed(match: re.Match[str]) -> str:
            value = values[match[1]]
            if match[2]:
                return formats[match[2]].text(self._number(match[1], value))
            return f"{value:g}" if isinstance(value, float) else str(value)

        def known(text: str) -> bool:
            return all(values[name] not in (None, "") for name, _ in _FIELD.findall(text))

        lines = [_OPTIONAL_PART.sub(lambda part: part[1] if known(part[1]) else "", text) for text in self.lines]
        return [_FIELD.sub(printed, text) for text in lines if known(text)]

    def _number(self, name: str, value: Value) -> float:
        try:
            return float(value)  # type: ignore[arg-type]  # None was left out before
        except ValueError:
            raise InputError(
                Problem(self.file, self.line, f"setting {name} is {value!r}", f"write a number: --set {name}=0.5")
            ) from None
