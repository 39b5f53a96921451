"""The arguments of ``trunnion place``."""

import argparse

from trunnion.cli.argument_values import add_settings, tilt, turn, turn_step
from trunnion.cli.stock_arguments import add_bodies

#: Goals; listed here, so that a command line is taken apart before anything is imported.
GOALS = ("margin", "rotary", "slides", "time", "overspeed", "collisions")


def add_place(parser: argparse.ArgumentParser) -> None:
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
        "--turns", type=turn_step, metavar="DEG",
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
    add_settings(parser, "for CL files, as post has it")
    parser.add_argument(
        "--with", nargs="+", action="extend", default=[], metavar="NC", dest="subprograms",
        help="files of the subprograms that the programs call; no others are opened",
    )  # fmt: skip
    add_bodies(
        parser,
        stock=". Seen from above it is to stay on the table that the machine's definition states",
        part="the finished part, for which the same holds",
        fixture="a fixture as the part is drawn, clamped and turned with it",
        library="tool library, as simulate takes it",
    )
    parser.add_argument("--json", metavar="FILE", help="all results as data; - is stdout")
    parser.add_argument("--plot", metavar="FILE.svg", help="the margin over the table and over the turns")
    parser.add_argument(
        "--apply", metavar="FILE|-",
        help="post the CL files with the best place, and prove it; the head of the program says how the part is turned,"
        " and where its zero is",
    )  # fmt: skip
    parser.add_argument("--sheet", metavar="FILE", help="setup sheet of that program (.html or .json)")
