"""Which kind of tool library a file is, and its text, also out of an archive."""

import io
import zipfile
import zlib
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem, argument_problem, unusable_file
from trunnion.messages import Wording, phrase
from trunnion.simulation.tools.library.autodesk import read_autodesk
from trunnion.simulation.tools.library.freecad import read_freecad
from trunnion.simulation.tools.library.json_text import MAX_BYTES, parse_json
from trunnion.simulation.tools.library.library import ToolLibrary
from trunnion.simulation.tools.library.toml_library import read_toml_library
from trunnion.simulation.tools.library.tool_table import read_tool_table

#: How an archive begins, and an entry of its directory.
_ZIP, _ENTRY = b"PK\x03\x04", b"PK\x01\x02"

#: Most files in an archive; one has the tools.
_MAX_FILES: Final = 100

#: Longest tool table, bytes: LinuxCNC has a thousand tools at most.
_MAX_TABLE: Final = 1_000_000

_UNITS: Final = {"mm": 1.0, "inch": 25.4}

_WHAT: Final = phrase("file_of_tools")


def read_tools(path: str | Path, unit: str = "") -> ToolLibrary:
    """Read a tool library of any kind.

    path  the file. Its name tells TOML (``.toml``) and a tool table (``.tbl``), its content all others
    unit  ``mm`` or ``inch``: the unit of a tool table, which does not say it

    Raises ``InputError`` if it cannot be read; for TOML and tool tables, with every mistake in it and its line.
    """
    file = Path(path)
    if problem := unusable_file(file, _WHAT):
        raise InputError(problem)
    suffix = file.suffix.casefold()
    if suffix == ".toml":
        return read_toml_library(file)
    name = str(path)
    data = _read(file, _MAX_TABLE if suffix == ".tbl" else MAX_BYTES)
    if suffix == ".tbl":
        return read_tool_table(name, _text(data), _unit(unit))
    if data.startswith(_ZIP):
        data = _unpack(name, data)
    return _from_json(name, data)


def _read(file: Path, most: int) -> bytes:
    try:
        with file.open("rb") as stream:
            data = stream.read(most + 1)
    except OSError as error:
        raise InputError(
            Problem(str(file), 0, Wording("SIM170", "cannot_read", strerror=error.strerror or error))
        ) from None
    if len(data) > most:
        raise InputError(Problem(str(file), 0, Wording("SIM172", "more_bytes", most=most)))
    return data


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")  # comments in another code do not matter


def _unit(unit: str) -> float:
    if unit not in _UNITS:
        raise InputError(
            argument_problem(
                "unit", Wording("SIM175", "is", unit=unit) if unit else Wording("SIM175", "not_stated_tool")
            )
        )
    return _UNITS[unit]


def _from_json(name: str, data: bytes) -> ToolLibrary:
    if data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] != b"{":
        raise InputError(Problem(name, 0, Wording("SIM171", "no_tool_library")))
    root = parse_json(name, data)
    assert isinstance(root, dict)
    if "data" in root:
        return read_autodesk(name, root)
    if "parameter" in root and ("shape" in root or "shape-type" in root):
        return read_freecad(name, root)
    raise InputError(Problem(name, 0, Wording("SIM171", "json_but_neither")))


def _unpack(name: str, data: bytes) -> bytes:
    """Return the one JSON text of an archive."""
    if data.count(_ENTRY) > _MAX_FILES:
        raise InputError(Problem(name, 0, Wording("SIM172", "archive_more_files", max_files=_MAX_FILES)))
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            infos = archive.infolist()
            found = [info for info in infos if info.filename.casefold().endswith(".json")]
            if len(found) != 1:
                raise InputError(
                    Problem(name, 0, Wording("SIM170", "archive_file_them", count=len(infos), json_count=len(found)))
                )
            if found[0].flag_bits & 1 or found[0].compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise InputError(Problem(name, 0, Wording("SIM170", "archive_password_rare")))
            with archive.open(found[0]) as stream:
                text = stream.read(MAX_BYTES + 1)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, OSError, RuntimeError, ValueError) as error:
        raise InputError(Problem(name, 0, Wording("SIM170", "damaged_archive", error=error))) from None
    if len(text) > MAX_BYTES:
        raise InputError(Problem(name, 0, Wording("SIM172", "grows_more_mb", max_bytes=MAX_BYTES >> 20)))
    return text
