"""The arguments of the commands about what a machine can do: ``trunnion sensitivity``, ``reach`` and ``fit``."""

import argparse


def number(text: str) -> float:
    """A number; the functions that take it know its range."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number; write one, such as 5") from None


def add_sensitivity(parser: argparse.ArgumentParser) -> None:
    """Add them; the subprograms and the function that runs it are added by the caller."""
    parser.add_argument("file", metavar="NC", help="NC program")
    parser.add_argument("--machine", required=True, metavar="NAME_OR_FILE", help="machine that runs it")
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, gauge point to tip")
    parser.add_argument(
        "--length",
        type=number,
        default=0.01,
        metavar="MM",
        help="how far points and lengths are off; by default 0.01",
    )
    parser.add_argument(
        "--angle", type=number, default=5.0, metavar="ARCSEC",
        help="how far directions and displayed angles are off, seconds of arc; by default 5",
    )  # fmt: skip
    parser.add_argument(
        "--zero-at", default="home", metavar="C=0,B=0|home|none",
        help="where the rotary axes stand when the workpiece zero is set; none: leave nothing to the zero",
    )  # fmt: skip
    parser.add_argument("--json", metavar="FILE", help="all numbers as data; - is stdout")
    parser.add_argument("--report", metavar="FILE", help="the table, and errors over the program, as a page (.html)")


def add_reach(parser: argparse.ArgumentParser) -> None:
    """Add them; the function that runs it is added by the caller."""
    parser.add_argument("files", nargs="*", metavar="CL", help="CL files whose points are judged")
    parser.add_argument("--machine", required=True, metavar="NAME_OR_FILE", help="machine whose reach is told")
    parser.add_argument("--part", metavar="MESH", help="part whose facets the tip is to reach along their normals")
    parser.add_argument(
        "--lean", type=float, default=0.0, metavar="DEG", help="how far the tool may lean from a normal; by default 0"
    )
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, gauge point to tip")
    parser.add_argument(
        "--step",
        type=number,
        default=5.0,
        metavar="DEG",
        help="degrees between tilts, and between azimuths; by default 5",
    )
    parser.add_argument("--json", metavar="FILE", help="everything as data; - is stdout")
    parser.add_argument("--plot", metavar="FILE", help="tool axes on the sphere, and volumes over the tilt (.svg)")


def add_fit(parser: argparse.ArgumentParser) -> None:
    """Add them; the subprograms and the function that runs it are added by the caller."""
    parser.add_argument(
        "files", nargs="+", metavar="CL|NC", help="CL files of one program; or, with --machine, a program"
    )
    parser.add_argument(
        "--machines",
        default="all",
        metavar="NAME_OR_FILE,…",
        help="machines that are asked; by default all shipped ones",
    )
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="machine that the NC program is for")
    parser.add_argument("--zero", metavar="X,Y,Z", help="workpiece zero of the NC program on its own machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool on all machines, gauge point to tip")
    parser.add_argument(
        "--turns",
        type=number,
        default=5.0,
        metavar="DEG",
        help="try the part at every so many degrees about Z; by default 5",
    )
    parser.add_argument("--json", metavar="FILE", help="everything as data; - is stdout")
