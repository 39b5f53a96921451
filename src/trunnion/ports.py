"""Ports of this computer: taken before any work, and opened when what is behind them answers.

A port that is opened at once takes connections that nobody answers as long as the work lasts.
"""

import errno
import os
import socket
from contextlib import suppress


def bound_socket(host: str, port: int) -> socket.socket:
    """Return a socket that has a port, which no other program gets; 0: a free one. It takes no connections yet.

    Raises ``OSError`` if the port is taken, or the address is none of this computer's; ``OverflowError`` for no port.
    """
    taken = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    try:
        if taken.family == socket.AF_INET6:
            taken.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
        try:
            taken.bind((host, port))
        except OSError as error:
            if error.errno != errno.EADDRINUSE or os.name == "nt":
                raise
            _share(taken)  # with connections of a server that has ended
            taken.bind((host, port))
    except BaseException:
        taken.close()
        raise
    return taken


def open_port(taken: socket.socket) -> None:
    """Let a socket of ``bound_socket`` take connections.

    Raises ``OSError`` if another program has opened its port in the meantime.
    """
    if os.name != "nt":
        _share(taken)
    taken.listen(100)


def _share(taken: socket.socket) -> None:
    """Let the next server have the port while connections of this one, which have ended, still hold it."""
    with suppress(OSError):
        taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
