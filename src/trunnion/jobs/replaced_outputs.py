"""Files that an output would replace: only what an output of this kind has written, told by how it begins.

In:     what a command was given, and the kinds of its options.
Out:    nothing; or an ``InputError``, before any work.

Outputs that are programs, projects, recordings and summaries are told by their commands (``FileOut.told``).
"""

import os
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.files.places import file_identity
from trunnion.jobs.guard import files_read
from trunnion.jobs.job import Given
from trunnion.messages import Wording
from trunnion.options.kinds import FileOut
from trunnion.options.option import Option, outputs

#: How much of a file tells what it is, bytes.
_HEAD: Final = 1000

_SVG: Final = rb'<svg xmlns="http://www\.w3\.org/2000/svg" width="[\d.]+" height="[\d.]+" viewBox="[-\d. ]+">\n<style>'

#: How files of an ending begin as this version and earlier ones write them.
BEGINS: Final[Mapping[str, re.Pattern[bytes]]] = MappingProxyType(
    {
        ending: re.compile(pattern, re.DOTALL)
        for ending, pattern in {
            ".html": rb"<!DOCTYPE html>\s*<html lang=[^>]*>.{0,200}Content-Security-Policy.{11}default-src 'none';",
            ".json": rb'\s*(\{\s*"(schema": \d+(?!,\s*"made_by")|key": )|\[\s*\]|\[\s*\{\s*"(key|code|file)": )',
            ".svg": _SVG,
            ".xml": rb'.{0,900}sender="trunnion"',
            ".stl": rb"\0{80}",
            ".ply": rb"ply\nformat binary_little_endian 1\.0\nelement vertex \d+\nproperty float x\n",
            ".3mf": rb"PK\x03\x04.{26}(3D/3dmodel\.model|\[Content_Types\]\.xml)",
            ".glb": rb'glTF\x02\0\0\0.{8}JSON\{"asset":\{"version":"2\.0"\},"scene":0,',
            ".png": rb"\x89PNG\r\n\x1a\n",
            ".stp": rb"ISO-10303-21;.{0,900}[Tt]runnion",
        }.items()
    }
)

#: Outputs by name whose files begin otherwise than others of their ending.
BY_NAME: Final[Mapping[str, re.Pattern[bytes]]] = MappingProxyType(
    {
        "listing": re.compile(rb"[^\r\n]{0,12}LISTING OF [^\r\n]*\r?\n[^\r\n]{0,12}Machine: "),
        "manifest": re.compile(rb'\{\s*"schema": \d+,\s*"made_by": "'),
    }
)

#: What a page says of the command that has made it; those of earlier versions say nothing.
_MADE_BY: Final = re.compile(rb'.{0,300}<meta name="generator" content="trunnion (\w+)">', re.DOTALL)

#: Commands that write what is made for others.
_ALSO: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {"post": ("impeller", "place"), "simulate": ("impeller",)}
)

#: A key with the name of a program.
_PROGRAM: Final = rb'"program": "(?:[^"\\]|\\.)*",\s*'

#: How the data of a command's result begin behind their schema, and the commands that write such.
RESULTS: Final[Mapping[re.Pattern[bytes], tuple[str, ...]]] = MappingProxyType(
    {
        re.compile(rb'\s*\{\s*"schema": \d+,\s*' + pattern): commands
        for pattern, commands in {
            rb'"curves": ': ("curve",),
            rb'"dialect": ': ("info",),
            rb'"folder": ': ("survey",),
            rb'"machine": ("[^"]*"|null),\s*"files": ': ("place",),
            rb'"machine": ("[^"]*"|null),\s*"workpiece_zero_mm": ': ("reach",),
            rb'"machines": \[\s*(\]|\{\s*"machine": "[^"]*",\s*"status": )': ("fit",),
            rb'"passed": \w+,\s*"output": ': ("convert",),
            rb'"passed": \w+,\s*"programs": ': ("simulate", "impeller"),
            rb'"passed": \w+,\s*"proven": ': ("verify",),
            _PROGRAM + rb'"command": "post"': ("post", "impeller"),
            _PROGRAM + rb'"command": "verify"': ("verify",),
            _PROGRAM + rb'"machine": "': ("sensitivity",),
            _PROGRAM + rb'"machine": \{': ("post", "verify", "impeller"),
            _PROGRAM + rb'"title": ': ("post", "place", "impeller"),
            rb'"programs": \[\s*(\]|\{\s*"output": )': ("post", "impeller"),
            rb'"same": ': ("diff",),
        }.items()
    }
)


def check_replaced(given: Given) -> None:
    """Refuse an output that would replace what no output of its kind has written; an empty file is nobody's loss.

    Raises ``InputError`` with all of these.
    """
    named = [(each, given.values[each.name]) for each in outputs(given.job.options) if not told(each)]
    files = [(option, file) for option, file in named if isinstance(file, str) and file != "-"]
    others = [(option, file) for option, file in files if not _is_own(option, Path(file), given.job.name)]
    if not others:
        return
    # What is read as well is told as such, whoever has written it.
    read = {file_identity(file) for file in files_read(given)}
    problems = [
        Problem(file, 0, _refusal(option, Path(file), given.job.name))
        for option, file in others
        if file_identity(file) not in read
    ]
    if problems:
        raise InputError(problems)


def told(option: Option) -> bool:
    """Whether the command of an output finds out itself what it may replace."""
    return isinstance(option.kind, FileOut) and option.kind.told


def beginning(option: Option, ending: str) -> re.Pattern[bytes] | None:
    """Return how the files of an output begin whose names end so; None: nothing that exists is one of them."""
    return BY_NAME.get(option.name) or BEGINS.get({".step": ".stp"}.get(ending, ending))


def _is_own(option: Option, file: Path, command: str) -> bool:
    """Whether there is nothing to lose; what cannot be read or is no file is told where it is written."""
    head = _head(file)
    if not head:
        return True
    begins = beginning(option, file.suffix.lower())
    return begins is not None and begins.match(head) is not None and command in (writers(head) or (command,))


def _refusal(option: Option, file: Path, command: str) -> Wording:
    """Return why a file is not replaced: another command has written it, or none."""
    others = writers(_head(file))
    if others and command not in others:
        return Wording("FIL250", "of_another_command", commands=others)
    return Wording("FIL250", "no_such_output", flag=option.flag)


def writers(head: bytes) -> tuple[str, ...]:
    """Return the commands whose pages or data begin so; none where it is not known, as of lists."""
    if found := _MADE_BY.match(head):
        command = found[1].decode()
        return (command, *_ALSO.get(command, ()))
    return next((commands for begins, commands in RESULTS.items() if begins.match(head)), ())


def is_result_of(file: Path, command: str) -> bool:
    """Whether a file holds a page or data that a command has written, and no other."""
    return writers(_head(file)) == (command,)


def _head(file: Path) -> bytes:
    """Return how a file begins; nothing where it has nothing, cannot be read or is none."""
    try:
        if not file.is_file() or not os.access(file, os.R_OK):
            return b""
        with file.open("rb") as stream:
            return stream.read(_HEAD)
    except (OSError, ValueError):
        return b""
