"""What a disk may hold after a power failure: what was brought to it, and any part of what was not.

In:     a folder, and a job that is done in a copy of this process.
Out:    the states in which the folder may be found. A name is on the disk for sure once its folder was synced, and
        what a file holds once the file was; names that were not may be there all the same, in any order.
"""

import os
import pickle
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import pytest

#: What changes names, and how many paths it takes.
_NAMING: Final = {"replace": 2, "rename": 2, "link": 2, "unlink": 1, "mkdir": 1, "rmdir": 1}

#: A folder, in place of what a file holds.
FOLDER: Final = None


@dataclass(slots=True)
class Held:
    """A file: what of it is on the disk, and how often it was written and not brought there."""

    on_disk: bytes | None = b""


@dataclass(frozen=True, slots=True)
class Operation:
    """A change of names: ``make``, ``move``, ``link`` or ``remove``; and the file that it is about."""

    kind: str
    path: str
    target: str = ""
    held: Held | None = None

    @property
    def folders(self) -> set[str]:
        """The folders that it changes."""
        return {str(Path(each).parent) for each in (self.path if self.kind != "link" else "", self.target) if each}


@dataclass(slots=True)
class Disk:
    """What was done to a folder: names on the disk, operations that may be lost, and names as they are now."""

    root: Path
    safe: dict[str, Held | None] = field(default_factory=dict)
    pending: list[Operation] = field(default_factory=list)
    now: dict[str, Held | None] = field(default_factory=dict)

    def do(self, operation: Operation) -> None:
        """Take an operation that may be lost."""
        _apply(self.now, operation)
        self.pending.append(operation)

    def sync(self, path: str) -> None:
        """Bring what a file holds to the disk, or the names in a folder."""
        if Path(path).is_dir():
            for each in [each for each in self.pending if path in each.folders]:
                _apply(self.safe, each)
                self.pending.remove(each)
        elif (held := self.now.get(path)) is not None:
            held.on_disk = Path(path).read_bytes()

    def states(self) -> Iterator[dict[str, bytes | None]]:
        """Yield what may be found: nothing of the rest, all of it, and one alone or all but one."""
        rest = self.pending
        for chosen in ([], rest, *([each] for each in rest), *([o for o in rest if o is not each] for each in rest)):
            names = dict(self.safe)
            for each in chosen:
                _apply(names, each)
            yield {
                path: None if held is None else held.on_disk
                for path, held in names.items()
                if all(str(folder) in names for folder in Path(path).parents if folder.is_relative_to(self.root))
            }


def _apply(names: dict[str, Held | None], operation: Operation) -> None:
    """Change names, also in a folder whose own name is not on the disk yet."""
    if operation.kind in ("move", "remove"):
        names.pop(operation.path, None)
    if operation.kind != "remove":
        names[operation.target or operation.path] = operation.held


def states_of(folder: Path, job: Callable[[], Any], *, most: int = 100_000) -> list[dict[str, bytes | None]]:
    """Return all states in which a folder may be found after a power failure in the midst of a job, each once."""
    read, write = os.pipe()
    process = os.fork()
    if not process:
        os.close(read)
        with os.fdopen(write, "wb") as sink, suppress(BaseException):
            pickle.dump(_watched(folder, job, most), sink)
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as source:
        found: list[dict[str, bytes | None]] = pickle.load(source)
    os.waitpid(process, 0)
    return found


def _watched(folder: Path, job: Callable[[], Any], most: int) -> list[dict[str, bytes | None]]:
    root = folder.resolve()
    disk = Disk(root)
    for path in (root, *sorted(root.rglob("*"))):
        disk.safe[str(path)] = FOLDER if path.is_dir() else Held(path.read_bytes())
    disk.now = dict(disk.safe)
    found: dict[Any, dict[str, bytes | None]] = {}

    def keep() -> None:
        for state in disk.states():
            if len(found) < most:
                found.setdefault(tuple(sorted((name, held) for name, held in state.items())), state)

    def is_own(path: str) -> bool:
        return path.startswith(str(root))

    def see_files() -> None:
        """Find the files that were made since: opening one makes a name."""
        for path in root.rglob("*"):
            if str(path) not in disk.now and not path.is_dir():
                disk.do(Operation("make", str(path), held=Held()))

    def around(name: str, operation: Callable[..., Any]) -> Callable[..., Any]:
        def watched(*given: Any, **named: Any) -> Any:
            see_files()
            paths = [str(Path.cwd() / each) for each in given[: _NAMING[name]] if not isinstance(each, int)]
            result = operation(*given, **named)
            if paths and is_own(paths[-1]) and "dir_fd" not in named:
                first, target = paths[0], paths[1] if len(paths) > 1 else ""
                kind = {"link": "link", "mkdir": "make"}.get(name, "move" if target else "remove")
                disk.do(Operation(kind, first, target, None if name == "mkdir" else disk.now.get(first)))
            else:
                for gone in [path for path in disk.now if not os.path.lexists(path)]:
                    disk.do(Operation("remove", gone))
            keep()
            return result

        return watched

    def sync(descriptor: int) -> None:
        see_files()
        path = str(Path(f"/proc/self/fd/{descriptor}").readlink())
        if is_own(path):
            disk.sync(path)
            keep()

    with pytest.MonkeyPatch.context() as patch:
        for name in _NAMING:
            patch.setattr(os, name, around(name, getattr(os, name)))
        patch.setattr(os, "fsync", sync)
        job()
    see_files()
    keep()
    return list(found.values())


def lay_out(state: dict[str, bytes | None], root: Path, place: Path) -> Path:
    """Make the files of a state in another folder, and return it."""
    for path, content in sorted(state.items()):
        target = place / Path(path).relative_to(root.resolve())
        if content is None:
            target.mkdir(parents=True, exist_ok=True)
        else:
            target.write_bytes(content)
    return place
