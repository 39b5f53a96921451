"""Stock from what states it: a box, a cylinder or a closed mesh.

In:     ``box:X,Y,Z[,x0,y0,z0]``, ``cylinder:D,H[,z0]`` or a mesh, and the cell.
Out:    ``Stock``.
Units:  mm, workpiece frame. A box is given by its sizes and its lowest corner, by default 0,0,0; a cylinder stands on
        Z = z0, by default 0, with its axis through X0 Y0.
"""

import math
import os
import re
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.simulation.meshes import DEVIATION, TriangleMesh, box_mesh, cylinder_mesh, load_mesh
from trunnion.simulation.stock.lattice import Lattice
from trunnion.simulation.stock.material import Stock, rays_of_tiles
from trunnion.simulation.stock.spans import Spans, box_spans, cylinder_spans, mesh_spans

#: Bytes that rays may take at first; slots may multiply it by three.
MOST_BYTES: Final = 3_000_000_000

#: Bytes of a ray: its count, and four ends with a row and a normal each.
_RAY_BYTES: Final = 4 + 4 * 15

#: Cells along the longest side of the stock where none are asked for.
_CELLS: Final = 200

#: Sizes that a number may have, mm.
_LARGEST: Final = 1e5

#: Sizes without a word, such as 120x80x30, as they are written on drawings.
_SIZE: Final = re.compile(r"-?\d+(?:\.\d+)?", re.ASCII)
_SIZES: Final = re.compile(rf"{_SIZE.pattern}(?: ?[xX\u00d7*,;] ?{_SIZE.pattern}){{1,5}}", re.ASCII)

#: Stock that CL files state, where one is asked for in words.
CL_STOCK: Final = "cl"

_NUMBER: Final = re.compile(r"[+-]?(\d{1,9}(\.\d{0,12})?|\.\d{1,12})", re.ASCII)


@dataclass(frozen=True, slots=True, eq=False)
class StockShape:
    """A solid: its box, (3,) each, whether it is the upright cylinder in it, and its mesh if it has one.

    kept  the lattice and the spans of stock that an earlier set-up has left
    """

    low: Floats
    high: Floats
    is_cylinder: bool = False
    mesh: TriangleMesh | None = None
    kept: tuple[Lattice, tuple[Spans, Spans, Spans]] | None = None

    @staticmethod
    def of_kept(lattice: Lattice, spans: tuple[Spans, Spans, Spans]) -> "StockShape":
        """Return what an earlier set-up has left."""
        return StockShape(lattice.low, lattice.high, kept=(lattice, spans))

    def bundles(self, lattice: Lattice, tiles: Collection[int] | None = None) -> tuple[Spans, Spans, Spans]:
        """Its stretches along all rays; or along those of some tiles only, so that others take no memory."""

        def own(bundle: int) -> Spans:
            spans = self.spans(lattice, bundle)
            return spans if tiles is None else spans.only(rays_of_tiles(lattice, bundle, tiles))

        return own(0), own(1), own(2)

    def spans(self, lattice: Lattice, bundle: int) -> Spans:
        """Its stretches along the rays of a bundle."""
        if self.mesh is not None:
            return mesh_spans(self.mesh.vertices, self.mesh.faces, lattice, bundle)
        return cylinder_spans(lattice, bundle) if self.is_cylinder else box_spans(lattice, bundle)

    def as_mesh(self) -> TriangleMesh:
        """Its surface, mm: its mesh, or that of its box or cylinder."""
        if self.mesh is not None:
            return self.mesh
        if self.is_cylinder:
            return cylinder_mesh(float(self.high[0] - self.low[0]), float(self.low[2]), float(self.high[2]))
        return box_mesh(self.low, self.high)


def is_mesh(text: str) -> bool:
    """Whether a text names a file with a mesh; else it states a box or a cylinder, or leaves that to CL files."""
    return text != CL_STOCK and not text.startswith(("box:", "cylinder:"))


