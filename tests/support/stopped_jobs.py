"""Jobs that are stopped at a file operation: by an exception, a signal, or the end of their process."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final, NoReturn

import pytest

from trunnion.errors import Problem
from trunnion.files import output_group, resolve_output, settle_dead_jobs

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="a process that is killed is a copy of this one")

#: What a job does to a disk.
OPERATIONS: Final = ("replace", "rename", "unlink", "link", "mkdir", "rmdir", "fsync")

OLD: Final = {
    "nc/one.mpf": b"old", "nc/SUB.SPF": b"old", "reports/one.html": b"old", "two/two.mpf": b"old"
}  # fmt: skip
NEW: Final = dict.fromkeys((*OLD, "nc/MORE.SPF"), b"new")


class Stop:
    """Stops at the n-th operation, before or after it is done."""

    def __init__(self, number: int, how: Callable[[], Any], *, after: bool) -> None:
        self._left, self._how, self._after = number, how, after

    @property
    def came(self) -> bool:
        return self._left <= 0

    def around(self, operation: Callable[..., Any]) -> Callable[..., Any]:
        def stopping(*given: Any, **named: Any) -> Any:
            self._left -= 1
            if self._left == 0 and not self._after:
                self._how()
            is_it = self._left == 0
            try:
                return operation(*given, **named)
            finally:
                if is_it and self._after:
                    self._how()

        return stopping

    @contextmanager
    def watching(self) -> Iterator[None]:
        with pytest.MonkeyPatch.context() as patch:
            for name in OPERATIONS:
                patch.setattr(os, name, self.around(getattr(os, name)))
            patch.setattr(Path, "write_text", self.around(Path.write_text))
            yield


def raise_ctrl_c() -> NoReturn:
    raise KeyboardInterrupt


def die() -> NoReturn:
    os._exit(9)


def write_job(folder: Path, text: bytes, *more: str, edited: str = "") -> None:
    """Write two programs in two folders, with subprograms, and a report in a third one; for a project."""
    report = resolve_output(folder / "reports" / "one.html")
    with output_group() as group:
        first = resolve_output(folder / "nc" / "one.mpf")
        with group.open(first, papers=[report], edited=edited) as files:
            files.main.write(text)
            for name in ("SUB.SPF", *more):
                files.add_file(name).write(text)
            files.add_paper(report).write(text)
        second = resolve_output(folder / "two" / "two.mpf")
        with group.open(second) as files:
            files.main.write(text)
        for place in (first, second):
            group.record_owner(place.path, ["project", text.decode()])
        group.record_names(folder.resolve() / "part.toml", [first.path, second.path])


def old_job(folder: Path) -> Path:
    for name in ("nc", "two", "reports"):
        (folder / name).mkdir(parents=True)
    write_job(folder, b"old")
    return folder


def left(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def settle(folder: Path) -> list[Problem]:
    return settle_dead_jobs(folder / name for name in ("reports", "two", "nc"))


def in_a_process_that_dies(work: Callable[[], Any], number: int, *, after: bool) -> bool:
    """Do some work in a copy of this process, which is killed at an operation; whether it came to that."""
    process = os.fork()
    if not process:
        with suppress(BaseException), Stop(number, die, after=after).watching():
            work()
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 9


def stopped_between_moves(folder: Path) -> None:
    """Leave a job that was killed when its first file was in its place."""
    assert _killed_at(folder, _number_between_moves())
    assert (folder / "nc" / "one.mpf").read_bytes() == b"old"


def _killed_at(folder: Path, number: int) -> bool:
    """Kill a job after an operation; whether its first file is in its place then."""
    in_a_process_that_dies(lambda: write_job(folder, b"new", "MORE.SPF"), number, after=True)
    return (folder / "nc" / "SUB.SPF").read_bytes() == b"new"


@cache
def _number_between_moves() -> int:
    """The operation that puts the first file of a job into its place: the same one each time."""
    with TemporaryDirectory() as place:
        return next(each for each in count(1) if _killed_at(old_job(Path(place, str(each))), each))
