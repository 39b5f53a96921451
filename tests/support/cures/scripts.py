"""What tries a cure by commands: a script of a few lines, each run in this process, in a folder of its own.

A line is a command of Trunnion, which may end in ``< FILE`` for its stdin; an expression of Python; or one of the
words of ``_WORDS``, which change files. The
files of ``FILES`` that a script names are there before it begins. ``set`` and ``fails`` change the computer until the
script ends: a smaller limit, a function in place of another one, an operation that the system refuses.
"""

import errno
import io
import os
import re
import shlex
import shutil
import socket
import sys
import tarfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, chdir, redirect_stderr, redirect_stdout
from contextvars import copy_context
from pathlib import Path
from pkgutil import resolve_name
from tempfile import mkdtemp
from typing import Any, Final, Self
from unittest.mock import patch
from warnings import catch_warnings, simplefilter
from zipfile import ZipFile

import numpy as np
import pytest

import trunnion
from tests.support.cures.cure import Cure, Outcome
from tests.support.posting import FOOT, HEAD
from tests.support.program_heads import HEADS
from trunnion.cli import main
from trunnion.errors import Problem, TrunnionError
from trunnion.messages import Wording
from trunnion.simulation.meshes import box_mesh, save_mesh

_PROJECT: Final = 'machine = "yl569"\ncl = ["part.cls"]\noutput = "out.mpf"\n'

#: What scripts may name without writing it first.
FILES: Final[Mapping[str, str]] = {
    "part.cls": HEAD + FOOT,
    "two.cls": HEAD.replace("OP1", "OP2") + FOOT,
    "stop.cls": HEAD + "STOP/turn the part\nGOTO/20,0,5\n" + FOOT,
    "part.mpf": HEADS["yl569"].format(lines="G1 X10 F100"),
    "part.nc": HEADS["matsuura_mx330"].format(lines="G1 X10. F100."),
    "ours.toml": 'schema = 1\nextends = "yl569"\nname = "Ours"\n',
    "project.toml": _PROJECT,
}


class _Here:
    """Workers of a batch that are no processes."""

    def __init__(self, count: int, function: Callable[[Any], Any], timeout: float | None) -> None:
        self._work = function

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def run(self, tasks: Iterable[tuple[Any, Any] | None]) -> Iterator[tuple[Any, Any]]:
        """Do one after another."""
        for place, task in filter(None, tasks):
            yield place, self._work(task)


def _append(name: str, text: str) -> None:
    with Path(name).open("a", encoding="utf-8") as file:
        file.write(text.replace("\\n", "\n"))


def _write(name: str, text: str) -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text(text.replace("\\n", "\n"), encoding="utf-8")


def _latin(name: str, text: str) -> None:
    with Path(name).open("a", encoding="latin-1") as file:
        file.write(text)


def _edit(name: str, pattern: str, new: str) -> None:
    text = Path(name).read_text(encoding="utf-8")
    Path(name).write_text(re.sub(pattern, new, text, count=1, flags=re.DOTALL), encoding="utf-8")


def _zip(name: str, *files: str) -> None:
    with ZipFile(name, "w") as archive, catch_warnings():
        simplefilter("ignore")  # two files of one name
        for file in files:
            archive.write(file)


def _listed(name: str, place: str, value: str) -> None:
    """Change a byte in the entry of the last file in the list of a ZIP archive."""
    content = bytearray(Path(name).read_bytes())
    content[content.rindex(b"PK\x01\x02") + int(place)] = int(value)
    Path(name).write_bytes(content)


def _fifo(name: str) -> None:
    if not hasattr(os, "mkfifo"):
        pytest.skip("no pipe has a name on this system")
    os.mkfifo(name)


def _socket(name: str) -> None:
    if not hasattr(socket, "AF_UNIX"):
        pytest.skip("no socket has a name on this system")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind(name)


def _tar(name: str, *files: str) -> None:
    with tarfile.open(name, "w") as archive:
        for file in files:
            archive.add(file)


def _box(name: str, low: str, high: str) -> None:
    """Write the mesh of a box between two corners."""
    ends = [[float(each) for each in corner.split(",")] for corner in (low, high)]
    save_mesh(box_mesh(np.array(ends[0]), np.array(ends[1])), name)


