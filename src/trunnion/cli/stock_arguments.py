"""The arguments of stock, part, fixtures and tools: what is cut, and what must not be met."""

import argparse
from typing import Final

from trunnion.cli.argument_values import cell, tolerance

#: Forms of a stock.
_STOCK: Final = (
    "box:X,Y,Z[,x0,y0,z0] (sizes, lowest corner; by default 0,0,0), cylinder:D,H[,z0] (by default 0), or a mesh file;"
    " mm"
)


def add_bodies(parser: argparse.ArgumentParser, *, stock: str = "", part: str, fixture: str, library: str) -> None:
    """Add stock, part, fixtures and tools; the texts say what they mean to the command."""
    parser.add_argument("--stock", metavar="STOCK", help=f"{_STOCK}{stock}")
    parser.add_argument("--part", metavar="MESH", help=part)
    parser.add_argument(
        "--tool", action="append", default=[], metavar="N=KIND:SIZES", dest="tools",
        help="a tool, such as 3=ball:10,length=60,flutes=20,shank=12,holder=40x50; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--tools", action="append", default=[], metavar="LIBRARY", dest="libraries", help=f"{library}; may be repeated"
    )
    parser.add_argument("--unit", choices=("mm", "inch"), help="length unit of tool tables, which state none")
    parser.add_argument(
        "--fixture", action="append", default=[], metavar="MESH", dest="fixtures", help=f"{fixture}; may be repeated"
    )


def add_stock(parser: argparse.ArgumentParser) -> None:
    """Add all that a simulation cuts with, and how fine."""
    add_bodies(
        parser,
        part="the finished part, to compare with what is left of the stock",
        fixture="a fixture, as the program counts",
        library="tool library: TOML, .tools or .json of Autodesk, FreeCAD's .fctb, LinuxCNC's tool.tbl",
    )
    parser.add_argument("--near", type=tolerance, metavar="MM", help="tell bodies that come as near as this, too")
    parser.add_argument(
        "--cell", type=cell, metavar="MM", help="width of the cells; by default a 200th of the stock's side"
    )
    parser.add_argument(
        "--accuracy", type=tolerance, metavar="MM", help="of motions and tools; by default a tenth of a cell"
    )
