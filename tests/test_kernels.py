"""Machine code that was kept does what it did when it was compiled, and leaves room for more."""

import os
import subprocess
import sys
from pathlib import Path

SOURCE = """
import math

import numpy as np

from trunnion.jit import njit


@njit(cache=True)
def length(values):
    return math.sqrt((values * values).sum())


@njit(cache=True, nogil=True)
def doubled(values):
    out = np.empty(len(values))
    for k in range(len(values)):
        out[k] = 2.0 * values[k] + math.atan2(length(values[k : k + 1]), 1.0) % 1.0
    return out
"""

RUN = """
import numpy as np
from some_kernels import doubled, length

values = np.array([0.5, -2.0, 3.0])
print(doubled(values).tolist())
hits = sum(doubled.stats.cache_hits.values())
print(doubled(values.astype(np.float32)).tolist(), length(values))
print(hits, sum(doubled.stats.cache_hits.values()), sum(length.stats.cache_hits.values()))
"""


def run(folder: Path, script: str) -> list[str]:
    """What a fresh process prints that keeps its kernels in a folder."""
    path = os.pathsep.join((str(folder), str(Path(__file__).parents[1] / "src")))
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "kept"), "PYTHONPATH": path}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)

    return done.stdout.splitlines()


def test_what_is_loaded_is_what_was_compiled_and_more_can_be_compiled_after_it(tmp_path: Path) -> None:
    (tmp_path / "some_kernels.py").write_text(SOURCE, encoding="utf-8")
    first_types_only = RUN.replace("print(doubled(values.astype(np.float32)).tolist(), length(values))", "print()")
    compiled = run(tmp_path, first_types_only)
    mixed = run(tmp_path, RUN)
    loaded = run(tmp_path, RUN)

    assert compiled[2] == "0 0 0"
    assert mixed[0] == loaded[0] == compiled[0]
    assert mixed[2] == "1 1 1"  # other types are compiled where the first were loaded; what that calls is known
    assert loaded[1] == mixed[1]
    assert loaded[2] == "1 2 1"


AHEAD = """
import numpy as np
from some_kernels import doubled, length
from trunnion.jit import load

load(doubled, length)
print(len(doubled.signatures), sum(doubled.stats.cache_hits.values()), sum(doubled.stats.cache_misses.values()))
print(doubled(np.array([0.5, -2.0, 3.0])).tolist())
print(len(doubled.signatures), sum(doubled.stats.cache_hits.values()), sum(doubled.stats.cache_misses.values()))
"""


def test_what_is_kept_can_be_loaded_ahead_and_nothing_is_compiled_for_it(tmp_path: Path) -> None:
    (tmp_path / "some_kernels.py").write_text(SOURCE, encoding="utf-8")
    fresh = run(tmp_path, AHEAD)
    kept = run(tmp_path, AHEAD)

    assert fresh[0] == "0 0 0"  # nothing is kept yet
    assert fresh[1] == kept[1]
    assert kept[0] == kept[2] == "1 1 0"


def test_what_was_kept_of_other_sources_is_not_loaded(tmp_path: Path) -> None:
    (tmp_path / "some_kernels.py").write_text(SOURCE, encoding="utf-8")
    run(tmp_path, AHEAD)
    (tmp_path / "some_kernels.py").write_text(SOURCE.replace("2.0 *", "3.0 *"), encoding="utf-8")

    assert run(tmp_path, AHEAD)[0] == "0 0 0"


def test_without_compiling_a_kernel_is_the_function_itself(tmp_path: Path) -> None:
    (tmp_path / "some_kernels.py").write_text(SOURCE, encoding="utf-8")
    script = "import os; os.environ['NUMBA_DISABLE_JIT'] = '1'\nimport some_kernels\nprint(type(some_kernels.length))"

    assert run(tmp_path, script) == ["<class 'function'>"]
