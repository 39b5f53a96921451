"""Options that several commands have, and what their values may be."""

import argparse
from collections.abc import Sequence
from typing import Any, Final, cast

#: Values of the setting ``feed``.
FEEDS = ("programmed", "fastest")

#: Tolerances, cells and scales are less.
_GREATEST: Final = 1e6


def add_settings(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Add ``--set``, which may be repeated."""
    parser.add_argument(
        "--set",
        action=_Setting,
        type=_key_value,
        default=[],
        metavar="KEY=VALUE",
        dest="settings",
        help=f"{meaning}; may be repeated",
    )


def add_subprograms(
    parser: argparse.ArgumentParser, caller: str, option: str = "--with", to: str = "subprograms"
) -> None:
    """Add the files of the subprograms that a ``caller`` calls."""
    parser.add_argument(
        option, nargs="+", action="extend", default=[], metavar="NC", dest=to,
        help=f"files of the subprograms that {caller} calls; no others are opened",
    )  # fmt: skip


def add_angles(parser: argparse.ArgumentParser, what: str) -> None:
    """Add turn and tilt of the part; ``what`` says why they are given."""
    parser.add_argument(
        "--turn", type=turn, metavar="DEG",
        help=f"the part is turned so about Z, counter-clockwise seen from +Z, {what}",
    )  # fmt: skip
    parser.add_argument(
        "--tilt", type=tilt, metavar="DEG", help="before that it is tilted about X of the program, right-handed"
    )


def _key_value(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not equals or not key:
        raise argparse.ArgumentTypeError(f"{text!r} is not a setting; write KEY=VALUE")
    return key, value


class _Setting(argparse.Action):
    """Collects the settings; one that is given two values is refused, for the first would be lost."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        settings: list[tuple[str, str]] = list(getattr(namespace, self.dest))
        (key, value), before = cast("tuple[str, str]", values), dict(settings)
        if before.get(key, value) != value:
            once = f"{key}={before[key]},OPERATION:VALUE where a setting differs by operation"
            raise argparse.ArgumentError(
                self, f"{key} has two values, {before[key]!r} and {value!r}; write one, or {once}"
            )
        setattr(namespace, self.dest, [*settings, (key, value)])


def tolerance(text: str) -> float:
    """A tolerance, or another length above 0."""
    return _positive(text, "a tolerance", "0.001")


def cell(text: str) -> float:
    """A width of cells."""
    return _positive(text, "a width of cells", "0.25")


def scale(text: str) -> float:
    """A factor."""
    return _positive(text, "a scale", "0.75")


def _positive(text: str, what: str, such_as: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < _GREATEST:
        cure = f"write a number above 0 and below {_GREATEST:.0f}, such as {such_as}"
        raise argparse.ArgumentTypeError(f"{text!r} is not {what}; {cure}")
    return value


def edge(text: str) -> int:
    """The number of a cutting edge."""
    if not text.isascii() or not text.isdigit():
        raise argparse.ArgumentTypeError(f"{text!r} is not a cutting edge; write its D number, such as 1")
    return int(text)


def turn_step(text: str) -> float:
    """A step between turns."""
    return _angle(text, "step of turns", 0.1, 360.0, "5")


def turn(text: str) -> float:
    """A turn."""
    return _angle(text, "turn", -360.0, 360.0, "45")


def tilt(text: str) -> float:
    """A tilt by a fixture."""
    return _angle(text, "tilt", -90.0, 90.0, "30")


def _angle(text: str, what: str, low: float, high: float, such_as: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        cure = f"write degrees, {low:g} to {high:g}, such as {such_as}"
        raise argparse.ArgumentTypeError(f"{text!r} is no {what}; {cure}")
    return value
