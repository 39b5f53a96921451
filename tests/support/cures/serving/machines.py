"""Cures of messages about machines that are listened to: their servers, users, certificates and files."""

import asyncio
import csv
import hashlib
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final
from unittest.mock import patch

import pytest
from asyncua import ua
from asyncua.client.ua_client import UaClientState
from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from tests.support.simulating import HEAD, SLOT
from trunnion.errors import Problem
from trunnion.extras import import_extra
from trunnion.files.places import resolve_output
from trunnion.jobs.observer import Observer
from trunnion.jobs.twin import serving as twins
from trunnion.jobs.twin.recording import machine_feed
from trunnion.jobs.twin.serving import twin_program
from trunnion.jobs.view.live import LiveMachine
from trunnion.timing import timed_run
from trunnion.twin.opcua.certificates import client_certificate, server_certificate
from trunnion.twin.opcua.users import Role, write_user
from trunnion.twin.recording import client as recording_client
from trunnion.twin.recording import feed as recording_feed
from trunnion.twin.recording import files, reading
from trunnion.twin.recording.rows import Row

_ADDRESS: Final = "opc.tcp://mill:4840"
_HEAD: Final = 'namespace = "urn:mill"\n[columns]\n'
_NODES: Final = _HEAD + 'X = { id = "s=x" }\n'
_AXES: Final = _HEAD + "".join(f'{name.upper()} = {{ id = "s={name}" }}\n' for name in "xyzac")


class _Node:
    """A variable of the server."""

    def __init__(self, client: "_Client", name: Any) -> None:
        self.nodeid, self._client = name, client

    async def read_node_class(self) -> None:
        if self.nodeid.Identifier not in self._client.variables:
            raise ua.UaStatusCodeError(ua.StatusCodes.BadNodeIdUnknown)

    async def read_value(self) -> str:
        return "X"


class _Client:
    """The connection to a server whose variables anybody may read; it takes part in no network."""

    certificates: tuple[bytes, ...] = ()
    variables = "xyzac"
    answer = ua.StatusCodes.Good
    is_there = True
    breaks_at = 0
    made = 0

    def __init__(self, address: str, **_: Any) -> None:
        self.uaclient = SimpleNamespace(session=self)
        type(self).made += 1
        breaks = self.made == self.breaks_at
        self.state = UaClientState.DISCONNECTED if breaks else UaClientState.CONNECTED

    async def connect(self) -> None:
        if not self.is_there:
            raise OSError(111, "Connection refused")

    async def connect_and_get_server_endpoints(self) -> list[Any]:
        mode, uri = ua.MessageSecurityMode.SignAndEncrypt, SecurityPolicyBasic256Sha256.URI
        return [
            SimpleNamespace(SecurityMode=mode, SecurityPolicyUri=uri, ServerCertificate=each)
            for each in self.certificates
        ]

    async def set_security(self, *_: Any, **__: Any) -> None:
        """The channel is encrypted from here on."""

    async def get_namespace_array(self) -> list[str]:
        return ["http://opcfoundation.org/UA/", "urn:mill"]

    def get_node(self, name: Any) -> _Node:
        return _Node(self, name)

    async def create_subscription(self, *_: Any) -> Any:
        return SimpleNamespace(SubscriptionId=1)

    async def create_monitored_items(self, request: Any) -> list[Any]:
        return [SimpleNamespace(StatusCode=ua.StatusCode(self.answer)) for _ in request.ItemsToCreate]

    async def disconnect(self) -> None:
        """It ends."""


class _Encrypting(_Client):
    certificates = (b"certificate of the mill",)


class _Refusing(_Client):
    answer = ua.StatusCodes.BadUserAccessDenied


class _Gone(_Client):
    is_there = False


class _Breaking(_Client):
    breaks_at = 1


_TRUSTED: Final = hashlib.sha1(b"certificate of the mill", usedforsecurity=False).hexdigest()


@contextmanager
def _network(client: type[_Client], folder: Path) -> Iterator[None]:
    client.made = 0
    with (
        patch.object(recording_client, "Client", client),
        patch.object(recording_feed, "_PATIENCE", 0.01),
        patch.dict(os.environ, {"XDG_DATA_HOME": str(folder)}),
    ):
        yield


def _feed(nodes: str, folder: Path, **given: Any) -> Any:
    (folder / "nodes.toml").write_text(nodes, encoding="utf-8")
    return machine_feed("opc.tcp://mill:4840", nodes=folder / "nodes.toml", **given)


