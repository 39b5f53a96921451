"""Cures of messages about recordings of machines, lists of nodes, and users of a twin."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended, file_of, limited, whole
from trunnion.definitions import load_table
from trunnion.extras import import_extra
from trunnion.files.places import resolve_output
from trunnion.twin.opcua.users import Role, write_user
from trunnion.twin.ports import take_port
from trunnion.twin.recording import files, nodes, reading

_HEAD: Final = "source,received,mark,X,Y,Z,B,C\n"
_ROW: Final = "2026-05-04T08:30:00.020000Z,,,1,2,3,0,0\n"
_CSV: Final = _HEAD + _ROW
_NODES: Final = 'namespace = "urn:ours"\n[columns.X]\nid = "s=x"\n'
_USER: Final = "anna"


def _parquet(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a recording of one row as Parquet: NAME=KIND=VALUE for each column."""
    arrow, parquet = import_extra("pyarrow", "twin"), import_extra("pyarrow.parquet", "twin")
    columns: dict[str, Any] = {}
    for name, kind, value in (each.split("=") for each in text.split()):
        columns[name] = arrow.array([int(value) if value.isdigit() else value], arrow.type_for_alias(kind))
    parquet.write_table(arrow.table(columns), folder / "run.parquet")
    return ended(lambda: reading.read_recording(folder / "run.parquet"))


def _new(name: str, *there: str) -> Trial:
    """Return what asks whether a recording may be written into a file, where others are already."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        for each in there:
            (folder / each).write_text("", encoding="utf-8")
        return ended(lambda: files.check_is_new(resolve_output(folder / name)))

    return tried


def _added(name: str = _USER, password: str = "long enough", file: str = "users", mode: int = 0o600) -> Trial:
    """Return what adds a user to a file, in which the text is."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        place = folder / file
        (folder / "folder").mkdir(exist_ok=True)
        if place.parent == folder and not place.is_dir():
            place.write_bytes(text.encode("latin-1"))
            place.chmod(mode)
        return ended(lambda: write_user(place, name, Role.VIEWER, password))

    return tried


def _full(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Add a user to a file on a full disk."""
    with patch.object(os, "open", side_effect=OSError(28, "No space left on device")):
        return ended(lambda: write_user(folder / "users", _USER, Role.VIEWER, "long enough"))


def _listening(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Take a port for a moment, beside one that is taken."""
    with take_port("a twin", "127.0.0.1", 0, "port") as taken:
        port = int(settings["port"]) if settings["port"] != "taken" else taken.socket.getsockname()[1]
        return ended(lambda: take_port("a twin", "127.0.0.1", port, "port").socket.close())


_READ: Final = file_of("run.csv", reading.read_recording)
_NODE_LIST: Final = file_of(
    "nodes.toml", lambda file: nodes.read_nodes(load_table(file, file.parent, kind="list of nodes"))
)
_file: Final = whole("TWN320", _READ)
_cell: Final = whole("TWN321", _READ)
_column: Final = whole("TWN320", _parquet)
_node: Final = whole("TWN232", _NODE_LIST)
_GOOD: Final = "source=timestamp[us]=0 X=double=1"
_STAMP: Final = "2026-05-04T08:30:00.020000Z"


def _user(code: str, variant: str, bad: Trial, text: str = "") -> Cure:
    return Cure(code, variant, bad, text, (), cured_by=_added())


CURES: Final = (
    Cure("TWN320", "no_recording", file_of("run.txt", reading.read_recording), _CSV, (), cured_by=_READ),
    _file("empty", "", _CSV),
    _file("same_names", _HEAD.replace("Y", "x") + _ROW, _CSV),
    _file("no_source", _HEAD.replace("source", "time") + _ROW, _CSV),
    Cure(
        "TWN320",
        "too_many",
        limited(_READ, reading, "_MOST_COLUMNS", 8),
        _CSV.replace("\n", ",1\n"),
        ((_CSV.replace("\n", ",1\n"), _CSV),),
    ),
    Cure("TWN320", "more_rows", limited(_READ, reading, "_MOST_ROWS", 2), _HEAD + _ROW * 3, ((_ROW * 3, _ROW),)),
    Cure(
        "TWN320",
        "cannot_read",
        _READ,
        _CSV + '"' + "x" * 200_000 + '"\n',
        ((_CSV + '"' + "x" * 200_000 + '"\n', _CSV),),
    ),
    Cure(
        "TWN320",
        "no_parquet_file",
        file_of("run.parquet", reading.read_recording),
        "PAR0",
        ((("PAR0"), _GOOD),),
        cured_by=_parquet,
    ),
    _column("column_holds_no", "source=double=1 X=double=1", _GOOD),
    _column("column_holds_no_texts", f"{_GOOD} mark=double=1", f"{_GOOD} mark=string=gap"),
    _column("column_holds_no_numbers", "source=timestamp[us]=0 X=date32=1", _GOOD),
    Cure(
        "TWN320",
        "row_group_bytes",
        limited(_parquet, reading, "_MOST_BYTES", 300),
        f"{_GOOD} Y=double=1 Z=double=2 B=double=3",
        ((" Y=double=1 Z=double=2 B=double=3", ""),),
    ),
    Cure(
        "TWN320",
        "text_more_characters",
        limited(_parquet, reading, "LONGEST_TEXT", 9),
        f"{_GOOD} block=string=G1_X1000000",
        (("G1_X1000000", "G1_X1"),),
    ),
    _cell("cells_not", _CSV.replace(",0,0\n", ",0\n"), _CSV),
    _cell("no_time", _CSV.replace(_STAMP, "noon"), _CSV),
    _cell("no_number", _CSV.replace(",1,", ",one,"), _CSV.replace(",1,", ",,")),
    _cell("no_mark", _CSV.replace("Z,,,", "Z,,stop,"), _CSV),
    _node("empty", 'namespace = "urn:ours"\n[columns]\n', _NODES),
    _node("cannot_name_column", _NODES.replace("columns.X", 'columns."X-1"'), _NODES),
    _node("does_not_say", _NODES.replace('id = "s=x"\n', ""), _NODES),
    _node("given_beside", _NODES + 'path = "Axes/X"\n', _NODES),
    _node("no_namespace", _NODES.partition("\n")[2], _NODES),
    Cure(
        "TWN232",
        "columns",
        limited(_NODE_LIST, nodes, "_MOST_COLUMNS", 1),
        _NODES + '[columns.Y]\nid = "s=y"\n',
        (('[columns.Y]\nid = "s=y"\n', ""),),
    ),
    Cure("TWN310", "exists_recording_never", _new("run.csv", "run.csv"), "", (), cured_by=_new("other.csv", "run.csv")),
    _user("TWN130", "no_name_user", _added("anna karla")),
    _user("TWN130", "password_too_short", _added(password="short")),
    _user("TWN130", "password_no_text", _added(password="long enough \udc80")),
    _user("TWN131", "no_file_users", _added(file="folder")),
    _user("TWN131", "cannot_written", _full),
    _user("TWN131", "everybody_can_write", _added(mode=0o666)),
    Cure("TWN131", "file_users_cannot", _added(), "\xff", (), cured_by=_added(file="folder/others")),
    Cure("TWN131", "no_user_line", _added(), "anna\n", (("anna\n", ""),)),
    Cure("TWN150", "no_port", _listening, "", ({"port": "0"},), {"port": "70000"}),
    Cure("TWN150", "cannot_served_port", _listening, "", ({"port": "0"},), {"port": "taken"}),
)
