"""What decides whether a result is still that of its file: checksums of all that it was made from."""

import hashlib
import json
import os
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from trunnion.version import __version__


def digest(content: bytes) -> str:
    """SHA-256 of bytes, hexadecimal."""
    return hashlib.sha256(content).hexdigest()


@cache
def program_version() -> str:
    """Return the version of Trunnion, with a checksum of its own files: two builds of one version are told apart."""
    found = hashlib.sha256()
    root = Path(__file__).parents[1]
    files = sorted((each.relative_to(root).as_posix(), each) for each in root.rglob("*") if _counts(each))
    for name, path in files:
        found.update(f"{name}\0{digest(path.read_bytes())}\n".encode())
    return f"{__version__}+{found.hexdigest()[:16]}"


def _counts(path: Path) -> bool:
    return path.is_file() and "__pycache__" not in path.parts


def home_of(path: Path) -> str:
    """Return what tells one batch from others that keep results in the same place: its file of jobs, or its folder."""
    return digest(os.fsencode(os.path.realpath(path)))[:16]


def key_of(program: str, said: Mapping[str, Any], digests: Mapping[str, str]) -> str:
    """Return the key of a result.

    program  version of Trunnion
    said     what is to be done, as JSON has it
    digests  logical names of all files that are read, and their checksums
    """
    text = json.dumps([program, said, digests], sort_keys=True, ensure_ascii=True, allow_nan=False)
    return digest(text.encode("ascii"))
