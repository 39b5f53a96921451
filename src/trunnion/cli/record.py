"""``trunnion record``: what a machine, or a twin, shows by OPC UA, as a file."""

import getpass
import sys

from trunnion.cli.printing import print_result, tell
from trunnion.cli.terminal import Terminal
from trunnion.jobs.job import Given
from trunnion.jobs.twin.recording import record
from trunnion.wording import counted


def run(given: Given) -> int:
    """Record until the user ends it, or until the time is over."""
    password = machine_password(given.user)
    made = record(**given.arguments(), password=password, ready=_announce, observer=Terminal())
    gaps = f", {counted(made.gaps, 'gap')} marked" if made.gaps else ""
    print_result(f"{given.output}: {counted(made.rows, 'row')}{gaps}")
    return 0


def machine_password(user: str) -> str:
    """Return the password of a user at a machine: asked for at a terminal, else the first line of stdin; empty for
    nobody.
    """
    if not user:
        return ""
    return getpass.getpass("Password: ") if sys.stdin.isatty() else sys.stdin.readline().rstrip("\r\n")


def _announce(names: tuple[str, ...]) -> None:
    tell(f"recording {', '.join(names)}", "Ctrl-C ends it")
