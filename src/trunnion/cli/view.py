"""``trunnion view``: a program on its machine, in a browser."""

import argparse
import sys
from functools import partial
from typing import Any

from trunnion.cli.cl_files import cl_inputs, named_files
from trunnion.cli.record import machine_password
from trunnion.cli.results import print_result
from trunnion.cli.serving import announce
from trunnion.cli.terminal import Terminal
from trunnion.errors import InputError, argument_problem
from trunnion.files import check_outputs
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.project.file import library_files, project_files
from trunnion.jobs.twin.recording import machine_feed
from trunnion.jobs.view.live import LiveMachine, machine_content
from trunnion.jobs.view.viewing import check_view_name, prepare_view, write_view
from trunnion.viewer.content import ViewContent
from trunnion.viewer.live import LiveView
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import listen, serve
from trunnion.wording import counted


def run(arguments: argparse.Namespace) -> int:
    """Write the page, or serve it until the user ends it."""
    files = arguments.files
    if arguments.live is None and not files:
        raise InputError(argument_problem("nc", "is missing", "name a program, CL files or a project", code="ARG130"))
    if arguments.live is not None and arguments.output is not None:
        raise InputError(argument_problem("live", "is for a page that is served", "leave --output out", code="ARG130"))
    read = [*files, *project_files(files, ("machine", "stock")), *arguments.subprograms, *named_files(arguments.cl)]
    read += [*library_files(arguments.libraries), *arguments.fixtures]
    read += [file for file in (arguments.part, arguments.stock, arguments.against) if file is not None]
    given = {
        "machine": arguments.machine, "against": arguments.against, "against_machine": arguments.against_machine,
        "setup": arguments.setup, "settings": dict(arguments.settings) or None,
        "cl": cl_inputs(arguments.cl), "subprograms": arguments.subprograms, "stock": arguments.stock,
        "part": arguments.part, "fixtures": arguments.fixtures, "near": arguments.near, "tools": arguments.tools,
        "libraries": arguments.libraries, "unit": arguments.unit, "cell": arguments.cell,
        "accuracy": arguments.accuracy, "zero": arguments.zero or None, "tool_length": arguments.tool_length or None,
    }  # fmt: skip
    if arguments.output is not None:
        check_view_name(arguments.output)
        for machine in filter(None, (arguments.machine, arguments.against_machine)):
            read += machine_files(machine, load_machine(machine))
        check_outputs([arguments.output], read)
        write_view(files, output=arguments.output, observer=Terminal(), **given)
        print_result(f"{arguments.output}: written")
        return 0

    with listen(arguments.host, arguments.port) as listening:
        live = None
        if arguments.live is None:
            content = prepare_view(files, observer=Terminal(), **given)
        else:
            content, live = _live(arguments, given)
        print(counted(len(content.scene["findings"]), "finding"), file=sys.stderr)
        serve(lambda access: view_application(content, access, live), listening, announce(browser=arguments.browser))
    return 0


def _live(arguments: argparse.Namespace, given: dict[str, Any]) -> tuple[ViewContent, LiveView]:
    """What is shown of a machine that moves, and the machine; its program is shown where one is named."""
    if arguments.machine is None:
        raise InputError(argument_problem("machine", "is missing", "say which machine it is", code="ARG130"))
    password = machine_password(arguments.user)
    make = partial(
        machine_feed, arguments.live, nodes=arguments.nodes, rate=arguments.rate, secure=arguments.secure,
        trust=arguments.trust, user=arguments.user, password=password,
    )  # fmt: skip
    LiveMachine(make, arguments.machine).check()
    if arguments.files:
        content = prepare_view(arguments.files, observer=Terminal(), **given)
    else:
        alone = {
            name: given[name] for name in ("zero", "tool_length", "part", "fixtures", "tools", "libraries", "unit")
        }
        content = machine_content(arguments.machine, arguments.live, **alone)
    return content, LiveView(LiveMachine(make, arguments.machine, content.scene["files"]))
