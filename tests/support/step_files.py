"""STEP files written here, entity by entity: a block, a disc, and assemblies of both, in any unit."""

import math
from collections.abc import Sequence
from pathlib import Path

Point = tuple[float, float, float]

_HEAD = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('part','2026-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 }'));
ENDSEC;
DATA;
"""
_UNITS = {
    "mm": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))",
    "m": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))",
}


class StepFile:
    """Entities of a file; every method adds some and returns the reference of the last."""

    def __init__(self, unit: str = "mm") -> None:
        self._lines: list[str] = []
        self._products: list[str] = []
        if unit == "inch":
            mm = self.add(_UNITS["mm"])
            measure = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{mm})")
            size = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
            length = self.add(f"(CONVERSION_BASED_UNIT('INCH',{measure})LENGTH_UNIT()NAMED_UNIT({size}))")
        else:
            length = self.add(_UNITS[unit])
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        solid = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        off = self.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-06),{length},'distance_accuracy_value','')")
        self._context = self.add(
            f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({off}))"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('',''))"
        )
        application = self.add("APPLICATION_CONTEXT('automotive design')")
        self._product_context = self.add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
        self._definition_context = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")

    def add(self, text: str) -> str:
        """Add an entity."""
        self._lines.append(f"#{len(self._lines) + 1}={text};")
        return f"#{len(self._lines)}"

    def point(self, at: Sequence[float]) -> str:
        """A point."""
        return self.add(f"CARTESIAN_POINT('',({_numbers(at)}))")

    def direction(self, along: Sequence[float]) -> str:
        """A direction."""
        return self.add(f"DIRECTION('',({_numbers(along)}))")

    def frame(self, at: Sequence[float], axis: Sequence[float], reference: Sequence[float]) -> str:
        """A placement."""
        parts = self.point(at), self.direction(axis), self.direction(reference)
        return self.add(f"AXIS2_PLACEMENT_3D('',{','.join(parts)})")

    def _vertex(self, at: Sequence[float]) -> str:
        return self.add(f"VERTEX_POINT('',{self.point(at)})")

    def _face(self, loops: list[list[tuple[str, bool]]], surface: str) -> str:
        bounds = []
        for number, loop in enumerate(loops):
            edges = [self.add(f"ORIENTED_EDGE('',*,*,{edge},{'.T.' if same else '.F.'})") for edge, same in loop]
            path = self.add(f"EDGE_LOOP('',({','.join(edges)}))")
            bounds.append(self.add(f"{'FACE_BOUND' if number else 'FACE_OUTER_BOUND'}('',{path},.T.)"))
        return self.add(f"ADVANCED_FACE('',({','.join(bounds)}),{surface},.T.)")

    def _solid(self, name: str, faces: list[str]) -> str:
        shell = self.add(f"CLOSED_SHELL('',({','.join(faces)}))")
        body = self.add(f"MANIFOLD_SOLID_BREP('{name}',{shell})")
        origin = self.frame((0, 0, 0), (0, 0, 1), (1, 0, 0))
        return self.product(name, f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({origin},{body}),{self._context})")

    def product(self, name: str, shape: str) -> str:
        """A product with a shape; the reference is that of the product's definition."""
        product = self.add(f"PRODUCT('{name}','{name}','',({self._product_context}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        definition = self.add(f"PRODUCT_DEFINITION('design','',{formation},{self._definition_context})")
        meaning = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({meaning},{self.add(shape)})")
        self._shape = f"#{len(self._lines) - 1}"
        return definition

    def block(self, low: Point, high: Point) -> str:
        """A block."""
        corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        vertices = [self._vertex(corner) for corner in corners]
        edges = dict[tuple[int, int], str]()
        for one in range(8):
            for bit in (1, 2, 4):
                if not one & bit:
                    other = one | bit
                    along = [b - a for a, b in zip(corners[one], corners[other], strict=True)]
                    vector = self.add(f"VECTOR('',{self.direction(along)},1.)")
                    line = self.add(f"LINE('',{self.point(corners[one])},{vector})")
                    edges[one, other] = self.add(f"EDGE_CURVE('',{vertices[one]},{vertices[other]},{line},.T.)")
        faces = []
        # Corners count in bits: X 4, Y 2, Z 1. Each side turns left, seen from outside.
        for side, normal, reference in (
            ((0, 1, 3, 2), (-1, 0, 0), (0, 1, 0)), ((4, 6, 7, 5), (1, 0, 0), (0, 1, 0)),
            ((0, 4, 5, 1), (0, -1, 0), (1, 0, 0)), ((2, 3, 7, 6), (0, 1, 0), (1, 0, 0)),
            ((0, 2, 6, 4), (0, 0, -1), (1, 0, 0)), ((1, 5, 7, 3), (0, 0, 1), (1, 0, 0)),
        ):  # fmt: skip
            loop = [
                (edges[min(a, b), max(a, b)], a < b) for a, b in zip(side, (*side[1:], side[0]), strict=True)
            ]  # fmt: skip
            plane = self.add(f"PLANE('',{self.frame(corners[side[0]], normal, reference)})")
            faces.append(self._face([loop], plane))
        return self._solid("block", faces)

    def disc(self, radius: float, low: float, high: float) -> str:
        """An upright cylinder about Z."""
        ends = [self._vertex((radius, 0, z)) for z in (low, high)]
        circles = []
        for z, vertex in zip((low, high), ends, strict=True):
            circle = self.add(f"CIRCLE('',{self.frame((0, 0, z), (0, 0, 1), (1, 0, 0))},{radius:.6f})")
            circles.append(self.add(f"EDGE_CURVE('',{vertex},{vertex},{circle},.T.)"))
        vector = self.add(f"VECTOR('',{self.direction((0, 0, 1))},1.)")
        line = self.add(f"LINE('',{self.point((radius, 0, low))},{vector})")
        seam = self.add(f"EDGE_CURVE('',{ends[0]},{ends[1]},{line},.T.)")
        around = self.add(f"CYLINDRICAL_SURFACE('',{self.frame((0, 0, low), (0, 0, 1), (1, 0, 0))},{radius:.6f})")
        bottom = self.add(f"PLANE('',{self.frame((0, 0, low), (0, 0, -1), (1, 0, 0))})")
        top = self.add(f"PLANE('',{self.frame((0, 0, high), (0, 0, 1), (1, 0, 0))})")
        return self._solid(
            "disc",
            [
                self._face([[(circles[0], True), (seam, True), (circles[1], False), (seam, False)]], around),
                self._face([[(circles[0], False)]], bottom),
                self._face([[(circles[1], True)]], top),
            ],
        )

    def assembly(self, parts: Sequence[tuple[str, str, Point, float]]) -> None:
        """An assembly: of each part its definition, its shape, where it is, and by how many degrees about Z."""
        origin = self.frame((0, 0, 0), (0, 0, 1), (1, 0, 0))
        frames = [
            self.frame(at, (0, 0, 1), (math.cos(math.radians(turn)), math.sin(math.radians(turn)), 0))
            for _, _, at, turn in parts
        ]
        whole = self.product("whole", f"SHAPE_REPRESENTATION('',({','.join((origin, *frames))}),{self._context})")
        shape = self._shape
        for number, ((definition, own, _, _), frame) in enumerate(zip(parts, frames, strict=True)):
            use = self.add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{number}','','',{whole},{definition},$)")
            meaning = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{use})")
            way = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',{origin},{frame})")
            relation = self.add(
                f"(REPRESENTATION_RELATIONSHIP('','',{own},{shape})REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({way})"
                "SHAPE_REPRESENTATION_RELATIONSHIP())"
            )
            self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{meaning})")

    @property
    def shape(self) -> str:
        """The shape of the product that was added last."""
        return self._shape

    def text(self) -> str:
        """The whole file."""
        return _HEAD + "\n".join(self._lines) + "\nENDSEC;\nEND-ISO-10303-21;\n"

    def save(self, path: Path) -> Path:
        """Write the file."""
        path.write_text(self.text(), encoding="ascii")
        return path


def _numbers(values: Sequence[float]) -> str:
    return ",".join(f"{value:.9f}" for value in values)
