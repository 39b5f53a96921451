"""Ports of a twin: taken before any work, and opened when clients are answered."""

import socket

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.ports import bound_socket, open_port
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class TwinPort:
    """A port that is taken.

    what      what is served there, for messages
    host      the address of this computer, as it was given
    argument  the argument that chooses another port, for messages
    socket    takes no connections before ``open``
    """

    what: str
    host: str
    argument: str
    socket: socket.socket

    def __enter__(self) -> "TwinPort":
        return self

    def __exit__(self, *_error: object) -> None:
        self.socket.close()

    def open(self) -> None:
        """Take connections.

        Raises ``InputError`` if another program has opened the port in the meantime.
        """
        try:
            open_port(self.socket)
        except OSError as error:
            raise _not_served(self.what, self.host, self.socket.getsockname()[1], self.argument, error) from None


def take_port(what: str, host: str, port: int, argument: str) -> TwinPort:
    """Take a port; 0: a free one.

    what        what is served there, for the message
    host, port  an address of this computer, and the port
    argument    the argument that chooses another port, for the message

    Raises ``InputError`` if it is taken, or the address is none of this computer's.
    """
    if not 0 <= port <= 65535:
        raise InputError(Problem(what, 0, Wording("TWN150", "no_port", port=port, argument_text=argument)))
    try:
        return TwinPort(what, host, argument, bound_socket(host, port))
    except (OSError, OverflowError) as error:
        raise _not_served(what, host, port, argument, error) from None


def _not_served(what: str, host: str, port: int, argument: str, error: Exception) -> InputError:
    reason = getattr(error, "strerror", None) or error
    return InputError(
        Problem(
            what,
            0,
            Wording("TWN150", "cannot_served_port", host=host, port=port, getattr=reason, argument_text=argument),
        )
    )
