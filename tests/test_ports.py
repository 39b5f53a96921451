"""Ports are taken at once, and take no connections before somebody answers them."""

import os
import socket

import pytest

from trunnion.ports import bound_socket, open_port


def test_a_port_is_nobody_elses_before_it_is_open() -> None:
    with bound_socket("127.0.0.1", 0) as taken:
        place = taken.getsockname()[:2]
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection(place, timeout=120)
        for _ in range(2):
            with pytest.raises(OSError, match=r"in use|only one usage"):
                bound_socket(*place)
            open_port(taken)
        socket.create_connection(place, timeout=120).close()


@pytest.mark.skipif(os.name == "nt", reason="a port is free there as soon as its server has ended")
def test_the_next_server_has_the_port_at_once() -> None:
    port = 0
    for _ in range(3):
        with bound_socket("127.0.0.1", port) as taken:
            open_port(taken)
            port = taken.getsockname()[1]
            client = socket.create_connection(("127.0.0.1", port), timeout=120)
            taken.accept()[0].close()  # who closes first holds the port for some minutes
            client.close()


@pytest.mark.skipif(os.name == "nt", reason="nobody shares a port there")
def test_of_two_that_have_shared_a_port_one_is_refused() -> None:
    with socket.socket() as one, socket.socket() as other:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        other.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        one.bind(("127.0.0.1", 0))
        other.bind(one.getsockname())
        open_port(one)
        with pytest.raises(OSError, match="in use"):
            open_port(other)
