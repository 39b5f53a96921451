"""Recordings of machines: made by an OPC UA client, and read."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack
from urllib.parse import urlsplit

from trunnion.errors import InputError, Problem, argument_problem
from trunnion.extras import import_extra
from trunnion.jobs.arguments import LiveArguments, taken
from trunnion.jobs.inputs.arguments import check_observer, check_path, wrong_argument
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.result_output import declared_output
from trunnion.messages import Wording, phrase
from trunnion.model.recording import Recording
from trunnion.options.limits import LONGEST_RATE, SHORTEST_RATE
from trunnion.twin.recording.files import check_is_new
from trunnion.twin.recording.nodes import load_nodes
from trunnion.twin.recording.reading import read_recording as read_file
from trunnion.user_cache import user_data

if TYPE_CHECKING:
    from trunnion.twin.recording.feed import MachineFeed
    from trunnion.twin.recording.recorder import RecordingSummary


def _ignore(_names: tuple[str, ...]) -> None:
    """Nobody asked what is recorded."""


class RecordArguments(LiveArguments, total=False):
    """Arguments of ``record``."""

    seconds: float | None
    ready: Callable[[tuple[str, ...]], None] | None


def record(
    address: str, *, output: FilePath, observer: Observer = SILENT, **given: Unpack[RecordArguments]
) -> "RecordingSummary":
    """Record what a machine, or a twin, shows by OPC UA, until the time is over or Ctrl-C.

    address         of its server, ``opc.tcp://HOST:PORT/…``
    output          the file, ``.csv`` or ``.parquet``. One that exists is never written over
    nodes           what is recorded: ``"cnc"``, ``"twin"``, ``"sinumerik"``, ``"heidenhain"``, or a file (.toml)
    seconds         how long; None: until Ctrl-C
    rate            milliseconds between two looks of the server at its variables, 5 to 60000
    secure          sign and encrypt; the certificate of the client is made on first use
    trust           fingerprint (SHA-1) of the server's certificate; needed with ``secure``
    user, password  empty: anonymous. A password is sent on a secure channel alone
    ready           is called with the names of the columns when recording begins
    observer        is told when the connection breaks and when it is there again

    Raises ``InputError`` when an argument cannot be used, the machine cannot be connected to, the file exists or cannot
    be written, or the extra ``twin`` is not installed.
    """
    check_observer(observer)
    found: Any = {**taken(RecordArguments, "record", given)}
    seconds, ready = found.pop("seconds"), found.pop("ready")
    place = declared_output("record", "output", output)
    check_is_new(place)
    if seconds is not None and not 0.0 < _number("seconds", seconds) < math.inf:
        raise wrong_argument("seconds", seconds, phrase("give_seconds_or_none"))
    if place.path.suffix.lower() == ".parquet":
        import_extra("pyarrow.parquet", "twin")
    feed = machine_feed(address, observer=observer, **found)
    from trunnion.twin.recording.recorder import record as record_feed

    return record_feed(feed, place, seconds, ready or _ignore)


def machine_feed(address: str, *, observer: Observer = SILENT, **given: Unpack[LiveArguments]) -> "MachineFeed":
    """Return a machine that can be listened to; arguments as for ``record``.

    Raises ``InputError`` when an argument cannot be used, or the extra ``twin`` is not installed.
    """
    check_address(address)
    found = taken(LiveArguments, "record", given)
    rate, user, secure = found["rate"], found["user"], found["secure"]
    if not SHORTEST_RATE <= _number("rate", rate) <= LONGEST_RATE:
        raise wrong_argument("rate", rate, phrase("give_rate"))
    if user and not secure:
        raise InputError(argument_problem("user", Wording("TWN210", "user_without_encryption")))
    listed = load_nodes(check_path("nodes", found["nodes"]))
    import_extra("asyncua", "twin")
    from trunnion.twin.recording.client import Access
    from trunnion.twin.recording.feed import MachineFeed

    access = Access(address, _folder() if secure else None, found["trust"], user, found["password"])
    return MachineFeed(access, listed, rate, lambda problem: observer.problems([problem]))


def check_address(address: object) -> None:
    """Refuse what is no address of an OPC UA server, and one with a password in it.

    Raises ``InputError`` if it is none.
    """
    cure = phrase("write_address")
    try:
        parts = urlsplit(address) if isinstance(address, str) else None
        usable = parts is not None and parts.scheme == "opc.tcp" and bool(parts.hostname) and (parts.port or 1) > 0
    except ValueError:
        parts, usable = None, False
    if parts is None or not usable:
        raise wrong_argument("address", address, cure)
    if "@" in parts.netloc:
        raise InputError(argument_problem("address", Wording("TWN210", "user_in_address")))


def read_recording(file: FilePath) -> Recording:
    """Read a recording of a machine, CSV or Parquet.

    Raises ``InputError`` if the file cannot be used, or with its mistakes.
    """
    return read_file(check_path("file", file))


def as_recording(recorded: object) -> Recording:
    """Return a recording, or that of a file.

    Raises ``InputError`` if it is neither.
    """
    return recorded if isinstance(recorded, Recording) else read_file(check_path("recorded", recorded))


def _folder() -> Path:
    folder = user_data()
    if folder is None:
        raise InputError(Problem("trunnion", 0, Wording("TWN120", "no_folder_for_certificates")))
    return folder / "trunnion" / "twin"


def _number(name: str, value: object) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    raise wrong_argument(name, value, phrase("give_number"))
