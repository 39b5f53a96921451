"""Work that is done again when one of the files that it reads changes.

A file that is being written is left alone until it rests: CAM systems write slowly, in pieces, or under another name
that becomes the file's at the end. What counts is what the files are like (time, size, identity); that something has
happened in their folders only wakes the watcher sooner, so that network drives, which tell nothing, work as well.
"""

import os
import threading
import time
import tomllib
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

from trunnion.definitions import MAX_FILE_BYTES
from trunnion.extras import import_extra

#: How long files must rest before they are read, s: CAM systems write in pieces that follow each other sooner.
_REST: Final = 1.0

#: How often files are looked at where nobody tells of changes, s.
_LOOK: Final = 2.0

#: Longer texts name no file.
_LONGEST_NAME: Final = 300

#: What files are like, by their names; None: there is no such file.
State: TypeAlias = Mapping[str, tuple[int, int, int] | None]


class Waiting(Protocol):
    """How time passes for a watcher."""

    def rest(self, seconds: float) -> None:
        """Return when the time is over."""

    def wait(self, files: Collection[str], seconds: float) -> None:
        """Return when the time is over, or sooner if something may have happened to one of the files."""


class Watched(Protocol):
    """Work that is done again."""

    def files(self) -> set[str]:
        """Return the files that it reads, as far as that is known: they need not be there."""

    def work(self, is_unchanged: Callable[[], bool]) -> None:
        """Do it once. Results that appear only if ``is_unchanged`` says so are those of files that have not changed."""


def watch(watched: Watched, waiting: Waiting) -> None:
    """Do the work, and again whenever its files have changed and rest; ends by ``KeyboardInterrupt`` only."""
    files, done = watched.files(), None
    while True:
        state = _state_at_rest(files, waiting)
        if state == done:
            waiting.wait(files, _LOOK)
            continue
        now = watched.files()
        if now != files:  # what a definition or a project names has changed: that must rest as well
            files = now
            continue
        watched.work(lambda files=files, state=state: state_of(files) == state)  # type: ignore[misc]
        done = state


def mentioned_files(definition: Path) -> set[str]:
    """Return what the texts of a definition may name; of one that cannot be used, files whose coming may put
    it right.
    """
    try:
        if not definition.is_file():  # a pipe would be waited for
            return set()
        with definition.open("rb") as stream:
            content = tomllib.loads(stream.read(MAX_FILE_BYTES).decode("utf-8-sig"))
    except (OSError, ValueError, RecursionError):
        return set()
    texts = (text for text in _texts(content) if text and len(text) < _LONGEST_NAME and text.isprintable())
    paths = [definition.parent / text for text in texts]
    return {str(path) for each in paths for path in (each, each.with_name(f"{each.name}.toml"))}


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _texts(each)


def state_of(files: Collection[str]) -> State:
    """Return what files are like now."""
    return {file: _state(file) for file in sorted(files)}


def _state(file: str) -> tuple[int, int, int] | None:
    with suppress(OSError, ValueError):
        found = Path(file).stat()
        return found.st_mtime_ns, found.st_size, found.st_ino
    return None


def _state_at_rest(files: Collection[str], waiting: Waiting) -> State:
    before = state_of(files)
    while True:
        waiting.rest(_REST)
        state = state_of(files)
        if state == before:
            return state
        before = state


class FolderNotices:
    """Passes time, and is woken by the system's notices of changes in the folders of the files."""

    def __init__(self) -> None:
        self._watchfiles: Any = import_extra("watchfiles", "watch")
        self._woken, self._stop = threading.Event(), threading.Event()
        self._folders: frozenset[str] = frozenset()

    def rest(self, seconds: float) -> None:
        """Return when the time is over."""
        time.sleep(seconds)

    def wait(self, files: Collection[str], seconds: float) -> None:
        """Return when the time is over, or sooner if something has happened in a folder of the files."""
        folders = frozenset(folder for folder in map(_folder, files) if os.path.isdir(folder))  # noqa: PTH112
        if folders != self._folders:
            self.close()
            self._folders, self._stop = folders, threading.Event()
            if folders:
                threading.Thread(target=self._follow, args=(folders, self._stop), daemon=True).start()
        self._woken.wait(seconds)
        self._woken.clear()

    def close(self) -> None:
        """Look at no folder any more."""
        self._stop.set()

    def _follow(self, folders: Collection[str], stop: threading.Event) -> None:
        with suppress(OSError, RuntimeError):  # without notices the files are looked at now and then
            notices = self._watchfiles.watch(
                *folders, recursive=False, watch_filter=None, stop_event=stop, raise_interrupt=False
            )  # fmt: skip
            for _ in notices:
                self._woken.set()


def _folder(file: str) -> str:
    return str(Path(file).absolute().parent)
