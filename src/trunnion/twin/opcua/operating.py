"""What a client can do to the twin: start, hold, reset, and the feed override; everything else is read only."""

import math
from collections.abc import Awaitable, Callable
from typing import Any, Final, Protocol

from asyncua import ua
from asyncua.crypto.permission_rules import SimpleRoleRuleset, User, UserRole
from asyncua.server.address_space import AddressSpace, AttributeService

from trunnion.twin.opcua.cnc import CHANNEL
from trunnion.twin.opcua.space import TWIN, Space

OBJECT: Final = "Twin"
OVERRIDE: Final = f"{CHANNEL}.CmdOverride"

#: Who writes where nobody is named: the server itself.
_SERVER: Final = User(role=UserRole.Admin)

_DOUBLE, _INT64, _STRING = ua.VariantType.Double, ua.VariantType.Int64, ua.VariantType.String

#: Requests that change something, which a viewer may not make.
_OPERATING: Final = frozenset(
    ua.NodeId(kind)
    for kind in (ua.ObjectIds.WriteRequest_Encoding_DefaultBinary, ua.ObjectIds.CallRequest_Encoding_DefaultBinary)
)


class Operated(Protocol):
    """What is operated: each returns whether that was possible."""

    async def start(self) -> bool:
        """Start the program, or go on with it."""

    async def hold(self) -> bool:
        """Hold all axes."""

    async def reset(self) -> bool:
        """Go back to the start of the program."""

    async def set_override(self, percent: float) -> bool:
        """Set the feed override."""


async def build_operating(space: Space, operated: Operated, speed: float | None, duration: float) -> None:
    """Add the object ``Twin`` with its methods, and what it tells of the run as a whole."""
    await space.folder(space.server.nodes.objects, OBJECT, OBJECT)
    for name, call, described in (
        ("Start", operated.start, "Starts the program, or goes on with it."),
        ("Hold", operated.hold, "Holds all axes where they are."),
        ("Reset", operated.reset, "Goes back to the start of the program."),
    ):
        await space.method(OBJECT, name, _method(call), described)
    # 0: as fast as the computer can
    await space.variable(f"{OBJECT}.Speed", TWIN, _DOUBLE, speed or 0.0)
    await space.variable(f"{OBJECT}.Duration", TWIN, _DOUBLE, duration)
    for name, key, kind in (
        ("ProgramTime", "program.seconds", _DOUBLE),
        ("Row", "program.row", _INT64),
        ("State", "state.text", _STRING),
    ):
        await space.variable(f"{OBJECT}.{name}", TWIN, kind)
        space.show(key, kind, f"{OBJECT}.{name}")
    for name in ("Duration", "ProgramTime"):
        await space.unit(f"{OBJECT}.{name}", "SEC")


def _method(call: Callable[[], Awaitable[bool]]) -> Callable[..., Any]:
    async def called(_parent: ua.NodeId, *given: Any) -> ua.StatusCode | list[Any]:
        if given:
            return ua.StatusCode(ua.StatusCodes.BadTooManyArguments)
        return [] if await call() else ua.StatusCode(ua.StatusCodes.BadInvalidState)

    return called


class TwinAttributes(AttributeService):
    """Writes of clients: the feed override is the one value that they can write."""

    def __init__(self, nodes: AddressSpace, override: ua.NodeId, operated: Operated) -> None:
        super().__init__(nodes)
        self._override, self._operated = override, operated

    async def write(self, params: ua.WriteParameters, user: User = _SERVER) -> list[ua.StatusCode]:
        """Write values; those of the server itself go where they always went."""
        if user.role == UserRole.Admin:
            return list(await super().write(params, user))
        return [await self._write(value) for value in params.NodesToWrite]

    async def _write(self, asked: ua.WriteValue) -> ua.StatusCode:
        codes = ua.StatusCodes
        if asked.NodeId != self._override or asked.AttributeId != ua.AttributeIds.Value:
            is_there = asked.NodeId in self._aspace
            return ua.StatusCode(codes.BadNotWritable if is_there else codes.BadNodeIdUnknown)
        variant = asked.Value.Value if asked.Value is not None else None
        if variant is None or variant.VariantType is not ua.VariantType.Double or not isinstance(variant.Value, float):
            return ua.StatusCode(codes.BadTypeMismatch)
        if not math.isfinite(variant.Value) or not await self._operated.set_override(variant.Value):
            return ua.StatusCode(codes.BadOutOfRange)
        return ua.StatusCode()


class TwinRules(SimpleRoleRuleset):
    """What users may do; ``Anonymous`` is the role of those who only look."""

    def check_validity(self, user: User, action_type_id: ua.NodeId, body: Any) -> bool:
        """Whether a user may make a request."""
        if user.role == UserRole.Anonymous and action_type_id in _OPERATING:
            return False
        allowed = self._permission_dict[UserRole.User]
        return action_type_id in allowed
