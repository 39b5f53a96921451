"""``trunnion twin``: a program as a running machine on OPC UA and MTConnect."""

import argparse
import getpass
import sys
from typing import TYPE_CHECKING

from trunnion.cli.results import print_result
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.files import check_outputs
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.twin.serving import add_twin_user, is_loopback, serve_twin, write_device_xml

if TYPE_CHECKING:
    from trunnion.twin.serving import TwinAddresses


def run(arguments: argparse.Namespace) -> int:
    """Serve the program until the user ends it; or add a user; or write the device model."""
    if arguments.add_user is not None:
        path = add_twin_user(
            arguments.add_user, _password(), operator=arguments.role == "operator", users=arguments.users
        )
        print_result(f"{path}: {arguments.add_user} is {'an operator' if arguments.role == 'operator' else 'a viewer'}")
        return 0
    missing = [name for name, value in (("nc", arguments.file), ("machine", arguments.machine)) if value is None]
    if missing:
        raise InputError(
            [
                argument_problem(name, "is missing", "name the program and its machine", code="ARG130")
                for name in missing
            ]
        )
    if arguments.device_xml is not None:
        definition = machine_files(arguments.machine, load_machine(arguments.machine))
        check_outputs([arguments.device_xml], [arguments.file, *arguments.subprograms, *definition])
        write_device_xml(
            arguments.file, machine=arguments.machine, output=arguments.device_xml,
            subprograms=arguments.subprograms, zero=arguments.zero or None, tool_length=arguments.tool_length or None,
        )  # fmt: skip
        print_result(f"{arguments.device_xml}: written")
        return 0
    serve_twin(
        arguments.file, machine=arguments.machine, subprograms=arguments.subprograms, zero=arguments.zero or None,
        tool_length=arguments.tool_length or None, speed=arguments.speed, loop=arguments.loop, rate=arguments.rate,
        hold=arguments.hold, host=arguments.host, port=arguments.port,
        adapter_port=None if arguments.no_mtconnect else arguments.adapter_port, users=arguments.users,
        ready=lambda addresses: _announce(addresses, arguments),
    )  # fmt: skip
    return 0


def _announce(addresses: "TwinAddresses", arguments: argparse.Namespace) -> None:
    """Say where it is served, and how to connect."""
    if is_loopback(arguments.host):
        how = "from this computer, anonymous, security None"
    else:
        how = f"with a user and SignAndEncrypt; certificate {addresses.fingerprint}"
    lines = [f"OPC UA: {addresses.opcua} ({how})"]
    if addresses.mtconnect:
        lines.append(f"MTConnect: an agent connects to {addresses.mtconnect} (SHDR); --device-xml writes its devices")
    if arguments.hold:
        lines.append("the program waits for a client to call Start in the object Twin")
    print(*lines, "Ctrl-C ends it", sep="\n", file=sys.stderr, flush=True)


def _password() -> str:
    """The password of a new user: asked for twice at a terminal, else the first line of stdin."""
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\r\n")
    password = getpass.getpass("Password: ")
    if getpass.getpass("Once more: ") != password:
        raise InputError(Problem("password", 0, "is not the same both times", "start again", code="ARG180"))
    return password
