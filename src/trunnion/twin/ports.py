"""Ports of this computer, taken before any work."""

import socket

from trunnion.errors import InputError, Problem


def listen(what: str, host: str, port: int, argument: str) -> socket.socket:
    """Take a port; 0: a free one.

    Parameters
    ----------
    what
        What is served there, for the message.
    host, port
        An address of this computer, and the port.
    argument
        The argument that chooses another port, for the message.

    Raises
    ------
    InputError
        If it is taken, or the address is none of this computer's.
    """
    if not 0 <= port <= 65535:
        raise InputError(
            Problem(what, 0, f"there is no port {port}", f"give {argument} a number up to 65535", code="TWN150")
        )
    try:
        return socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except (OSError, OverflowError) as error:
        fault = f"cannot be served on {host}, port {port}: {getattr(error, 'strerror', None) or error}"
        cure = f"choose another one with argument {argument}=NUMBER; 0 takes a free one"
        raise InputError(Problem(what, 0, fault, cure, code="TWN150")) from None
