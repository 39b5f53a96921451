"""Slots with thin ribs between them, and a design that no simulation made: boxes, cut from each other as solids."""

import itertools
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from manifold3d import Manifold, OpType

from tests.support.recall import DEPTHS, Defect, Reference, Sound, moved, program
from tests.support.solid_booleans import box
from trunnion.simulation.meshes import TriangleMesh

CELL: Final = 0.5

#: Width of the slots, which is that of the tool, their depth, and the ribs between them, mm: from two cells on.
_WIDE: Final = 6.0
_DEEP: Final = 5.0
RIBS: Final = (1.0, 1.5, 2.5)
_LOW, _HIGH = (-20.0, -15.0, -12.0), (20.0, 15.0, 0.0)


def _middles() -> list[float]:
    """Where the slots are along X."""
    steps = itertools.accumulate((_WIDE + rib for rib in RIBS), initial=0.0)
    return [-13.0 + step for step in steps]


def ribs(folder: Path) -> tuple[Sound, Reference]:
    """The program, three blocks a slot, and its design: the block of stock less a box for each slot."""
    lines = ["G21 G90 G17 G40 G49 G80", "T1 M6", "G43 H1", "S1000 M3"]
    for x in _middles():
        lines += [f"G0 X{x:g} Y-25 Z20", f"G0 Z{-_DEEP:g}", "G1 Y-7 F500", "G1 Y7", "G1 Y25", "G0 Z20"]
    text = "\n".join([*lines, "M5", "M2"])
    stock = "box:{:g},{:g},{:g},{:g},{:g},{:g}".format(*np.subtract(_HIGH, _LOW), *_LOW)
    sound = program("thin ribs", "xyzac_trt", text, stock, [f"1=flat:{_WIDE:g},length=75,flutes=40"], CELL, folder)
    slots = [box((x - _WIDE / 2, -30.0, -_DEEP), (x + _WIDE / 2, 30.0, 10.0)) for x in _middles()]
    solid = box(_LOW, _HIGH) - Manifold.batch_boolean(slots, OpType.Add)
    mesh = solid.to_mesh64()
    vertices = np.asarray(mesh.vert_properties)[:, :3].copy()
    design = TriangleMesh(vertices, np.asarray(mesh.tri_verts).astype(np.int64), "design")
    return sound, replace(Reference.of(sound, folder), mesh=design)


def rib_gouges(sound: Sound) -> Iterator[Defect]:
    """Yield gouges into every rib from either side, and into the floor; none is deeper than its rib is wide."""
    walls = [k for k, move in enumerate(sound.moves) if abs(move.tip[1] - 7.0) < 1e-9]
    for cells in DEPTHS:
        depth = cells * CELL
        for slot, row in enumerate(walls):
            ways = [((1.0, 0.0, 0.0), slot), ((-1.0, 0.0, 0.0), slot - 1), ((0.0, 0.0, -1.0), None)]
            for along, rib in ways:
                if rib is not None and not 0 <= rib < len(RIBS):
                    continue
                kind = "floor beside ribs" if rib is None else f"rib of {RIBS[rib] / CELL:g} cells"
                lines, right = moved(sound, row, row, depth * np.array(along))
                real = depth if rib is None else min(depth, RIBS[rib])
                yield Defect(f"gouge, {kind}", cells, replace(sound, lines=lines), right, mm=real)