def _connected(client: type[_Client] = _Client, nodes: str = _NODES, **given: Any) -> Trial:
    """Return what connects to a machine with a list of nodes."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        async def connect() -> None:
            feed = _feed(nodes, folder, **given)
            await feed.open()
            await feed.close()

        with _network(client, folder):
            return ended(lambda: asyncio.run(connect()))

    return tried


def _broken(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Listen to a machine whose connection breaks once."""
    heard = list[Problem]()

    async def listen() -> None:
        feed = _feed(_NODES, folder, observer=_Told(heard))
        await feed.open()
        async for _ in feed.rows():
            if len(heard) > 1:
                break
        await feed.close()

    with _network(_Breaking, folder):
        return ended(lambda: asyncio.run(listen()), heard)


def _live(nodes: str) -> Trial:
    """Return what looks whether a machine shows all axes."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with _network(_Client, folder):
            return ended(LiveMachine(lambda: _feed(nodes, folder), "xyzac_trt").check)

    return tried


class _Told(Observer):
    def __init__(self, heard: list[Problem]) -> None:
        self._heard = heard

    def problems(self, problems: Sequence[Problem]) -> None:
        self._heard += problems


def _homeless(**given: Any) -> Trial:
    """Return what asks for a machine for a user without a home, or with one."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        home = {"HOME": str(folder)} if settings else {}
        with patch.dict(os.environ, home, clear=True), patch.object(Path, "home", _home):
            return ended(lambda: machine_feed(_ADDRESS, **given))

    return tried


def _home() -> Path:
    if "HOME" not in os.environ:
        raise RuntimeError("Could not determine home directory.")
    return Path(os.environ["HOME"])


def _asked(**given: Any) -> Trial:
    """Return what asks for a machine as arguments say; it is not sought yet."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.dict(os.environ, {"XDG_DATA_HOME": str(folder)}):
            return ended(lambda: machine_feed(_ADDRESS, **given))

    return tried


def _secured(*users: str) -> Trial:
    """Return what reads the users of a twin that other computers may reach."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "users").write_text("", encoding="utf-8")
        (folder / "users").chmod(0o600)
        for name in users:
            write_user(folder / "users", name, Role.VIEWER, "long enough")
        with patch.dict(os.environ, {"XDG_DATA_HOME": str(folder)}):
            return ended(lambda: twins._security(folder / "users"))

    return tried


def _certified(make: Callable[[Path], object], *, may_write: bool) -> Trial:
    """Return what makes a certificate in a folder that may not be written."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        if may_write:
            return ended(lambda: make(folder / "own"))
        with patch.object(Path, "mkdir", side_effect=PermissionError(13, "Permission denied")):
            return ended(lambda: make(folder / "own"))

    return tried


def _recorded(name: str, *, full: bool) -> Trial:
    """Return what records two rows; the disk may be full when the second one comes."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        place = resolve_output(folder / name)

        def record() -> None:
            writer = files.RecordingWriter(place, ["X"], frozenset())
            writer.add([Row([1.0], 0, 0, 0)])
            if full:
                writer._sink = _Full(writer._sink)  # type: ignore[assignment]
                writer._writer = csv.writer(writer._sink, lineterminator="\n")
            writer.add([Row([2.0], 10, 10, 10)])
            writer.close()

        return ended(record)

    return tried


class _Full:
    """A file on a disk that is full."""

    def __init__(self, sink: Any) -> None:
        self._sink = sink

    def write(self, text: str) -> int:
        raise OSError(28, "No space left on device")


def _new(name: str, *there: str) -> Trial:
    """Return what asks whether a recording may be written into a file, where others or pipes are already."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        for each in there:
            (folder / each).touch()
        if name == "pipe" and sys.platform == "win32":
            pytest.skip("no pipe has a name on this system")
        if name == "pipe":
            os.mkfifo(folder / name)
        return ended(lambda: files.check_is_new(resolve_output(folder / name)))

    return tried


def _repeated(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a recording as Parquet, in which one row stands so many times as the text says."""
    arrow, parquet = import_extra("pyarrow", "twin"), import_extra("pyarrow.parquet", "twin")
    table = {"source": arrow.array([0] * int(text), arrow.timestamp("us")), "X": arrow.array([1.0] * int(text))}
    parquet.write_table(arrow.table(table), folder / "run.parquet")
    with patch.object(reading, "_MOST_BYTES", 5_000):
        return ended(lambda: reading.read_recording(folder / "run.parquet"))


