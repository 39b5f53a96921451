"""Requests of an agent's clients, taken apart and checked by the rules of the standard."""

import re
from http import HTTPStatus
from typing import Final
from urllib.parse import parse_qsl, unquote, urlsplit

from trunnion.records import dataclass
from trunnion.twin.mtconnect.buffer import ObservationBuffer
from trunnion.twin.mtconnect.request_errors import RequestError, invalid, out_of_range

#: Arguments of each request.
_ARGUMENTS: Final = {
    "probe": (),
    "assets": (),
    "current": ("path", "at", "interval"),
    "sample": ("path", "from", "to", "count", "interval", "heartbeat"),
}

#: Arguments of the standard that this agent does not have, and other words for the requests.
_UNSUPPORTED: Final = ("frequency", "deviceType")
_MEANT: Final = {"": "probe", "asset": "assets"}

_COUNT: Final = 100
_HEARTBEAT: Final = 10_000

#: Milliseconds of the longest interval.
_LONGEST: Final = 2**31 - 1

_WHOLE: Final = re.compile(r"[-+]?[0-9]{1,19}", re.ASCII)


@dataclass(frozen=True, slots=True)
class Request:
    """What a client asks for.

    kind       probe, current, sample or assets
    path       of the items; None: all
    at         of ``current``: the number at which it is asked for; None: now
    start, to  of ``sample``: the numbers between which it is; None: as far as there are any
    count      most observations of ``sample``; below 0: backwards
    interval   milliseconds between two documents; None: there is one
    heartbeat  milliseconds after which an empty document comes
    """

    kind: str
    path: str | None = None
    at: int | None = None
    start: int | None = None
    to: int | None = None
    count: int = _COUNT
    interval: int | None = None
    heartbeat: int = _HEARTBEAT


def request_of(target: str, devices: tuple[str, ...], buffer: ObservationBuffer) -> Request:
    """Take a request apart; ``devices``: the names of the device.

    Raises ``RequestError`` if it is none of the standard, or asks for what there is not.
    """
    split = urlsplit(target) if target.startswith("/") and not target.startswith("//") else None
    if split is None or split.fragment:
        raise RequestError("INVALID_URI", "the address begins with / and names a request, as in /probe")
    parts = [unquote(part) for part in split.path.strip("/").split("/")]
    named = parts[0] in devices
    if named:
        parts = parts[1:] or [""]
    if parts[0] in ("asset", "assets") and len(parts) == 2:
        raise RequestError("ASSET_NOT_FOUND", f"asset {parts[1]}: there are no assets", HTTPStatus.NOT_FOUND)
    kind = _MEANT.get(parts[-1], parts[-1])
    if kind not in _ARGUMENTS or len(parts) > 2 - named:
        requests = ", ".join(f"/{name}" for name in _ARGUMENTS)
        raise RequestError("INVALID_URI", f"{split.path} is no request: there are {requests}", HTTPStatus.NOT_FOUND)
    if len(parts) == 2:
        raise RequestError("NO_DEVICE", f"{parts[0]} is no device: /probe has {devices[0]}", HTTPStatus.NOT_FOUND)
    given = _arguments(kind, split.query)
    if kind == "current":
        return _current(given, buffer)
    return _sample(given, buffer) if kind == "sample" else Request(kind)


def _arguments(kind: str, query: str) -> dict[str, str]:
    try:
        pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), max_num_fields=20)
    except ValueError:
        raise invalid("arguments are written name=value, with & between them") from None
    given = dict(pairs)
    if len(given) < len(pairs):
        raise invalid("an argument is there twice")
    for name in given:
        if name in _UNSUPPORTED:
            raise RequestError("UNSUPPORTED", f"{name} is not supported by this agent")
        if name not in _ARGUMENTS[kind]:
            known = ", ".join(_ARGUMENTS[kind]) or "none"
            raise invalid(f"{name} is no argument of {kind}; it has {known}")
    return given


def _current(given: dict[str, str], buffer: ObservationBuffer) -> Request:
    at, interval = _whole(given, "at"), _whole(given, "interval")
    if at is not None and interval is not None:
        raise invalid("at and interval exclude each other")
    if at is not None:
        _check_kept("at", at, buffer.first, buffer.last)
    _check_milliseconds("interval", interval, 1)
    return Request("current", given.get("path"), at=at, interval=interval)


def _sample(given: dict[str, str], buffer: ObservationBuffer) -> Request:
    start, to, count = _whole(given, "from"), _whole(given, "to"), _whole(given, "count")
    interval, heartbeat = _whole(given, "interval"), _whole(given, "heartbeat")
    count = min(_COUNT, buffer.size) if count is None else count
    start = start or None
    if start is not None:  # the next one may be asked for before it is there, as by those who go on reading
        _check_kept("from", start, buffer.first, buffer.next)
    if to is not None:
        if to < 0 or to < (start or 0):
            raise invalid(f"to {to} is before from")
        _check_kept("to", to, buffer.first, buffer.last)
    if not 0 < abs(count) <= buffer.size:
        raise out_of_range(f"count {count} is not between 1 and the {buffer.size} observations that are kept")
    if count < 0 and (interval is not None or to is not None):
        raise invalid("a count below 0 goes with neither interval nor to")
    if interval is None and heartbeat is not None:
        raise invalid("heartbeat goes with interval alone")
    if interval is not None and to is not None:
        raise invalid("to and interval exclude each other")
    _check_milliseconds("interval", interval, 0)
    _check_milliseconds("heartbeat", heartbeat, 1)
    beat = _HEARTBEAT if heartbeat is None else heartbeat
    return Request("sample", given.get("path"), start=start, to=to, count=count, interval=interval, heartbeat=beat)


def _whole(given: dict[str, str], name: str) -> int | None:
    if name not in given:
        return None
    if not _WHOLE.fullmatch(given[name]):
        raise invalid(f"{name} is a whole number")
    return int(given[name])


def _check_kept(name: str, sequence: int, first: int, last: int) -> None:
    if not first <= sequence <= last:
        raise out_of_range(f"{name} {sequence} is not between {first} and {last}")


def _check_milliseconds(name: str, value: int | None, least: int) -> None:
    if value is not None and not least <= value <= _LONGEST:
        raise invalid(f"{name} is a number of milliseconds from {least} to {_LONGEST}")
