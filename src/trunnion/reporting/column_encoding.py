"""Columns as text inside a page: small, lossless, and quick to decode in a browser.

A column of 32-bit words, float or integer, becomes the differences of its bit patterns. Their bytes are sorted by
significance, lowest bytes first, deflated, and written in base64. Neighbours on a tool path resemble each other, so the
upper bytes are nearly all alike. ``unpack`` in unpack.js does the reverse.
"""

import base64
import zlib

import numpy as np
from numpy.typing import NDArray

#: From 1 to 9. Level 6 takes 2.5 times as long, for 2.4 % less.
COMPRESSION_LEVEL = 4


def encode_column(column: NDArray[np.float32] | NDArray[np.int32]) -> bytes:
    """Return a column (n,) as base64 text."""
    words = np.ascontiguousarray(column).view(np.uint32)
    changes = np.diff(words, prepend=np.uint32(0)).astype("<u4")
    planes = changes.view(np.uint8).reshape(-1, 4).T.tobytes()
    return base64.b64encode(zlib.compress(planes, COMPRESSION_LEVEL))
