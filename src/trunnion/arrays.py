"""Names of the array types in signatures, arrays that stay as they are, and the values that occur in one.

Lines are line numbers, codes are members of an ``IntEnum``.
"""

from typing import Annotated, Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Lines: TypeAlias = NDArray[np.int32]
Codes: TypeAlias = NDArray[np.uint8]
Flags: TypeAlias = NDArray[np.bool_]
Bytes: TypeAlias = NDArray[np.uint8]

Scalar = TypeVar("Scalar", bound=np.generic)

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


def distinct(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return the values that occur, each once, in ascending order; NaN last.

    NumPy's own ``unique`` imports its masked arrays, which takes an eighth of the post of 200 lines, and looks long
    columns up in a hash table, which takes longer than to sort them.
    """
    ordered = np.sort(values, axis=None)
    is_first = np.ones(len(ordered), np.bool_)
    np.not_equal(ordered[1:], ordered[:-1], out=is_first[1:])
    if len(ordered) and ordered[-1] != ordered[-1]:
        is_first[np.searchsorted(ordered, ordered[-1]) + 1 :] = False
    return ordered[is_first]
