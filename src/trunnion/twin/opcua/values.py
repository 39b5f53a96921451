"""Values that are published to many subscribers at once: each is encoded once.

asyncua encodes a value for every subscriber that is notified of it, and copies it for each before. Here a value is
made, keeps its encoding, and is never changed.
"""

import struct
from datetime import UTC, datetime
from functools import lru_cache
from typing import Any, Final

from asyncua import ua
from asyncua.ua.ua_binary import struct_to_binary

#: What DataValue holds, as bits of its encoding: value, source time, server time (OPC 10000-6, 5.2.2.17).
_DOUBLE: Final = struct.Struct("<BBdqq")
_HAS_VALUE_AND_TIMES: Final = 0x01 | 0x04 | 0x08
_DOUBLE_TYPE: Final = 11

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_TICKS_BEFORE_EPOCH: Final = 116_444_736_000_000_000

#: Values were lost before this one (OPC 10000-4, 7.39: DataValue info, Overflow).
OVERFLOW: Final = 0x00000480


class PublishedValue(ua.DataValue):
    """A value that is never changed, with its encoding once somebody needed it."""

    __slots__ = ("_encoded",)
    _encoded: bytes

    def encoded(self) -> bytes:
        """Return the bytes of the value as a DataValue."""
        try:
            known: bytes = self._encoded
        except AttributeError:
            self._encoded = known = _encode(self)
        return known


def published(value: Any, kind: ua.VariantType, stamp: datetime, status: ua.StatusCode | None = None) -> PublishedValue:
    """Return a value of a time; ``status``: Good, if it is left out."""
    variant = ua.Variant(value, kind) if value is not None else ua.Variant()
    return PublishedValue(variant, status or ua.StatusCode(), stamp, stamp)


def _encode(value: PublishedValue) -> bytes:
    variant, stamp = value.Value, value.SourceTimestamp
    plain = variant is not None and variant.VariantType is ua.VariantType.Double and type(variant.Value) is float
    if plain and stamp is not None and value.StatusCode is not None and value.StatusCode.value == 0:
        ticks = _ticks(stamp)
        return _DOUBLE.pack(_HAS_VALUE_AND_TIMES, _DOUBLE_TYPE, variant.Value, ticks, ticks)
    return bytes(struct_to_binary(value))


@lru_cache(maxsize=4)
def _ticks(stamp: datetime) -> int:
    """100 ns since 1601."""
    since = stamp - _EPOCH
    return _TICKS_BEFORE_EPOCH + (since.days * 86_400_000_000 + since.seconds * 1_000_000 + since.microseconds) * 10


def encoded(value: ua.DataValue) -> bytes:
    """Return the bytes of any DataValue."""
    return value.encoded() if isinstance(value, PublishedValue) else bytes(struct_to_binary(value))


def overflowed(value: ua.DataValue) -> bytes:
    """Return the bytes of a value before which others were lost."""
    status = ua.StatusCode((value.StatusCode.value if value.StatusCode else 0) | OVERFLOW)
    return bytes(struct_to_binary(ua.DataValue(value.Value, status, value.SourceTimestamp, value.ServerTimestamp)))
