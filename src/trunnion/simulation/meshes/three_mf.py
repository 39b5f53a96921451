"""3MF: a packed folder whose model is XML, with its unit."""

import io
import xml.etree.ElementTree as ET
import zipfile
import zlib
from dataclasses import field
from typing import Final
from xml.sax.saxutils import quoteattr

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

_CORE: Final = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_MODEL: Final = "3D/3dmodel.model"

_UNITS: Final = {
    "micron": 0.001, "millimeter": 1.0, "centimeter": 10.0, "inch": 25.4, "foot": 304.8, "meter": 1000.0
}  # fmt: skip

#: Objects made of objects, deeper than any exporter makes them.
_MAX_DEPTH: Final = 16


@dataclass(slots=True)
class _Object:
    """An object of the model: its own mesh, and the objects that it is made of with their places."""

    vertices: list[tuple[float, float, float]] = field(default_factory=list)
    faces: list[tuple[int, int, int]] = field(default_factory=list)
    parts: list[tuple[str, Floats]] = field(default_factory=list)


def read_three_mf(data: bytes, label: str, max_bytes: int, max_facets: int) -> tuple[Floats, Ints, float]:
    """Return the vertices in the unit of the file, the faces and that unit in mm, of all items that the file builds.

    Raises ``InputError`` if the file is damaged or unpacks to more than ``max_bytes``.
    """
    try:
        model = _unpacked(data, label, max_bytes)
        objects, items, unit = _parsed(model)
        collected = _Collected(objects, label, max_facets)
        for name, place in items:
            collected.add(name, place, 0)
    except (
        KeyError, ValueError, ET.ParseError, zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, OSError,
    ) as error:  # fmt: skip
        raise InputError(Problem(label, 0, Wording("SIM210", "damaged_file", error=error))) from None
    except RuntimeError as error:  # a packed file with a password
        raise InputError(Problem(label, 0, Wording("SIM210", "cannot_unpacked", error=error))) from None
    vertices = np.concatenate([np.zeros((0, 3)), *collected.vertices])
    return vertices, np.concatenate([np.zeros((0, 3), np.int64), *collected.faces]), unit


def write_three_mf(mesh: TriangleMesh) -> bytes:
    """Return a file with one object, in mm."""
    vertices = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in mesh.vertices.tolist())
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces.tolist())
    model = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<model unit="millimeter" xmlns="{_CORE}"><resources>'
        f'<object id="1" name={quoteattr(mesh.name or "part")} type="model"><mesh><vertices>{vertices}</vertices>'
        f'<triangles>{faces}</triangles></mesh></object></resources><build><item objectid="1"/></build></model>\n'
    )
    types = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>\n'
    )
    relations = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        f'<Relationship Id="rel0" Target="/{_MODEL}" '
        'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>\n'
    )
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (("[Content_Types].xml", types), ("_rels/.rels", relations), (_MODEL, model)):
            # The same mesh gives the same bytes: no clock goes into the file.
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, text)
    return packed.getvalue()


def _unpacked(data: bytes, label: str, max_bytes: int) -> bytes:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        names = [name for name in archive.namelist() if name.lstrip("/").lower().endswith(".model")]
        if len(names) != 1:
            raise InputError(Problem(label, 0, Wording("SIM217", "holds_models_where", count=len(names))))
        with archive.open(names[0]) as stream:
            model = stream.read(max_bytes + 1)
    if len(model) > max_bytes:
        raise InputError(Problem(label, 0, Wording("SIM212", "unpacks_more_mb", max_bytes=max_bytes // 1000000)))
    if b"<!" in model[:4096].replace(b"<!--", b""):
        raise InputError(Problem(label, 0, Wording("SIM210", "declares_entities_no")))
    return model


def _parsed(model: bytes) -> tuple[dict[str, _Object], list[tuple[str, Floats]], float]:
    objects: dict[str, _Object] = {}
    items: list[tuple[str, Floats]] = []
    unit, current = 1.0, _Object()
    for event, element in ET.iterparse(io.BytesIO(model), ("start", "end")):
        tag, get = element.tag.rpartition("}")[2], element.attrib
        if event == "start":
            if tag == "model":
                unit = _UNITS[get.get("unit", "millimeter")]
            elif tag == "object":
                current = objects[get["id"]] = _Object()
            continue
        if tag == "vertex":
            current.vertices.append((float(get["x"]), float(get["y"]), float(get["z"])))
        elif tag == "triangle":
            current.faces.append((int(get["v1"]), int(get["v2"]), int(get["v3"])))
        elif tag == "component":
            current.parts.append((get["objectid"], _place(get.get("transform"))))
        elif tag == "item":
            items.append((get["objectid"], _place(get.get("transform"))))
        element.clear()
    return objects, items, unit


def _place(text: str | None) -> Floats:
    """Return the map (4, 3) that rows of points with a fourth 1 are multiplied by."""
    if text is None:
        return np.eye(4, 3)
    return np.array([float(word) for word in text.split()]).reshape(4, 3)


@dataclass(slots=True)
class _Collected:
    objects: dict[str, _Object]
    label: str
    max_facets: int
    vertices: list[Floats] = field(default_factory=list)
    faces: list[Ints] = field(default_factory=list)
    count: int = 0
    facets: int = 0

    def add(self, name: str, place: Floats, depth: int) -> None:
        """Add an object, and those that it is made of, at a place."""
        if depth > _MAX_DEPTH:
            raise ValueError("its objects contain each other")
        found = self.objects[name]
        self.facets += len(found.faces) + 1  # an object without facets counts too, so that none multiply without end
        if self.facets > self.max_facets:
            raise InputError(Problem(self.label, 0, Wording("SIM212", "more_facets", max_facets=self.max_facets)))
        if found.faces:
            points = np.array(found.vertices, np.float64).reshape(-1, 3)
            faces = np.array(found.faces, np.int64)
            if not (faces.min() >= 0 and faces.max() < len(points)):
                raise ValueError("a facet names a vertex that is not there")
            mirrored = np.linalg.det(place[:3]) < 0.0
            self.vertices.append(points @ place[:3] + place[3])
            self.faces.append((faces[:, ::-1] if mirrored else faces) + self.count)
            self.count += len(points)
        for part, local in found.parts:
            self.add(part, np.concatenate((local[:3] @ place[:3], [local[3] @ place[:3] + place[3]])), depth + 1)
