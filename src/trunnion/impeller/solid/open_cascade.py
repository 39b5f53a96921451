"""Open CASCADE: a described body as a checked solid, and the STEP file of it.

In:     ``Order``: a body, the stock that it is cut out of, and a name.
Out:    ``Made``: the bytes of a STEP file, and what was measured on the solid as it is read back from them.
Units:  mm and rad.

This is the one module that imports Open CASCADE. It runs in a process of its own (``making.py``): a library of a
million lines may end its process, or never end.
"""

import io
import re
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.BRepTools import BRepTools
from OCP.collections import (
    Array1_double,
    Array1_gp_Pnt,
    Array1_gp_Pnt2d,
    Array1_int,
    Array2_gp_Pnt,
    IndexedDataMap_TopoDS_Shape_List_TopoDS_Shape_TopTools_ShapeMapHasher,
)
from OCP.Geom import (
    Geom_BSplineCurve,
    Geom_BSplineSurface,
    Geom_Circle,
    Geom_CylindricalSurface,
    Geom_Line,
    Geom_Plane,
    Geom_SurfaceOfRevolution,
)
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Circle, Geom2d_Line
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Ax22d, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_ManifoldSolidBrep, STEPControl_Reader, STEPControl_Writer
from OCP.TCollection import TCollection_HAsciiString
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SOLID
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shell, TopoDS_Solid, TopoDS_Vertex, TopoDS_Wire

from trunnion.arrays import Flags, Floats
from trunnion.impeller.solid.order import Made, Order, Refusal
from trunnion.impeller.solid.shapes import (
    Body,
    Circle,
    Curve,
    Cylinder,
    Edge,
    Face,
    Line,
    Plane,
    Spline,
    SplineSurface,
    Surface,
)

#: Edges and faces are together within this, mm, unless the kernel finds that they are not.
_TOGETHER: Final = 1e-6

#: A stock's bore goes so far beyond it, mm.
_BEYOND: Final = 1.0

#: Relative error of an integrated volume.
_OF_VOLUME: Final = 1e-4

#: Places along u and v of a face, and along an edge, at which it is measured.
_GRID: Final = (41, 7)
_ALONG_EDGE: Final = 25

#: Stands for the part's name until the file is written.
_NAME: Final = "TRUNNION-PART-NAME"

#: A file has no date: the same input gives the same bytes.
_DATE: Final = "1970-01-01T00:00:00"

_Z: Final = gp_Dir(0.0, 0.0, 1.0)


def make(order: Order) -> Made | Refusal:
    """Make the solid of a body within its stock, write it, and measure what was written."""
    found = _solids(BRepAlgoAPI_Common(_solid(order.body), _blank(order)).Shape())
    if len(found) != 1:
        return Refusal(f"it falls into {len(found)} bodies" if found else "nothing of it is within the stock")
    if fault := _fault(found[0]):
        return Refusal(fault)
    step = _written(found[0], order.name)
    read = _solids(_read(step))
    if len(read) != 1:
        return Refusal("the file read back is not one solid")
    if fault := _fault(read[0]):
        return Refusal(f"{fault}, once it is read back")
    faces = _parts(read[0], TopAbs_FACE)
    return Made(step, _volume(read[0]), len(faces), np.vstack((*_on_faces(faces), *_on_edges(read[0]))))


def _solid(body: Body) -> Any:
    """Return the body as a solid."""
    builder = BRep_Builder()
    vertices = []
    for point in body.vertices:
        vertex = TopoDS_Vertex()
        builder.MakeVertex(vertex, gp_Pnt(*point.tolist()), _TOGETHER)
        vertices.append(vertex)
    edges = [_edge(builder, edge, vertices) for edge in body.edges]
    shell, solid = TopoDS_Shell(), TopoDS_Solid()
    builder.MakeShell(shell)
    for face in body.faces:
        builder.Add(shell, _face(builder, face, body.edges, edges))
    shell.Closed(True)
    builder.MakeSolid(solid)
    builder.Add(solid, shell)
    BRepLib.SameParameter_s(solid, _TOGETHER, True)
    BRepLib.UpdateTolerances_s(solid, False)
    return solid


def _edge(builder: Any, edge: Edge, vertices: Sequence[Any]) -> Any:
    made = TopoDS_Edge()
    if edge.curve is None:
        builder.MakeEdge(made)
        builder.Degenerated(made, True)
    else:
        builder.MakeEdge(made, _curve(edge.curve), _TOGETHER)
    builder.Add(made, vertices[edge.ends[0]].Oriented(TopAbs_FORWARD))
    builder.Add(made, vertices[edge.ends[1]].Oriented(TopAbs_REVERSED))
    if edge.curve is not None:
        builder.Range(made, *edge.span)
    return made


