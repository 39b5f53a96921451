"""Kernels: functions that run as machine code, and the folders that keep it.

``@kernel`` marks a function that Python calls, ``@inner`` one that only kernels call. Numba compiles a kernel once for
each computer, for the types that its signature declares: when it is first called, or ahead (``trunnion prepare``). What
it makes is kept as a small library of its own, and called without Numba and without LLVM: neither is imported where
nothing is compiled. The libraries are kept under a digest of everything that was compiled into them: the kernel's own
code, that of the functions it calls in whatever file, their constants, the version of Numba and the processor. A change
of the sources recompiles the kernels that it reaches, and no others.

    arguments   what kernels take and give, by their annotations
    digest      what is compiled into a kernel
    store       the folders, and who may write to them
    library     a kept library, loaded and called
    build       libraries made of what Numba compiles: all that needs more than Numba's public interface
    runtime     what they call of Numba's runtime, written anew
    shipped     libraries that a wheel has brought
    judge       the same kernels by Numba's own way: where libraries cannot be made, and to compare with
    ahead       many kernels compiled side by side
    wheel_libraries  those for wheels, made for all systems

The log ``trunnion.jit`` says when kernels are compiled (INFO), and when machine code was damaged or cannot be kept
(WARNING).
"""

from typing import Any

import numpy as np

from trunnion.jit.ahead import compile_ahead, is_first_run
from trunnion.jit.inner_functions import inlined, inner
from trunnion.jit.kernels import kernel

#: Kernels that scan bytes keep positions as unsigned numbers: Numba asks of every signed index whether it counts from
#: the end, which takes a third of their time. A sum of signed and unsigned would be a float: add ``ONE``, and come
#: back with ``signed``.
unsigned: Any = np.uint64
signed: Any = np.int64
ONE: Any = np.uint64(1)

__all__ = ["ONE", "compile_ahead", "inlined", "inner", "is_first_run", "kernel", "signed", "unsigned"]
