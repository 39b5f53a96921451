"""Ports of this computer, taken before any work."""

import socket

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording


def listen(what: str, host: str, port: int, argument: str) -> socket.socket:
    """Take a port; 0: a free one.

    what        what is served there, for the message
    host, port  an address of this computer, and the port
    argument    the argument that chooses another port, for the message

    Raises ``InputError`` if it is taken, or the address is none of this computer's.
    """
    if not 0 <= port <= 65535:
        raise InputError(Problem(what, 0, Wording("TWN150", "no_port", port=port, argument_text=argument)))
    try:
        return socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except (OSError, OverflowError) as error:
        raise InputError(
            Problem(
                what,
                0,
                Wording(
                    "TWN150",
                    "cannot_served_port",
                    host=host,
                    port=port,
                    getattr=getattr(error, "strerror", None) or error,
                    argument_text=argument,
                ),
            )
        ) from None