def _face(builder: Any, face: Face, known: Sequence[Edge], edges: Sequence[Any]) -> Any:
    made = TopoDS_Face()
    builder.MakeFace(made, _surface(face.surface), _TOGETHER)
    for loop in face.loops:
        wire = TopoDS_Wire()
        builder.MakeWire(wire)
        for use in loop:
            edge = edges[use.edge]
            builder.UpdateEdge(edge, _flat(use.flat), made, _TOGETHER)
            if known[use.edge].curve is None:
                builder.Range(edge, made, *known[use.edge].span)
            builder.Add(wire, edge.Oriented(TopAbs_REVERSED if use.backwards else TopAbs_FORWARD))
        wire.Closed(True)
        builder.Add(made, wire)
    return made if face.outward else made.Reversed()


def _curve(curve: Curve) -> Any:
    """Return a curve in space."""
    if isinstance(curve, Circle):
        return Geom_Circle(gp_Ax2(gp_Pnt(0.0, 0.0, curve.height), _Z, gp_Dir(1.0, 0.0, 0.0)), curve.radius)
    if isinstance(curve, Line):
        return Geom_Line(gp_Pnt(*curve.origin), gp_Dir(*curve.direction))
    return _spline(curve)


def _spline(curve: Spline) -> Any:
    points = Array1_gp_Pnt(1, len(curve.points))
    for k, point in enumerate(curve.points.tolist(), 1):
        points.SetValue(k, gp_Pnt(*point))
    return Geom_BSplineCurve(points, *_knots(curve.knots), 3)


def _flat(curve: Curve) -> Any:
    """Return a curve in the parameters of a surface."""
    if isinstance(curve, Circle):
        return Geom2d_Circle(gp_Ax22d(gp_Pnt2d(0.0, 0.0), gp_Dir2d(1.0, 0.0)), curve.radius)
    if isinstance(curve, Line):
        return Geom2d_Line(gp_Pnt2d(*curve.origin), gp_Dir2d(*curve.direction))
    points = Array1_gp_Pnt2d(1, len(curve.points))
    for k, point in enumerate(curve.points.tolist(), 1):
        points.SetValue(k, gp_Pnt2d(*point))
    return Geom2d_BSplineCurve(points, *_knots(curve.knots), 3)


def _surface(surface: Surface) -> Any:
    if isinstance(surface, Plane):
        return Geom_Plane(gp_Ax3(gp_Pnt(0.0, 0.0, surface.height), _Z, gp_Dir(1.0, 0.0, 0.0)))
    if isinstance(surface, Cylinder):
        return Geom_CylindricalSurface(gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), _Z, _towards(surface.start)), surface.radius)
    if isinstance(surface, SplineSurface):
        return _patch(surface)
    return Geom_SurfaceOfRevolution(_spline(surface.curve), gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), _Z))


def _patch(surface: SplineSurface) -> Any:
    count, across, _ = surface.points.shape
    points = Array2_gp_Pnt(1, count, 1, across)
    for k, row in enumerate(surface.points.tolist(), 1):
        for j, point in enumerate(row, 1):
            points.SetValue(k, j, gp_Pnt(*point))
    (u, u_times), (v, v_times) = _knots(surface.u_knots), _knots(surface.v_knots)
    return Geom_BSplineSurface(points, u, v, u_times, v_times, 3, 3)


def _knots(knots: Floats) -> tuple[Any, Any]:
    """Knots that differ, and how often each one is there."""
    places, times = np.unique(knots, return_counts=True)
    values, counts = Array1_double(1, len(places)), Array1_int(1, len(places))
    for k, (place, count) in enumerate(zip(places.tolist(), times.tolist(), strict=True), 1):
        values.SetValue(k, place)
        counts.SetValue(k, count)
    return values, counts


def _towards(angle: float) -> Any:
    return gp_Dir(float(np.cos(angle)), float(np.sin(angle)), 0.0)


def _blank(order: Order) -> Any:
    """Return the stock, with its seams where no blade is."""
    stock = order.stock
    if not stock.bore:
        return _cylinder(stock.diameter / 2.0, stock.bottom, stock.height, order.seam)
    bore = _cylinder(stock.bore / 2.0, stock.bottom - _BEYOND, stock.height + 2.0 * _BEYOND, order.seam)
    return BRepAlgoAPI_Cut(_cylinder(stock.diameter / 2.0, stock.bottom, stock.height, order.seam), bore).Shape()


def _cylinder(radius: float, bottom: float, height: float, seam: float) -> Any:
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.0, 0.0, bottom), _Z, _towards(seam)), radius, height).Shape()


def _parts(shape: Any, kind: Any) -> list[Any]:
    explorer, found = TopExp_Explorer(shape, kind), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def _solids(shape: Any) -> list[Any]:
    return _parts(shape, TopAbs_SOLID)


