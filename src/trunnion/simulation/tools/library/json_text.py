"""JSON from anywhere: limited in size and depth, finite numbers, no key twice."""

import json
import math
from collections.abc import Mapping
from dataclasses import field
from typing import Any, Final, NoReturn

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.simulation.tools.sizes import GREATEST

#: Longest text that is read, bytes: catalogues of makers have some ten megabytes.
MAX_BYTES: Final = 32 << 20


class _JsonError(ValueError):
    """What is wrong with a text that is JSON otherwise."""


def parse_json(file: str, data: bytes) -> object:
    """Return what a JSON text holds.

    Raises ``InputError`` if it is too long, no JSON or nests too deeply; if a number is not finite, or an object has a
    key twice.
    """
    if len(data) > MAX_BYTES:
        raise InputError(Problem(file, 0, Wording("SIM172", "more_mb_tools", max_bytes=MAX_BYTES >> 20)))
    try:
        text = data.decode("utf-8-sig")
        return json.loads(text, parse_constant=_refuse, object_pairs_hook=_unique)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(Problem(file, line, Wording("SIM170", "not_utf_8"))) from None
    except RecursionError:
        raise InputError(Problem(file, 0, Wording("SIM170", "nests_too_deeply"))) from None
    except json.JSONDecodeError as error:
        raise InputError(Problem(file, error.lineno, Wording("SIM170", "not_json", msg=error.msg))) from None
    except ValueError as error:  # also a number with thousands of digits
        raise InputError(Problem(file, 0, Wording("SIM170", "library_not_json", error=error))) from None


def _refuse(word: str) -> NoReturn:
    raise _JsonError(f"{word} is no number")


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise _JsonError("an object has a key twice")
    return found


def finite(value: object) -> float | None:
    """Return the finite number that a JSON value is; None if it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def short_text(value: object) -> str:
    """Return a text for messages: one line, not too long; empty if the value is no text."""
    return " ".join(value.split())[:200] if isinstance(value, str) else ""


@dataclass(frozen=True, slots=True)
class JsonObject:
    """An object of a JSON text, with what is wrong in it.

    path    its place in the text, for messages
    scale   mm to a unit of its lengths
    faults  shared with the objects in it; a size with a fault counts as 0
    """

    values: Mapping[str, Any]
    path: str = ""
    scale: float = 1.0
    faults: list[Wording] = field(default_factory=list)

    def child(self, key: str, scale: float | None = None) -> "JsonObject":
        """Return the object under a key; an empty one if there is none."""
        value = self.values.get(key)
        path = f"{self.path}.{key}" if self.path else key
        if value is not None and not isinstance(value, dict):
            self.faults.append(phrase("json_no_object", path=path))
        return JsonObject(value if isinstance(value, dict) else {}, path, scale or self.scale, self.faults)

    def children(self, key: str, most: int) -> "list[JsonObject]":
        """Return the objects in the list under a key, ``most`` of them."""
        value = self.values.get(key)
        path = f"{self.path}.{key}" if self.path else key
        if value is not None and not isinstance(value, list):
            self.faults.append(phrase("json_no_list", path=path))
            return []
        if value and len(value) > most:
            self.faults.append(phrase("json_long_list", path=path, count=len(value), most=most))
            return []
        items = {f"{key}[{place}]": item for place, item in enumerate(value or [])}
        holding = JsonObject(items, self.path, self.scale, self.faults)
        return [holding.child(name) for name in items]

    def number(self, key: str, most: float) -> float:
        """Return a number from 0 to ``most``; 0 if there is none."""
        value = self.values.get(key)
        if value is None:
            return 0.0
        found = finite(value)
        if found is None or not 0.0 <= found <= most:
            path = f"{self.path}.{key}" if self.path else key
            self.faults.append(phrase("json_no_number", path=path, value=str(value)[:40], most=most))
            return 0.0
        return found

    def length(self, key: str) -> float:
        """Return a length in mm; 0 if there is none."""
        return self.number(key, GREATEST / self.scale) * self.scale

    def angle(self, key: str) -> float:
        """Return an angle in degrees; 0 if there is none."""
        return self.number(key, 180.0)
