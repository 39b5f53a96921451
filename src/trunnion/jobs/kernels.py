"""The kernels that most calls of the library need, in the order in which they need them (``jit.compile_ahead``)."""

from typing import Any, Final

from trunnion import cl, output, planning, readers, verification

VERIFYING: Final[tuple[Any, ...]] = (*readers.KERNELS, *verification.KERNELS)
CONVERTING: Final[tuple[Any, ...]] = (*readers.KERNELS, *planning.KERNELS, *output.KERNELS, *verification.KERNELS)
POSTING: Final[tuple[Any, ...]] = (*cl.KERNELS, *planning.KERNELS, *output.KERNELS, *VERIFYING)
