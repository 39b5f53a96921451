"""The seal of a share that is kept: what it is a share of, and a checksum of it, so that no other one passes for it.

A kept share is a line of JSON and the share itself: the line has the key of all that it was made from, its number and
how many there are, the file that it is of, and the SHA-256 of what follows. The name of a file says none of this: files
are renamed and copied.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Final

from trunnion.batch.result_keys import digest
from trunnion.batch.stores import Kept, TakenError
from trunnion.records import dataclass

#: What a kept share begins with; the longest line that is read.
_MARK: Final = b"trunnion share 1 "
_LONGEST: Final = 65536


class BrokenSealError(ValueError):
    """A kept share is not as it was written, or is another one."""


@dataclass(frozen=True, slots=True)
class Seal:
    """What a share is.

    key     of all that it was made from (``keys.key_of``)
    number  its own, from 0
    of      how many there are
    file    which the simulation is of, beside the jobs
    """

    key: str
    number: int
    of: int
    file: str


def sealed(share: bytes, seal: Seal) -> bytes:
    """Return a share as it is kept."""
    line = json.dumps({**asdict(seal), "sha256": digest(share)}, sort_keys=True)
    return _MARK + line.encode("ascii") + b"\n" + share


def unsealed(content: bytes | None, seal: Seal) -> bytes:
    """Return the share that is kept.

    Raises ``BrokenSealError`` if it is not the one of this seal, or not as it was written.
    """
    name = f"share {seal.number + 1} of {seal.of}"
    if not content:
        raise BrokenSealError(f"{name} is gone, or empty")
    found, checksum, share = _read(content)
    if found is None:
        raise BrokenSealError(f"{name} is no share of a simulation")
    if (found.key, found.number, found.of) != (seal.key, seal.number, seal.of):
        raise BrokenSealError(f"{name} is one of another simulation, of {found.file[:200]}")
    if digest(share) != checksum:
        raise BrokenSealError(f"{name} was changed, or cut short")
    return share


def file_of(content: bytes | None) -> str | None:
    """Return the file that a kept share is of; None: it does not say."""
    found = None if content is None else _read(content)[0]
    return None if found is None else found.file


def unsealed_all(contents: Sequence[bytes | Kept], seals: Sequence[Seal]) -> list[bytes]:
    """All shares of a simulation; those that only have a name are read.

    Raises ``BrokenSealError`` as ``unsealed``.
    """
    try:
        return [
            unsealed(each.read() if isinstance(each, Kept) else each, seal)
            for each, seal in zip(contents, seals, strict=True)
        ]
    except TakenError as error:
        raise BrokenSealError(error.problems[0].what) from None


def _read(content: bytes) -> tuple[Seal | None, str, bytes]:
    """Return the seal, the checksum that it has, and what follows."""
    end = content.find(b"\n", 0, _LONGEST)
    try:
        if end < 0 or not content.startswith(_MARK):
            return None, "", b""
        values = json.loads(content[len(_MARK) : end])
        checksum = values.pop("sha256")
        seal = Seal(**values)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None, "", b""
    is_sound = isinstance(seal.key, str) and isinstance(seal.file, str) and isinstance(checksum, str)
    return (seal if is_sound else None), checksum, content[end + 1 :]
