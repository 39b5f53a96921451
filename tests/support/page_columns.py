"""Columns of pages, read as a browser does."""

import base64
import zlib

import numpy as np
from numpy.typing import NDArray


def decode_column(text: bytes) -> NDArray[np.int32]:
    """Return the words (n,) of an encoded column; ``.view(np.float32)`` makes them floats again."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(4, -1)
    changes = np.ascontiguousarray(planes.T).view("<u4").ravel()
    return np.cumsum(changes, dtype=np.uint32).view(np.int32)
