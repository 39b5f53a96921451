"""``trunnion record``: what a machine, or a twin, shows by OPC UA, as a file."""

import argparse
import getpass
import sys

from trunnion.cli.results import print_result, tell
from trunnion.cli.terminal import Terminal
from trunnion.jobs.twin.recording import record
from trunnion.wording import counted


def run(arguments: argparse.Namespace) -> int:
    """Record until the user ends it, or until the time is over."""
    made = record(
        arguments.address, output=arguments.output, nodes=arguments.nodes, seconds=arguments.seconds,
        rate=arguments.rate, secure=arguments.secure, trust=arguments.trust, user=arguments.user,
        password=machine_password(arguments.user), ready=_announce, observer=Terminal(),
    )  # fmt: skip
    gaps = f", {counted(made.gaps, 'gap')} marked" if made.gaps else ""
    print_result(f"{arguments.output}: {counted(made.rows, 'row')}{gaps}")
    return 0


def machine_password(user: str) -> str:
    """The password of a user at a machine: asked for at a terminal, else the first line of stdin; empty for nobody."""
    if not user:
        return ""
    return getpass.getpass("Password: ") if sys.stdin.isatty() else sys.stdin.readline().rstrip("\r\n")


def _announce(names: tuple[str, ...]) -> None:
    tell(f"recording {', '.join(names)}", "Ctrl-C ends it")
