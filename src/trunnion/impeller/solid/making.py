"""An impeller as a solid of exact surfaces, in a STEP file.

In:     ``Impeller``.
Out:    ``ImpellerSolid``: the bytes of the file, and how good it is.
Units:  mm.
"""

import importlib.util
import pickle
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.impeller.blade import Blade
from trunnion.impeller.deviation import off_surfaces
from trunnion.impeller.fillet import Fillet, root_fillet, root_stations
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.model import impeller_model
from trunnion.impeller.solid.impeller_body import impeller_body
from trunnion.impeller.solid.order import Made, Order, Refusal
from trunnion.impeller.solid.root_loop import Density, carried_on
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

#: Points of patches; the next of them where patches are too far off, or the kernel makes no solid.
_DENSITIES: Final = (Density(97, 17, 13, 9), Density(193, 25, 17, 17), Density(385, 33, 25, 25))

#: The mesh that the volume is compared with is this exact, as a part of the stock's diameter.
_MESH: Final = 2e-4

#: Part of the volume by which solid and mesh may differ.
_VOLUME: Final = 1e-3

#: Stations of the fillets that deviations are measured from: along a side, and round an edge.
_STATIONS: Final = (1501, 151)

#: Seconds after which the kernel is given up.
_LONGEST: Final = 600.0

#: The process ends with this where the kernel cannot be loaded.
_NOT_LOADED: Final = 3

#: What the process does: the kernel prints to stdout, so that the answer goes through a copy of it.
_CHILD: Final = """
import os, pickle, sys
answer = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
sys.path.append(sys.argv[1])
try:
    from trunnion.impeller.solid.open_cascade import make
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(3)
answer.write(pickle.dumps(make(pickle.load(sys.stdin.buffer))))
answer.close()
"""


@dataclass(frozen=True, slots=True, eq=False)
class ImpellerSolid:
    """An impeller as a valid, closed solid of exact surfaces.

    step         the bytes of its STEP file
    volume       mm³
    faces        their number
    deviation    how far its faces and edges are from the exact surfaces at most, mm
    mesh         a closed mesh of the impeller, made in another way
    """

    step: Annotated[bytes, NOT_DATA]
    volume: Annotated[float, Figure(unit="mm3", decimals=6)]
    faces: int
    deviation: Annotated[float, Figure(unit="mm", decimals=6)]
    mesh: Annotated[TriangleMesh, Figure("extents", take=attrgetter("bounds"))]


def impeller_solid(impeller: Impeller, tolerance: float) -> ImpellerSolid:
    """Make an impeller a solid.

    It is judged as it is read back from its file: valid, closed, of one body, within the tolerance of the exact
    surfaces, and of the volume of the mesh.

    impeller   its surfaces
    tolerance  mm: how far faces and edges may be off the surfaces

    Raises ``InputError`` if there is no such solid, or the extra ``cad`` is not installed.
    """
    if importlib.util.find_spec("OCP") is None:
        import_extra("OCP", "cad")
    file = impeller.definition.file
    with ThreadPoolExecutor(1) as beside:
        waiting = beside.submit(impeller_model, impeller, _MESH * impeller.definition.stock.diameter)
        try:
            made, deviation = _within(impeller, tolerance)
        except InputError:
            waiting.result()  # what makes no mesh either is named with its line
            raise
        mesh = waiting.result().mesh
    if abs(made.volume - mesh.volume) > _VOLUME * mesh.volume:
        raise InputError(
            Problem(file, 0, Wording("IMP420", "solid_mm_mesh", volume=made.volume, mesh_volume=mesh.volume))
        )
    return ImpellerSolid(made.step, made.volume, made.faces, deviation, mesh)


def _within(impeller: Impeller, tolerance: float) -> tuple[Made, float]:
    """Return the first solid that is within the tolerance, and how far it is off."""
    fillets = list(_fine_fillets(impeller))
    why = ""
    for density in _DENSITIES:
        body, angles = impeller_body(impeller, density)
        made = _asked(Order(body, impeller.definition.stock, _free_angle(angles), impeller.definition.name))
        if isinstance(made, Refusal):
            why = made.why
            continue
        deviation = float(off_surfaces(impeller, made.points, fillets).max())
        if deviation <= tolerance:
            return made, deviation
        why = f"its faces are {deviation:.4f} mm off the exact surfaces, more than {tolerance:g} mm"
    raise InputError(Problem(impeller.definition.file, 0, Wording("IMP420", "makes_no_solid", why=why)))


def _fine_fillets(impeller: Impeller) -> Iterator[tuple[Blade, Fillet]]:
    stations = root_stations(*_STATIONS, round_trailing=impeller.definition.trailing_edge == "round")
    for blade in (impeller.blade, impeller.splitter):
        if blade is not None:
            yield blade, root_fillet(carried_on(impeller, blade), impeller.hub, impeller.definition.fillet, stations)


def _free_angle(angles: Floats) -> float:
    """Return the angle about Z that is farthest from those given (k,)."""
    once = np.sort(angles % (2.0 * np.pi))
    gaps = np.diff(np.r_[once, once[0] + 2.0 * np.pi])
    k = int(gaps.argmax())
    return float(once[k] + 0.5 * gaps[k])


def _asked(order: Order) -> Made | Refusal:
    """Return what the kernel answers, in a process of its own.

    Raises ``InputError`` if it cannot be loaded, or does not come to an end.
    """
    # -P: no module of the current folder is run.
    command = [sys.executable, "-P", "-c", _CHILD, str(Path(__file__).parents[3])]
    try:
        done = subprocess.run(command, input=pickle.dumps(order), capture_output=True, check=False, timeout=_LONGEST)
    except subprocess.TimeoutExpired:
        raise InputError(
            Problem("trunnion", 0, Wording("IMP421", "open_cascade_makes", order=order.name, longest=_LONGEST))
        ) from None
    said = done.stderr.decode("utf-8", "replace").strip().splitlines()
    last = said[-1][:200] if said else f"it ends with {done.returncode}"
    if done.returncode == _NOT_LOADED:
        raise InputError(
            Problem(
                "trunnion",
                0,
                Wording("IMP421", "cannot_load_open", said=said[-1][:200])
                if said
                else Wording("IMP421", "cannot_load_open_cascade", returncode=done.returncode),
            )
        )
    if done.returncode or not done.stdout:
        return Refusal(f"Open CASCADE fails: {last}")
    answer = pickle.loads(done.stdout)
    assert isinstance(answer, Made | Refusal)
    return answer
