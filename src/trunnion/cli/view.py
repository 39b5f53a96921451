"""``trunnion view``: a program on its machine, in a browser."""

import sys
from functools import partial
from typing import Any, Final

from trunnion.cli.printing import announce, print_result
from trunnion.cli.record import machine_password
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, page_speech, said, spoken
from trunnion.errors import InputError, argument_problem
from trunnion.jobs.job import Given
from trunnion.jobs.twin.recording import machine_feed
from trunnion.jobs.view.live import LiveMachine, machine_content
from trunnion.jobs.view.viewing import prepare_view, write_view
from trunnion.messages import Wording
from trunnion.options.groups import LIVE
from trunnion.viewer.content import ViewContent
from trunnion.viewer.live import LiveView
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import serve, take_port

#: How to connect to a machine, and what is shown of one without a program.
_LIVE: Final = tuple(option.name for option in LIVE)
_OF_MACHINE: Final = ("zero", "tool_length", "part", "fixtures", "tools", "tool_libraries", "unit")


def run(given: Given) -> int:
    """Write the page, or serve it until the user ends it."""
    if given.live is None and not given.nc:
        raise InputError(argument_problem("nc", Wording("ARG130", "missing_what_is_viewed")))
    if given.live is not None and given.output is not None:
        raise InputError(argument_problem("live", Wording("ARG130", "live_is_served")))
    shown = given.arguments("output", *_LIVE)
    if given.output is not None:
        standing = write_view(**shown, output=given.output, observer=Terminal())
        print_result(line("file_written", file=given.output), standing)
        return 0

    speech = page_speech()
    with take_port(given.host, given.port) as listening:
        live = None
        if given.live is None:
            content = prepare_view(**shown, observer=Terminal())
        else:
            content, live = _live(given, shown)
        print(
            said("findings", count=len(content.scene["findings"])),
            *filter(None, [content.said(spoken())["standing"]]),
            sep="\n",
            file=sys.stderr,
        )
        serve(
            lambda access: view_application(content, access, live, speech),
            listening,
            announce(said("ctrl_c_ends"), browser=given.browser),
        )
    return 0


def _live(given: Given, shown: dict[str, Any]) -> tuple[ViewContent, LiveView]:
    """Return what is shown of a machine that moves, and the machine; its program is shown where one is named."""
    if given.machine is None:
        raise InputError(argument_problem("machine", Wording("ARG130", "missing_live_machine")))
    access = {name: given.values[name] for name in _LIVE}
    make = partial(machine_feed, given.live, password=machine_password(given.user), **access)
    LiveMachine(make, given.machine).check()
    if given.nc:
        content = prepare_view(**shown, observer=Terminal())
    else:
        content = machine_content(given.machine, given.live, **{name: shown[name] for name in _OF_MACHINE})
    return content, LiveView(LiveMachine(make, given.machine, content.scene["files"]))
