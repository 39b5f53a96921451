"""Cures of messages about jobs that were stopped, about results that find no place, and where kernels are kept."""

import io
import logging
import os
import shutil
import tempfile
from collections.abc import Callable, Mapping
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, Final, NoReturn
from unittest.mock import patch

import pytest

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.stopped_jobs import NEW, OLD, left, old_job, settle, stopped_between_moves, write_job
from trunnion.cli.printing import print_result
from trunnion.errors import InputError, Problem
from trunnion.files.hidden_folders import hidden_folders_in
from trunnion.files.journal import read_journal
from trunnion.files.locks import LOCK
from trunnion.jit import store
from trunnion.messages import foreign


def _stopped(folder: Path, happens: Callable[[Path], object]) -> Path:
    """Leave a job that was killed between its files, and what happens to them afterwards."""
    if not hasattr(os, "fork"):
        pytest.skip("a process that is killed is a copy of this one")
    own = old_job(Path(tempfile.mkdtemp(dir=folder)))
    stopped_between_moves(own)
    happens(own)
    return own


def _settled(happens: Callable[[Path], object], end: Mapping[str, bytes] | None = None) -> Trial:
    """Return what settles a job that was killed, and finds these files then."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        own = _stopped(folder, happens)
        return Outcome(tuple(settle(own)), left(own) == end)

    return tried


def _posted_again(happens: Callable[[Path], object], *, by_hand: bool = False, edited: str = "") -> Trial:
    """Return what settles a job that was killed, and does it again; or removes its hidden folders first."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        own = _stopped(folder, happens)
        if by_hand:
            for hidden in _hidden(own):
                shutil.rmtree(hidden)
        else:
            settle(own)
        write_job(own, b"new", "MORE.SPF", edited=edited)
        return Outcome(tuple(settle(own)), left(own) == NEW)

    return tried


def _hidden(own: Path) -> list[Path]:
    return [hidden for folder in own.iterdir() for hidden in hidden_folders_in(folder)]


def _all_moved(own: Path) -> None:
    """All files are in their places; the job was killed before it could say so."""
    journal = next(found for hidden in _hidden(own) if (found := read_journal(hidden)))
    for move in journal.moves:
        if not move.is_done:
            move.new_file.replace(move.target)


def _not_begun(own: Path) -> None:
    """A job was killed before any of its files had a place."""
    settle(own)
    hidden = own / "nc" / ".one.mpf.0123456789ab"
    hidden.mkdir()
    (hidden / LOCK).touch()


def _edited(own: Path) -> None:
    (own / "nc" / "SUB.SPF").unlink()
    (own / "nc" / "SUB.SPF").write_bytes(b"by hand")


def _nothing(own: Path) -> None:
    pass


def _on_a_broken_disk(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Settle a job that was killed, on a disk that moves nothing."""

    def failing(*_: Any) -> NoReturn:
        raise OSError(5, "Input/output error")

    own = _stopped(folder, _nothing)
    with patch.object(os, "replace", failing):
        return Outcome(tuple(settle(own)), False)


class _Broken(io.RawIOBase):
    """What takes nothing."""

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> NoReturn:
        raise OSError(5, "Input/output error")


def _printed(*, breaks: bool) -> Trial:
    """Return what prints a result to a device that breaks, or elsewhere."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        raw: Any = _Broken() if breaks else io.BytesIO()
        stream = io.TextIOWrapper(raw, encoding="utf-8", write_through=True)
        with redirect_stdout(stream), redirect_stderr(io.StringIO()):
            try:
                print_result("passed")
            except InputError as error:
                return Outcome(error.problems, False)
        return Outcome((), raw.getvalue() == b"passed\n")

    return tried


class _Hears(logging.Handler):
    """What is logged."""

    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.said.append(record.getMessage())


def _kernels(*, named: bool) -> Trial:
    """Return what seeks a folder for kernels where no other can be written to than the one that is named, if any."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        real: Any = tempfile.TemporaryFile

        def refusing(**where: Path) -> Any:
            if folder not in where["dir"].parents:
                raise OSError(30, "Read-only file system")
            return real(**where)

        log, hears = logging.getLogger("trunnion.jit"), _Hears()
        log.addHandler(hears)
        try:
            with (
                patch.dict(os.environ, {"NUMBA_CACHE_DIR": str(folder) if named else ""}),
                patch.object(tempfile, "TemporaryFile", refusing),
            ):
                found = store.cache_folder.__wrapped__()
        finally:
            log.removeHandler(hears)
        problems = tuple(Problem("", 0, foreign(each, code="FIL310")) for each in hears.said if "FIL310" in each)
        return Outcome(problems, found is not None)

    return tried


CURES: Final = (
    Cure("FIL290", "finished", _settled(_all_moved, NEW), "", (), stays=True),
    Cure("FIL290", "removed", _settled(_not_begun, OLD), "", (), stays=True),
    Cure("FIL290", "rolled_back", _settled(_nothing), "", (), cured_by=_posted_again(_nothing)),
    Cure("FIL290", "changed_since", _settled(_edited), "", (), cured_by=_posted_again(_edited, edited="replace")),
    Cure(
        "FIL290",
        "changed_since",
        _settled(_edited, {**OLD, "nc/SUB.SPF": b"by hand"}),
        "",
        (),
        stays=True,
    ),
    Cure(
        "FIL290",
        "not_settled",
        _on_a_broken_disk,
        "",
        (),
        cured_by=_posted_again(_nothing, by_hand=True, edited="replace"),
    ),
    Cure("FIL230", "stdout_takes_no_more", _printed(breaks=True), "", (), cured_by=_printed(breaks=False)),
    Cure("FIL310", "", _kernels(named=False), "", (), cured_by=_kernels(named=True)),
)
