"""Kernels in a folder of their own, and processes that run them."""

import os
import subprocess
import sys
from pathlib import Path

from tests.support.locations import ROOT

INNER = """
from trunnion.jit import inner

FACTOR = 2.0


@inner
def scaled(value):
    return FACTOR * value


@inner
def folded(value):
    return value % 360.0
"""

KERNELS = """
from some_inner import folded, scaled
from trunnion.arrays import Floats, Floats2
from trunnion.jit import kernel


@kernel(writes="out")
def double(values: Floats, out: Floats) -> None:
    for k in range(len(values)):
        out[k] = scaled(values[k])


@kernel(writes="out")
def fold(table: Floats2, turn: tuple[int, float], out: Floats) -> bool:
    for k in range(len(table)):
        out[k] = folded(table[k, turn[0]] + turn[1])
    return True
"""

RUN = """
import numpy as np
from some_kernels import double, fold

values, out, again = np.array([0.5, 1.0, -2.0, 1.0, 300.0])[::2], np.empty(3), np.empty(3)
values.flags.writeable = False
double(values, out)
fold(values[:, None], (0, 90.0), again)
print(out.tolist(), again.tolist())
print(double.was_loaded, fold.was_loaded)
"""

WHAT_IS_IMPORTED = """
import sys
print(*sorted({"numba", "llvmlite"} & sys.modules.keys()))
"""

SHOW_LOG = "import logging; logging.basicConfig(level='INFO', format='%(message)s')\n"


#: A folder with two modules of kernels, and what the process printed that compiled them into its folder ``kept``.
Compiled = tuple[Path, list[str]]


def write_modules(folder: Path) -> Path:
    """Write two modules of kernels into a folder."""
    (folder / "some_inner.py").write_text(INNER, encoding="utf-8")
    (folder / "some_kernels.py").write_text(KERNELS, encoding="utf-8")
    return folder


def run(folder: Path, script: str = RUN, modules: Path | None = None, **environment: str) -> list[str]:
    """What a fresh process prints that keeps its kernels in a folder, where its modules are unless they are named."""
    path = os.pathsep.join((str(folder), str(modules or folder), str(ROOT / "src")))
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "kept"), "PYTHONPATH": path, **environment}
    done = subprocess.run(
        [sys.executable, "-c", SHOW_LOG + script], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.splitlines() + done.stderr.splitlines()


def machine_code(kept: Path, kernel: str) -> Path:
    """Return the file that keeps the machine code of a kernel."""
    (file,) = (each for each in kept.glob(f"kept/*/{kernel}-*") if each.suffix in (".so", ".o"))
    return file
