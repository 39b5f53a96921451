"""``trunnion twin``: a program as a running machine on OPC UA and MTConnect."""

import getpass
import sys
from typing import TYPE_CHECKING

from trunnion.cli.printing import print_result
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, said, spoken
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.job import Given
from trunnion.jobs.twin.serving import add_twin_user, is_loopback, serve_twin, write_device_xml
from trunnion.messages import Wording, joined

if TYPE_CHECKING:
    from trunnion.twin.serving import TwinAddresses


def run(given: Given) -> int:
    """Serve the program until the user ends it; or add a user; or write the device model."""
    if given.add_user is not None:
        path = add_twin_user(given.add_user, _password(), operator=given.role == "operator", users=given.users)
        variant = "user_operator" if given.role == "operator" else "user_viewer"
        print_result(line(variant, file=str(path), user=given.add_user))
        return 0
    missing = [name for name, value in (("nc", given.nc), ("machine", given.machine)) if value is None]
    if missing:
        raise InputError([argument_problem(name, Wording("ARG130", "missing_program_and_machine")) for name in missing])
    if given.device_xml is not None:
        setup = {name: given.values[name] for name in ("machine", "subprograms", "zero", "tool_length")}
        write_device_xml(given.nc, output=given.device_xml, **setup)
        print_result(line("file_written", file=given.device_xml))
        return 0
    settings = given.arguments()
    if given.no_mtconnect:
        settings |= {"adapter_port": None, "agent_port": None}
    serve_twin(**settings, observer=Terminal(), ready=lambda addresses: _announce(addresses, given))
    return 0


def _announce(addresses: "TwinAddresses", given: Given) -> None:
    """Say where it is served, and how to connect."""
    if is_loopback(given.host):
        lines = [said("twin_here", address=addresses.opcua)]
    else:
        lines = [said("twin_for_users", address=addresses.opcua, fingerprint=addresses.fingerprint)]
    if addresses.mtconnect:
        lines.append(said("twin_adapter", address=addresses.mtconnect))
    if addresses.agent:
        lines.append(said("twin_agent", address=addresses.agent))
    if grounds := joined(addresses.grounds.wordings(named=True), spoken()):
        lines.append(said("twin_stands_on", basis=grounds))
    if given.hold:
        lines.append(said("twin_waits"))
    print(*lines, said("ctrl_c_ends"), sep="\n", file=sys.stderr, flush=True)


def _password() -> str:
    """Return the password of a new user: asked for twice at a terminal, else the first line of stdin."""
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\r\n")
    password = getpass.getpass(said("ask_password"))
    if getpass.getpass(said("ask_password_again")) != password:
        raise InputError(Problem("password", 0, Wording("ARG180", "passwords_differ")))
    return password