def _compared(*, doubled: bool) -> Trial:
    """Return what compares a program with a recording, to which a script has added a column of an axis that it has."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.ngc").write_text(HEAD + "M5\nM30\n", encoding="utf-8")
        (folder / "run.csv").write_text(text, encoding="utf-8")
        found = reading.read_recording(folder / "run.csv")
        if doubled:
            found = replace(found, values={**found.values, "x": found.values["X"]})
        return ended(lambda: trunnion.verify(folder / "part.ngc", machine="xyzac_trt", recorded=found))

    return tried


def _run(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have a program run as a twin, of which few pieces are kept."""
    (folder / "part.ngc").write_text(text, encoding="utf-8")
    with patch.object(timed_run, "MOST_PIECES", 6):
        return ended(lambda: twin_program(folder / "part.ngc", machine="xyzac_trt", tools=["1=flat:10,length=60"]))


_CSV: Final = "source,X,Y,Z,A,C\n2026-05-04T08:30:00.020000Z,-20,0,20,0,0\n"
_TWICE: Final = f'{_HEAD}X = {{ id = "s=x", name_id = "s=a" }}\nY = {{ id = "s=y", name_id = "s=c" }}\n'
_LONG: Final = SLOT.replace("M5\n", "G1 X60\nG1 X50\nG1 X40\nG1 X30\nG1 X20\nM5\n")


def _server(folder: Path) -> object:
    return server_certificate(folder, "urn:ours", "127.0.0.1")


_TRUSTING: Final = _connected(_Encrypting, secure=True, trust=_TRUSTED)

CURES: Final = (
    Cure("TWN220", "cannot_connected", _connected(_Gone), "", (), cured_by=_connected()),
    Cure("TWN221", "offers_no_channel", _connected(secure=True, trust=_TRUSTED), "", (), cured_by=_TRUSTING),
    Cure(
        "TWN222",
        "certificate_fingerprint_not",
        _connected(_Encrypting, secure=True, trust="00"),
        "",
        (),
        cured_by=_TRUSTING,
    ),
    Cure("TWN230", "not_there", _connected(nodes=_NODES.replace("s=x", "s=w")), "", (), cured_by=_connected()),
    Cure("TWN230", "cannot_subscribed", _connected(_Refusing), "", (), cured_by=_connected()),
    Cure(
        "TWN231",
        "none_variables",
        _connected(nodes=_NODES.replace('s=x"', 's=w", optional = true')),
        "",
        (),
        cured_by=_connected(),
    ),
    Cure("TWN231", "two_columns_name", _connected(nodes=_TWICE), "", (), cured_by=_connected()),
    Cure("TWN231", "axes_not_shown", _live(_NODES), "", (), cured_by=_live(_AXES)),
    Cure("TWN240", "", _broken, "", (), stays=True),
    Cure("TWN120", "no_folder_for_certificates", _homeless(secure=True), "", (), cured_by=_homeless()),
    Cure("TWN210", "user_without_encryption", _asked(user="anna"), "", (), cured_by=_asked(user="anna", secure=True)),
    Cure("TWN132", "no_user", _secured(), "", (), cured_by=_secured("anna")),
    Cure(
        "TWN140",
        "certificate_client_cannot",
        _certified(client_certificate, may_write=False),
        "",
        (),
        cured_by=_certified(client_certificate, may_write=True),
    ),
    Cure(
        "TWN140",
        "certificate_server_cannot",
        _certified(_server, may_write=False),
        "",
        (),
        cured_by=_certified(_server, may_write=True),
    ),
    Cure(
        "TWN310",
        "exists_recording_never_written",
        _new("run.parquet", "run.parquet.csv"),
        "",
        (),
        cured_by=_new("other.parquet", "run.parquet.csv"),
    ),
    Cure("TWN310", "no_file_recording", _new("pipe"), "", (), cured_by=_new("run.csv")),
    Cure("TWN311", "cannot_written", _recorded("run.csv", full=True), "", (), cured_by=_recorded("b.csv", full=False)),
    Cure("TWN320", "holds_more_bytes", _repeated, "1000", (("1000", "100"),)),
    Cure("TWN321", "two_columns_axis", _compared(doubled=True), _CSV, (), cured_by=_compared(doubled=False)),
    Cure("TWN112", "where_program_makes", _run, _LONG, ((_LONG, SLOT),)),
)