def _fault(solid: Any) -> str:
    """Return what is wrong with a solid; '' if it is valid and closed."""
    faces_of = IndexedDataMap_TopoDS_Shape_List_TopoDS_Shape_TopTools_ShapeMapHasher()
    TopExp.MapShapesAndAncestors_s(solid, TopAbs_EDGE, TopAbs_FACE, faces_of)
    free = sum(faces_of.FindFromIndex(k).Size() < 2 for k in range(1, faces_of.Extent() + 1) if _has_curve(faces_of, k))
    if free:
        return f"{free} of its edges have a face on one side only"
    return "" if BRepCheck_Analyzer(solid, True).IsValid() else "some of its faces or edges cross or part"


def _has_curve(faces_of: Any, k: int) -> bool:
    return bool(BRepAdaptor_Curve(TopoDS.Edge(faces_of.FindKey(k))).Is3DCurve())


def _volume(solid: Any) -> float:
    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid, found, _OF_VOLUME, False, False)
    return float(found.Mass())


def _written(solid: Any, name: str) -> bytes:
    """Return the STEP file of a solid, without the date of today."""
    writer, stream = STEPControl_Writer(), io.BytesIO()
    # These settings are there once a writer is.
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
    Interface_Static.SetCVal_s("write.step.product.name", _NAME)
    writer.Transfer(solid, STEPControl_ManifoldSolidBrep)
    header = APIHeaderSection_MakeHeader(writer.Model())
    header.SetTimeStamp(TCollection_HAsciiString(_DATE))
    header.SetName(TCollection_HAsciiString(_NAME))
    header.SetAuthorValue(1, TCollection_HAsciiString(""))
    header.SetOrganizationValue(1, TCollection_HAsciiString(""))
    header.SetOriginatingSystem(TCollection_HAsciiString("Trunnion"))
    if writer.WriteStream(stream) != IFSelect_RetDone:
        return b""
    # The kernel writes names as they are and numbers those of products, where the format has ASCII alone.
    return re.sub(rb"'%b( \d+)?'" % _NAME.encode(), lambda _: _text(name), stream.getvalue())


def _text(name: str) -> bytes:
    """Return a name as a text of ISO 10303-21."""
    plain = name.replace("\\", "\\\\").replace("'", "''")
    return ("'" + re.sub(r"[^ -~]", lambda one: f"\\X4\\{ord(one[0]):08X}\\X0\\", plain) + "'").encode("ascii")


def _read(step: bytes) -> Any:
    reader = STEPControl_Reader()
    reader.ReadStream("part.stp", io.BytesIO(step))
    reader.TransferRoots()
    return reader.OneShape()


def _on_faces(faces: Sequence[Any]) -> Iterator[Floats]:
    """Points (k, 3) on faces, on a grid of their parameters."""
    for face in map(TopoDS.Face, faces):
        surface = BRepAdaptor_Surface(face)
        bounds = BRepTools.UVBounds_s(face)
        u, v = (
            low + (high - low) * (np.arange(count) + 0.5) / count
            for low, high, count in zip(bounds[::2], bounds[1::2], _GRID, strict=True)
        )
        places = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
        found = [_xyz(surface.Value(*place)) for place in places[_within(face, places)].tolist()]
        yield np.array(found).reshape(-1, 3)


def _within(face: Any, places: Floats) -> Flags:
    """Which places (k, 2) are within the edges of a face: a ray from there crosses them an odd number of times."""
    crossed = np.zeros(len(places), bool)
    for edge in map(TopoDS.Edge, _parts(face, TopAbs_EDGE)):
        curve = BRepAdaptor_Curve2d(edge, face)
        at = np.linspace(curve.FirstParameter(), curve.LastParameter(), _ALONG_EDGE)
        flat = [curve.Value(one) for one in at.tolist()]
        x, y = np.array([[point.X(), point.Y()] for point in flat]).T
        for x0, y0, x1, y1 in zip(x[:-1], y[:-1], x[1:], y[1:], strict=True):
            if y0 != y1:
                between = (places[:, 1] >= min(y0, y1)) & (places[:, 1] < max(y0, y1))
                crossed ^= between & (places[:, 0] < x0 + (places[:, 1] - y0) * (x1 - x0) / (y1 - y0))
    return crossed


def _on_edges(solid: Any) -> Iterator[Floats]:
    """Points (k, 3) on the curves of edges."""
    for edge in map(TopoDS.Edge, _parts(solid, TopAbs_EDGE)):
        curve = BRepAdaptor_Curve(edge)
        if curve.Is3DCurve():
            at = np.linspace(curve.FirstParameter(), curve.LastParameter(), _ALONG_EDGE)
            yield np.array([_xyz(curve.Value(one)) for one in at.tolist()])


def _xyz(point: Any) -> tuple[float, float, float]:
    return point.X(), point.Y(), point.Z()
