"""OBJ, PLY and GLB, by trimesh.

In:     the bytes of a file.
Out:    vertices and faces in its own unit and frame.
"""

import io
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.messages import Wording

#: Packages that trimesh asks, where they are installed, in what code a text is that is not UTF-8.
_GUESSERS: Final = frozenset({"charset_normalizer", "chardet"})


def read_by_trimesh(data: bytes, ending: str, label: str, extra: str = "simulate") -> tuple[Floats, Ints]:
    """Read a file.

    Raises ``InputError`` if it is damaged, or trimesh is not installed, which comes with ``extra``.
    """
    trimesh = import_extra("trimesh", extra)
    try:
        # Without a resolver no other file is opened, whatever this one names.
        scene: Any = trimesh.load_scene(io.BytesIO(data), file_type=ending, process=False, maintain_order=True)
        mesh = scene.to_mesh()
        vertices = np.array(mesh.vertices, np.float64).reshape(-1, 3)
        faces = np.array(mesh.faces, np.int64).reshape(-1, 3)
    except MemoryError:
        raise
    except ImportError as error:
        if error.name in _GUESSERS:
            raise InputError(Problem(label, 0, Wording("SIM210", "damaged_text_not"))) from None
        raise
    except Exception as error:  # whatever a parser raises for a damaged file
        reason = str(error).strip().split("\n")[0][:100] or type(error).__name__
        raise InputError(Problem(label, 0, Wording("SIM210", "damaged_mesh", reason=reason))) from None
    if len(faces) and not (faces.min() >= 0 and faces.max() < len(vertices)):
        raise InputError(Problem(label, 0, Wording("SIM210", "damaged_facet_names")))
    return vertices, faces
