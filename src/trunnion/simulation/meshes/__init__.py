"""Triangle meshes: read from files, made from boxes and cylinders, judged, and written.

Units: mm. Vertices are in whatever frame the caller means; a mesh knows none.
"""

from trunnion.simulation.meshes.findings import MeshFindings, judge_mesh
from trunnion.simulation.meshes.picture import picture
from trunnion.simulation.meshes.primitives import box_mesh, cylinder_mesh, revolved_mesh
from trunnion.simulation.meshes.reading import DEVIATION, MESH_FORMATS, MeshUnit, load_mesh
from trunnion.simulation.meshes.step import STEP_ENDINGS
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh
from trunnion.simulation.meshes.writing import check_mesh_name, save_mesh

__all__ = [
    "DEVIATION",
    "MESH_FORMATS",
    "STEP_ENDINGS",
    "MeshFindings",
    "MeshUnit",
    "TriangleMesh",
    "box_mesh",
    "check_mesh_name",
    "cylinder_mesh",
    "judge_mesh",
    "load_mesh",
    "picture",
    "revolved_mesh",
    "save_mesh",
]
