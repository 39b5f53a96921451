"""The arguments of ``trunnion verify``."""

import argparse

from trunnion.cli.argument_values import FEEDS, add_angles, add_subprograms, edge, tolerance
from trunnion.dialect_names import READ_DIALECTS


def add_verify(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.add_argument("file", metavar="NC", help="NC program; or the manifest of a post (.json)")
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="machine that runs it; not for a manifest")
    add_subprograms(parser, "it")
    parser.add_argument(
        "--cl", action="append", default=[], metavar="CL",
        help="CL file that it was made from; may be repeated, in the order in which they are cut",
    )  # fmt: skip
    parser.add_argument(
        "--hooks", action="append", default=[], metavar="FILE.py",
        help="Python file that it was posted with, which changes the CL files again; it is run; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--tolerance", type=tolerance, default=0.001, metavar="MM",
        help="how far a coordinate may be off, and in degrees a rotary axis; 0.001 (in inches 0.0013 mm)",
    )  # fmt: skip
    parser.add_argument(
        "--span",
        type=tolerance,
        metavar="DEG",
        help="how far the tool axis may be off between points; by default the definition's tolerance",
    )
    parser.add_argument(
        "--span-tip",
        type=tolerance,
        metavar="MM",
        help="how far the tip may be off between points without TCP, and lines off the arc that they stand for",
    )
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, for programs without TCP")
    parser.add_argument("--tool", default="", metavar="T", help="tool that was called in place of the CL file's")
    parser.add_argument(
        "--offset", metavar="G", help="work offset of the program; with --cl that of the control's definition"
    )
    parser.add_argument(
        "--edge", type=edge, metavar="D",
        help="cutting edge under which the tool works; with --cl that of the control's definition, if it has one",
    )  # fmt: skip
    parser.add_argument("--units", choices=("mm", "inch"), help="length unit of the CL files, whatever they state")
    parser.add_argument("--dialect", choices=READ_DIALECTS, help="what the CL files are written in")
    parser.add_argument(
        "--frame", choices=("first", "absolute"), default="first",
        help="whose coordinate system the program's is: the first operation's, or the CAM's absolute one",
    )  # fmt: skip
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the machine, mm")
    parser.add_argument("--feed", choices=FEEDS, help="fastest: it was posted so; feeds are what the axes reach")
    parser.add_argument(
        "--feed-limit", type=tolerance, metavar="MM_MIN", help="the feed_limit of that post, in place of the CL file's"
    )
    parser.add_argument(
        "--recorded", metavar="FILE", help="compare with what the machine did: a recording (.csv or .parquet)"
    )
    parser.add_argument(
        "--recorded-tolerance", type=tolerance, default=0.05, metavar="MM",
        help="how far the recorded tip may be off the path, and in degrees its tool axis; 0.05",
    )  # fmt: skip
    add_angles(parser, "as the head of a placed program says; the CL files are turned before they are compared")
    parser.add_argument("--report", metavar="FILE", help="what was checked, as a page (.html) or data (.json)")
