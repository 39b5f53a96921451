"""Digests of files: a file is read once as long as it stays as it is."""

import hashlib
import os
from pathlib import Path
from typing import Any

import pytest

from trunnion.files.digests import FileDigests, digest_of


def test_a_file_that_stays_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "part.mpf"
    file.write_bytes(b"G0 X1")
    read, own = list[str](), hashlib.file_digest

    def counted(stream: Any, name: str) -> Any:
        read.append(name)
        return own(stream, name)

    monkeypatch.setattr(hashlib, "file_digest", counted)
    digests, others = FileDigests(), FileDigests()
    first = digests.of(file)
    others.take(digests)
    assert first == hashlib.sha256(b"G0 X1").hexdigest() == digests.of(file) == others.of(file)
    assert len(read) == 1


def test_a_file_that_was_written_since_is_read_anew(tmp_path: Path) -> None:
    file, digests = tmp_path / "part.mpf", FileDigests()
    file.write_bytes(b"G0 X1")
    digests.of(file)
    file.write_bytes(b"G0 X2")
    os.utime(file, ns=(1, 1))
    assert digests.of(file) == hashlib.sha256(b"G0 X2").hexdigest()
    other = tmp_path / "other.mpf"
    other.write_bytes(b"G0 X3")
    os.utime(other, ns=(1, 1))
    other.replace(file)
    assert digests.of(file) == hashlib.sha256(b"G0 X3").hexdigest()


def test_a_file_that_is_not_there_has_no_digest(tmp_path: Path) -> None:
    assert digest_of(tmp_path / "none.mpf") is None
    assert digest_of(tmp_path) == ""
