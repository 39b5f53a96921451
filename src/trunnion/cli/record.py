"""``trunnion record``: what a machine, or a twin, shows by OPC UA, as a file."""

import getpass
import sys

from trunnion.cli.printing import print_result, tell
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, said
from trunnion.jobs.job import Given
from trunnion.jobs.twin.recording import record


def run(given: Given) -> int:
    """Record until the user ends it, or until the time is over."""
    password = machine_password(given.user)
    made = record(**given.arguments(), password=password, ready=_announce, observer=Terminal())
    if made.gaps:
        print_result(line("recorded_with_gaps", file=given.output, rows=made.rows, gaps=made.gaps))
    else:
        print_result(line("recorded", file=given.output, rows=made.rows))
    return 0


def machine_password(user: str) -> str:
    """Return the password of a user at a machine: asked for at a terminal, else the first line of stdin; empty for
    nobody.
    """
    if not user:
        return ""
    return getpass.getpass(said("ask_password")) if sys.stdin.isatty() else sys.stdin.readline().rstrip("\r\n")


def _announce(names: tuple[str, ...]) -> None:
    tell(said("recording", names=names), said("ctrl_c_ends"))