def stock_shape(
    text: str | Path | TriangleMesh, warn: Callable[[Problem], None] | None = None, deviation: float = DEVIATION
) -> StockShape:
    """Return the solid that a text states.

    ``warn`` takes what is odd about a mesh; facets of exact surfaces are off them by ``deviation`` at most, mm.

    Raises ``InputError`` if it states none, with the cure.
    """
    if isinstance(text, TriangleMesh):
        low, high = text.bounds
        return StockShape(low, high, mesh=text)
    if not isinstance(text, str | os.PathLike):
        remedy = phrase("give_bodies", type=TriangleMesh.__name__)
        raise InputError(
            argument_problem("stock", Wording("ARG140", "unusable_type", type=type(text).__name__, remedy=remedy))
        )
    if text == CL_STOCK:
        raise InputError(argument_problem("stock", Wording("SIM110", "stock_nowhere")))
    kind, colon, sizes = str(text).partition(":")
    if _SIZES.fullmatch(str(text)) and not Path(str(text)).exists():
        found = tuple(_SIZE.findall(str(text)))
        is_block = len(found) in (3, 6)
        raise _wrong(
            text,
            Wording("SIM122", "sizes_of_block", sizes=found) if is_block else Wording("SIM122", "sizes_alone"),
        )
    if not colon or kind not in ("box", "cylinder"):
        mesh = load_mesh(text, name="stock", closed=True, deviation=deviation, warn=warn)
        return StockShape(mesh.bounds[0], mesh.bounds[1], mesh=mesh)
    words = [word.strip() for word in sizes.split(",")]
    if not all(_NUMBER.fullmatch(word) for word in words):
        raise _wrong(text, Wording("SIM122", "no_list_numbers"))
    numbers = [float(word) for word in words]
    if not all(abs(number) <= _LARGEST for number in numbers):
        raise _wrong(text, Wording("SIM122", "number_beyond_mm", largest=_LARGEST))
    if len(numbers) not in ((3, 6) if kind == "box" else (2, 3)):
        raise _wrong(text, Wording("SIM122", "numbers", count=len(numbers)))
    if min(numbers[: 3 if kind == "box" else 2]) <= 0.0:
        raise _wrong(text, Wording("SIM122", "size_not_above"))
    if kind == "box":
        low = np.array(numbers[3:] or (0.0, 0.0, 0.0))
        return StockShape(low, low + numbers[:3])
    radius, bottom = 0.5 * numbers[0], numbers[2] if len(numbers) > 2 else 0.0
    return StockShape(
        np.array([-radius, -radius, bottom]), np.array([radius, radius, bottom + numbers[1]]), is_cylinder=True
    )


def _wrong(text: object, wording: Wording) -> InputError:
    return InputError(argument_problem("stock", wording.within("of_key", key=str(text))))


def default_cell(shape: StockShape, narrowest: float) -> float:
    """Return a cell for a solid, mm: the 200th part of its longest side, and no more than half of the
    narrowest tool.
    """
    cell = min(float((shape.high - shape.low).max()) / _CELLS, 0.5 * narrowest)
    digit = 10.0 ** (math.floor(math.log10(cell)) - 1)
    return math.floor(cell / digit + 1e-9) * digit


def check_narrow_tools(tools: Mapping[str, float], cell: float) -> None:
    """Raise ``InputError`` for tools that could pass between the rays; diameters by the names of tools, mm."""
    narrow = {name: wide for name, wide in tools.items() if wide < math.sqrt(2.0) * cell}
    if narrow:
        name, wide = min(narrow.items(), key=lambda each: each[1])
        digit = 10.0 ** (math.floor(math.log10(wide)) - 1)
        raise InputError(
            argument_problem(
                "cell",
                Wording(
                    "SIM120",
                    "mm_tool_mm",
                    cell=cell,
                    name=name,
                    wide=wide,
                    widest=math.floor(0.5 * wide / digit) * digit,
                ),
            )
        )


def check_cell(shape: StockShape, cell: float) -> None:
    """Raise ``InputError`` where the rays would not find room, with the cell that would do."""
    size = shape.high - shape.low

    def needed(width: float) -> float:
        across = size[0] * size[1] + size[1] * size[2] + size[2] * size[0]
        return float(across) / width**2 * _RAY_BYTES

    if needed(cell) > MOST_BYTES:
        fits = cell * math.sqrt(needed(cell) / MOST_BYTES)
        digit = 10.0 ** (math.floor(math.log10(fits)) - 1)
        fits = math.ceil(fits / digit) * digit
        raise InputError(
            argument_problem(
                "cell",
                Wording(
                    "SIM120",
                    "cells_mm_take",
                    cell=cell,
                    needed=needed(cell) / 1000000000.0,
                    fits=fits,
                    most_bytes=MOST_BYTES / 1000000000.0,
                ),
            )
        )


def make_stock(shape: StockShape, cell: float, only: Callable[[Lattice], Collection[int]] | None = None) -> Stock:
    """Return the material of a solid in cells of at most ``cell`` mm, or in those that it has already.

    ``only`` says which tiles of the lattice are wanted, by their numbers.
    """
    if shape.kept is not None:
        lattice, spans = shape.kept
        return Stock.of_spans(lattice, spans, None if only is None else only(lattice))
    check_cell(shape, cell)
    lattice = Lattice.of_box(shape.low, shape.high, cell)
    tiles = None if only is None else only(lattice)
    return Stock.of_spans(lattice, shape.bundles(lattice, tiles), tiles)
