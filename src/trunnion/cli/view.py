"""``trunnion view``: a program on its machine, in a browser."""

import argparse
import sys

from trunnion.api.simulation_project import project_files
from trunnion.api.viewing import check_view_name, prepare_view, write_view
from trunnion.cli.cl_files import cl_inputs, named_files
from trunnion.cli.results import print_result
from trunnion.cli.serving import announce
from trunnion.cli.terminal import Terminal
from trunnion.files import check_outputs
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import listen, serve
from trunnion.wording import counted


def run(arguments: argparse.Namespace) -> int:
    """Write the page, or serve it until the user ends it."""
    files = arguments.files
    read = [*files, *project_files(files, ("machine", "stock")), *arguments.subprograms, *named_files(arguments.cl)]
    read += [*arguments.libraries, *arguments.fixtures]
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
        check_outputs([arguments.output], read)
        write_view(files, output=arguments.output, observer=Terminal(), **given)
        print_result(f"{arguments.output}: written")
        return 0

    with listen(arguments.host, arguments.port) as listening:
        content = prepare_view(files, observer=Terminal(), **given)
        print(counted(len(content.scene["findings"]), "finding"), file=sys.stderr)
        serve(lambda access: view_application(content, access), listening, announce(browser=arguments.browser))
    return 0
