"""Kernels: functions that run as machine code, and the folders that keep it.

``@kernel`` marks a function that Python calls, ``@inner`` one that only kernels call. Numba compiles a kernel once, for
the types that its signature declares, when it is first called. The machine code is kept on disk under a digest of
everything that was compiled into it: the kernel's own code, that of the functions it calls in whatever file, and their
constants. Numba by itself looks at the kernel's own file only. A change of the sources recompiles the kernels that it
reaches, and no others.

The log ``trunnion.jit`` says when kernels are compiled (INFO), and when machine code was damaged or cannot be kept
(WARNING).
"""

from typing import Any

import numpy as np

from trunnion.jit.ahead import compile_ahead, is_first_run
from trunnion.jit.kernels import inlined, inner, kernel

#: Kernels that scan bytes keep positions as unsigned numbers: Numba asks of every signed index whether it counts from
#: the end, which takes a third of their time. A sum of signed and unsigned would be a float: add ``ONE``, and come
#: back with ``signed``.
unsigned: Any = np.uint64
signed: Any = np.int64
ONE: Any = np.uint64(1)

__all__ = ["ONE", "compile_ahead", "inlined", "inner", "is_first_run", "kernel", "signed", "unsigned"]
