"""Columns as text that a page can hold: small, without loss, and quick to unpack in a browser.

A column of 32-bit words, float or integer, becomes the differences of its bit patterns; their bytes are sorted by
place, all lowest bytes first; that is deflated and written in base64. Neighbours on a tool path resemble each other, so
the upper bytes are nearly all alike. ``unpack`` in page.js does the reverse.
"""

import base64
import zlib

import numpy as np
from numpy.typing import NDArray

#: Effort of the compression, 1 to 9: higher ones are much slower and save little.
COMPRESSION_LEVEL = 6


def encode_column(column: NDArray[np.float32] | NDArray[np.int32]) -> bytes:
    """Return the column as base64 text."""
    words = np.ascontiguousarray(column).view(np.uint32)
    changes = np.diff(words, prepend=np.uint32(0)).astype("<u4")
    places = changes.view(np.uint8).reshape(-1, 4).T.tobytes()
    return base64.b64encode(zlib.compress(places, COMPRESSION_LEVEL))


def decode_column(text: bytes) -> NDArray[np.int32]:
    """Return the words of a packed column; ``.view(np.float32)`` makes numbers of them."""
    places = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(4, -1)
    changes = np.ascontiguousarray(places.T).view("<u4").ravel()
    return np.cumsum(changes, dtype=np.uint32).view(np.int32)