#: Words of scripts, which change files as those of a shell do.
_WORDS: Final[Mapping[str, Callable[..., object]]] = {
    "append": _append,
    "box": _box,
    "latin": _latin,
    "edit": _edit,
    "zip": _zip,
    "listed": _listed,
    "socket": _socket,
    "tar": _tar,
    "write": _write,
    "mkdir": lambda name: Path(name).mkdir(parents=True),
    "rm": lambda name: shutil.rmtree(name) if Path(name).is_dir() else Path(name).unlink(),
    "mv": lambda old, new: Path(old).rename(new),
    "cp": lambda old, new: shutil.copy(old, new),
    "link": lambda old, new: Path(new).symlink_to(old),
    "fifo": _fifo,
}


def _set(target: str, value: str) -> Any:
    """What gives a name in a module the value of an expression."""
    return patch(target, eval(value, _KNOWN))


def _fails(target: str, number: str, *parts: str) -> Any:
    """What has a function raise an error of the system; only for paths with a part, where some are given."""
    code, real = int(getattr(errno, number)), resolve_name(target)

    def failing(*given: Any, **named: Any) -> Any:
        if not parts or any(part in str(each) for part in parts for each in given):
            raise OSError(code, os.strerror(code))
        return real(*given, **named)

    return patch(target, failing)


#: Words of scripts that change the computer, until the script ends.
_TROUBLES: Final[Mapping[str, Callable[..., Any]]] = {"set": _set, "fails": _fails}
#: What expressions may name.
_KNOWN: Final[dict[str, Any]] = {"trunnion": trunnion, "Path": Path, "io": io, "resolve_name": resolve_name}


def run(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Run a script; it is sound if its last command is."""
    problems: list[Problem] = []
    is_sound = True
    with (
        chdir(mkdtemp(dir=folder)),
        patch("trunnion.batch.running.LocalWorkers", _Here),
        ExitStack() as troubles,
    ):
        for name, content in FILES.items():
            if name in text or (name == "part.cls" and "project.toml" in text):
                _write(name, content)
        for line in text.splitlines():
            word, *words = shlex.split(line) if not line.startswith("trunnion.") else [line]
            if word == "trunnion":
                is_sound = _command(words, problems)
            elif word in _WORDS:
                _WORDS[word](*words)
            elif word in _TROUBLES:
                troubles.enter_context(_TROUBLES[word](*words))
            else:
                is_sound = _call(line, problems)
    return Outcome(tuple(problems), is_sound)


def _call(expression: str, problems: list[Problem]) -> bool:
    try:
        eval(expression, _KNOWN)
    except TrunnionError as error:
        problems += error.problems
        return False
    return True


def _command(words: list[str], problems: list[Problem]) -> bool:
    """Run a command, and note every message that it prints; return whether it ends well."""
    words, stdin = (words[:-2], Path(words[-1]).read_bytes()) if "<" in words else (words, b"")
    found: list[tuple[Wording, str]] = []
    text_of = Wording.text

    def noted(self: Wording, part: Any, *others: Any) -> str:
        text = text_of(self, part, *others)
        found.append((self, text))
        return text

    streams = [io.TextIOWrapper(io.BytesIO(content), encoding="utf-8") for content in (stdin, b"", b"")]
    with (
        patch.object(Wording, "text", noted), patch.object(sys, "stdin", streams[0]),
        redirect_stdout(streams[1]), redirect_stderr(streams[2]),
    ):  # fmt: skip
        code = copy_context().run(_ended, words)
    for stream in streams[1:]:
        stream.flush()
    printed = _plain(b"".join(stream.buffer.getvalue() for stream in streams[1:]).decode())
    wordings = dict.fromkeys(wording for wording, text in found if text and _plain(text) in printed)
    problems += [Problem("", 0, wording) for wording in wordings]
    if code:
        problems.append(Problem("", 0, Wording("", "", what=printed, cure="")))
    return code == 0


def _ended(words: list[str]) -> int:
    try:
        return main(words)
    except SystemExit as ended:
        return int(ended.code or 0)


def _plain(text: str) -> str:
    return "".join(text.split())


def looked_at(message: str, text: str) -> Cure:
    """A script that draws a message whose cure has nothing changed."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, run, text, (), stays=True)


def script(message: str, text: str, old: str, new: str, *, refuses: bool = False) -> Cure:
    """A script that draws a message, as ``ARG120 either``, and what its cure puts in place of a part of it."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, run, text, ((old, new),), refuses=refuses)
