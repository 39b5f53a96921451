"""Names of the array types in signatures, and arrays that stay as they are.

Lines are line numbers, codes are members of an ``IntEnum``.
"""

from typing import Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Lines: TypeAlias = NDArray[np.int32]
Codes: TypeAlias = NDArray[np.uint8]
Flags: TypeAlias = NDArray[np.bool_]
Bytes: TypeAlias = NDArray[np.uint8]

# In the signature of a kernel an array has one dimension, unless its name says more (``trunnion.jit.kernel``).
Floats2: TypeAlias = Annotated[Floats, 2]
Floats3: TypeAlias = Annotated[Floats, 3]
Ints2: TypeAlias = Annotated[Ints, 2]
Ints3: TypeAlias = Annotated[Ints, 3]
Flags2: TypeAlias = Annotated[Flags, 2]
Codes2: TypeAlias = Annotated[Codes, 2]
Bytes2: TypeAlias = Annotated[Bytes, 2]


def make_read_only(*arrays: NDArray[Any] | None) -> None:
    """Let nothing write into arrays; None stands for one that is not there."""
    for array in arrays:
        if array is not None:
            array.setflags(write=False)
