"""Records as data: names, units, decimals, none, groups, order; and problems, which have one shape everywhere."""

import json
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np
import pytest

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, Severity, argument_problem, key_subject
from trunnion.machines.machine import Vector
from trunnion.messages import foreign
from trunnion.results import (
    EXACT,
    FIRST,
    NOT_DATA,
    BlockNumber,
    Figure,
    Millimetres,
    OptionalLine,
    OptionalText,
    as_json,
    to_data,
)


class Colour(StrEnum):
    """An enumeration."""

    RED = "red"


@dataclass(frozen=True, slots=True)
class Spot:
    """A part of others."""

    file: OptionalText
    line: OptionalLine
    block: BlockNumber


@dataclass(frozen=True, slots=True, eq=False)
class Whole:
    """A document."""

    SCHEMA: ClassVar[int] = 3
    DECIMALS: ClassVar[int] = 2

    depth: Millimetres
    distance_mm: Millimetres
    table: Annotated[float, Figure(decimals=EXACT)]
    spot: Annotated[Spot, Figure(is_flat=True)]
    spots: tuple[Spot, ...]
    values: Annotated[Floats, Figure("count", take=len), Figure("values", unit="deg", decimals=1)]
    place: Vector
    colour: Annotated[Colour, Figure(within="look")]
    path: Annotated[Path | None, Figure(within="look")]
    left: Annotated[str | None, Figure(is_optional=True)]
    more: Annotated[str, Figure(is_extra=True)]
    rows: Annotated[Floats, NOT_DATA]
    _secret: int = 0

    @property
    @Figure(after=FIRST)
    def passed(self) -> bool:
        """A property that comes first."""
        return True

    @property
    @Figure("low", take=min, within="ends", after="count")
    @Figure("high", take=max, within="ends")
    def ends(self) -> Floats:
        """A property with two figures."""
        return self.values


WHOLE = Whole(
    -0.001, 1, 3, Spot("", 0, -1), (Spot("a.nc", 5, 0),), np.array([1.23, np.inf]), (0.004, 0.006, np.nan), Colour.RED,
    Path("a/b"), None, "more", np.zeros(3),
)  # fmt: skip


def test_a_record_becomes_data_in_the_order_and_under_the_names_of_its_figures() -> None:
    found = to_data(WHOLE)
    assert json.loads(as_json(found)) == found
    assert list(found.items()) == [
        ("schema", 3),
        ("passed", True),
        ("depth_mm", 0.0),
        ("distance_mm", 1.0),
        ("table", 3),
        ("file", None),
        ("line", None),
        ("block", None),
        ("spots", [{"file": "a.nc", "line": 5, "block": 0}]),
        ("count", 2),
        ("ends", {"low": 1.23, "high": None}),
        ("values_deg", [1.2, None]),
        ("place", [0.0, 0.01, None]),
        ("look", {"colour": "red", "path": str(Path("a/b"))}),
    ]
    assert str(found["depth_mm"]) == "0.0"


def test_some_keys_of_a_record_are_in_the_order_in_which_they_are_named() -> None:
    assert to_data([WHOLE], only=("more", "depth_mm")) == [{"more": "more", "depth_mm": 0.0}]
    assert list(to_data(WHOLE, only=("more", "depth_mm"))) == ["more", "depth_mm"]
    with pytest.raises(KeyError):
        to_data(WHOLE, only=("depth",))


def test_problems_have_one_shape() -> None:
    warning = Problem("a.cls", 12, foreign("is odd", "mend it", "CL110"), Severity.WARNING)
    assert to_data(warning) == {
        "severity": "warning",
        "code": "CL110",
        "file": "a.cls",
        "line": 12,
        "text": "is odd",
        "cure": "mend it",
        "subject": None,
    }
    of_key = Problem("mill.toml", 0, foreign("is missing"), subject=key_subject("axis[1].kind"))
    assert to_data([of_key])[0]["subject"] == {"kind": "key", "name": "axis[1].kind"}
    assert to_data(of_key)["line"] is to_data(of_key)["cure"] is to_data(of_key)["code"] is None
    of_argument = to_data(InputError(argument_problem("zero", foreign("is missing"))).problems)[0]
    assert (of_argument["file"], of_argument["subject"]) == (None, {"kind": "argument", "name": "zero"})


def test_a_figure_behind_one_that_does_not_exist_is_a_mistake() -> None:
    @dataclass(frozen=True, slots=True)
    class Wrong:
        one: Annotated[int, Figure(after="two")]

    with pytest.raises(AssertionError, match="two"):
        to_data(Wrong(1))
