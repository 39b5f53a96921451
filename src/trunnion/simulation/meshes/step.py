"""STEP: exact surfaces, made facets by Open CASCADE in a process of its own.

In:     the bytes of a file, and how far facets may be off the surfaces.
Out:    vertices in mm and faces, of all bodies where the assembly has them.

A library of a million lines reads a file that anybody may have written: if it fails or hangs, only its process does.
"""

import importlib.util
import re
import subprocess
import sys
from typing import Final

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.messages import Wording
from trunnion.simulation.meshes.trimesh_formats import read_by_trimesh

#: Endings of STEP files.
STEP_ENDINGS: Final = (".step", ".stp")

#: An edge of a round surface turns by no more than this from facet to facet, rad.
_TURN: Final = 0.5

#: Seconds after which it is given up.
_LONGEST: Final = 600.0

#: What the process does: the library prints to stdout, so that the result goes through a copy of it.
_CHILD: Final = """
import os, sys
result = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
import cascadio
data = sys.stdin.buffer.read()
near, turn = map(float, sys.argv[1:])
made = cascadio.load(data, file_type="step", tol_linear=near, tol_angular=turn, use_parallel=False)
result.write(made)
result.close()
"""


def read_step(data: bytes, label: str, deviation: float) -> tuple[Floats, Ints]:
    """Read a STEP file.

    data       its bytes
    label      what messages call it
    deviation  how far facets may be off the surfaces, mm

    Raises ``InputError`` if it is damaged or names other files, or the extra ``cad`` is not installed.
    """
    if importlib.util.find_spec("cascadio") is None:
        import_extra("cascadio", "cad")
    if re.search(rb"=\s*DOCUMENT_FILE\s*\(", data):
        raise InputError(Problem(label, 0, Wording("SIM217", "parts_other_files")))
    # -P: no module of the current folder is run.
    command = [sys.executable, "-P", "-c", _CHILD, repr(deviation), repr(_TURN)]
    try:
        done = subprocess.run(command, input=data, capture_output=True, check=False, timeout=_LONGEST)
    except subprocess.TimeoutExpired:
        raise InputError(Problem(label, 0, Wording("SIM212", "not_made_facets", longest=_LONGEST))) from None
    said = re.sub(r"\x1b\[[0-9;]*m", "", done.stderr.decode("utf-8", "replace"))
    if done.returncode or not done.stdout:
        raise InputError(Problem(label, 0, Wording("SIM210", "damaged", reason=_reason(said))))
    if "without geometry" in said:
        raise InputError(Problem(label, 0, Wording("SIM210", "body_whose_surface")))
    vertices, faces = read_by_trimesh(done.stdout, "glb", label, "cad")
    return 1000.0 * vertices, faces


def _reason(said: str) -> str:
    """Return what the library says of a file, in a line."""
    errors = [line.strip(" *") for line in said.splitlines() if "ERR" in line] or said.strip().splitlines()[-1:]
    return errors[0].removeprefix("ERR StepFile :").strip()[:120] if errors else "it cannot be read"
