"""The arguments of ``trunnion place``."""

import argparse
from collections.abc import Callable
from typing import Any

#: Goals; listed here, so that a command line is taken apart before anything is imported.
GOALS = ("margin", "rotary", "slides", "time", "overspeed", "collisions")


def degrees(text: str) -> float:
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


def add_place(parser: argparse.ArgumentParser, setting: type[argparse.Action], key_value: Callable[[str], Any]) -> None:
    """Add the options of the command."""
    parser.add_argument(
        "files", nargs="+", metavar="CL|NC|PROJECT",
        help="CL files or NC programs, which must all fit at one place of the part; or one project (.toml)",
    )  # fmt: skip
    parser.add_argument(
        "--machine", metavar="NAME_OR_FILE", help="shipped machine, or a TOML file; by default that of the project"
    )
    parser.add_argument("--setup", metavar="NAME", help="the set-up of a project with several")
    parser.add_argument(
        "--goal", choices=GOALS, default="margin",
        help="what the best place is best for: margin to the limits, travel of rotary axes or slides, time, fewest"
        " blocks whose feed the axes cannot reach, or bodies farthest apart; by default margin",
    )  # fmt: skip
    turns = parser.add_mutually_exclusive_group()
    turns.add_argument(
        "--turns", type=degrees, metavar="DEG",
        help="try the part at every so many degrees about Z, counter-clockwise seen from above (from +Z), and more"
        " finely around the best; by default 5, with several tilts or the goal collisions 15",
    )  # fmt: skip
    turns.add_argument(
        "--turn", type=turn, action="append", metavar="DEG", dest="only",
        help="try this turn only; 0 leaves the part as it is; may be repeated",
    )  # fmt: skip
    tilts = parser.add_mutually_exclusive_group()
    tilts.add_argument(
        "--free", action="store_true",
        help="tilt the part too, by a fixture angle about X of the program, right-handed, before the turn: at every 15"
        " degrees from -90 to 90, and more finely around the best",
    )  # fmt: skip
    tilts.add_argument(
        "--tilt", type=tilt, action="append", metavar="DEG", dest="tilts",
        help="the fixture angles that there are; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--zero", metavar="X,Y,Z", help="the present workpiece zero on the machine, mm, to compare with"
    )
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, gauge point to tip")
    parser.add_argument(
        "--set", action=setting, type=key_value, default=[], metavar="KEY=VALUE", dest="settings",
        help="for CL files, as post has it; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--with", nargs="+", action="extend", default=[], metavar="NC", dest="subprograms",
        help="files of the subprograms that the programs call; no others are opened",
    )  # fmt: skip
    parser.add_argument(
        "--stock", metavar="STOCK",
        help="box:X,Y,Z[,x0,y0,z0] (sizes, lowest corner; by default 0,0,0), cylinder:D,H[,z0] (by default 0), or a"
        " mesh file; mm. Seen from above it is to stay on the table that the machine's definition states",
    )  # fmt: skip
    parser.add_argument("--part", metavar="MESH", help="the finished part, for which the same holds")
    parser.add_argument(
        "--fixture", action="append", default=[], metavar="MESH", dest="fixtures",
        help="a fixture as the part is drawn, clamped and turned with it; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--tool", action="append", default=[], metavar="N=KIND:SIZES", dest="tools",
        help="a tool, such as 3=ball:10,length=60,flutes=20,shank=12,holder=40x50; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--tools", action="append", default=[], metavar="LIBRARY", dest="libraries",
        help="tool library, as simulate takes it; may be repeated",
    )  # fmt: skip
    parser.add_argument("--unit", choices=("mm", "inch"), help="length unit of tool tables, which state none")
    parser.add_argument("--json", metavar="FILE", help="all results as data; - is stdout")
    parser.add_argument("--plot", metavar="FILE.svg", help="the margin over the table and over the turns")
    parser.add_argument(
        "--apply", metavar="FILE|-",
        help="post the CL files with the best place, and prove it; the head of the program says how the part is turned,"
        " and where its zero is",
    )  # fmt: skip
    parser.add_argument("--sheet", metavar="FILE", help="setup sheet of that program (.html or .json)")
