"""The arguments of the command line."""

import argparse
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib import import_module
from typing import Final, NoReturn

from trunnion import __version__
from trunnion.cli.argument_values import (
    FEEDS,
    add_angles,
    add_settings,
    add_subprograms,
    cell,
    scale,
    tolerance,
)
from trunnion.cli.batch_arguments import add_batch
from trunnion.cli.capability_arguments import add_fit, add_reach, add_sensitivity
from trunnion.cli.place_arguments import add_place
from trunnion.cli.post_arguments import post_mistake
from trunnion.cli.stock_arguments import add_stock
from trunnion.cli.twin_arguments import add_machine_access, add_record, add_twin
from trunnion.cli.verify_arguments import add_verify
from trunnion.dialect_names import READ_DIALECTS, WRITTEN_DIALECTS


class _Parser(argparse.ArgumentParser):
    """Ends with the code of its message; its subparsers are of its class."""

    def error(self, message: str) -> NoReturn:
        super().error(f"{message} [{_USAGE}]")


#: The code of a command line that cannot be understood.
_USAGE: Final = "ARG120"

#: An option in a line of usage.
_OPTION: Final = re.compile(r"--[a-z][a-z-]*")
_NEGATIVE_LIST: Final = re.compile(r"-[0-9.]+(?:,[-+0-9.eE]+)+")

#: Kinds of files that there are schemas of; listed here for the same reason.
SCHEMAS = ("machine", "control", "project", "tools", "impeller", "nodes", "batch")


def _not_expected(unknown: Sequence[str], command: str) -> str:
    """What is wrong with arguments that a command does not take, and the cure."""
    if unknown[0].startswith("-"):
        return f"{unknown[0]} is no option of this command; trunnion {command} --help lists those that it has"
    cure = "repeat an option before each of its values, and put a value with blanks in quotes"
    return f"{unknown[0]!r} is one argument too many; {cure}"


def _lazy_command(module: str, name: str) -> Callable[[argparse.Namespace], int]:
    """The function that carries out a command; its module is imported when it is called."""

    def run(arguments: argparse.Namespace) -> int:
        command: Callable[[argparse.Namespace], int] = getattr(import_module(f"trunnion.cli.{module}"), name)
        return command(arguments)

    return run


def parse_arguments(argv: Sequence[str]) -> argparse.Namespace:
    """The command and its arguments; ``run`` is the function that carries it out.

    Ends the process with exit code 2 and a usage line when they cannot be understood.
    """
    parser, commands = _parsers()
    argv = _with_negative_values(argv)
    if not argv:
        parser.error("name a command; trunnion --help lists them")
    if argv and argv[0] in commands:  # before argparse, which first tells what is missing
        command = commands[argv[0]]
        if wrong := _unknown_option(argv[1:], command):
            command.error(_not_expected([wrong], argv[0]))
    arguments, unknown = parser.parse_known_args(list(argv))
    if unknown:
        commands[arguments.command].error(_not_expected(unknown, arguments.command))
    if arguments.command == "post" and (wrong := post_mistake(arguments)):
        commands["post"].error(wrong)
    for key in ("dialect", "feed"):
        if getattr(arguments, key, None) and "settings" in arguments:
            if key in dict(arguments.settings):
                parser.error(f"--{key} and --set {key}=… are the same: give one of them")
            arguments.settings = [*arguments.settings, (key, getattr(arguments, key))]
    return arguments


def _with_negative_values(words: Sequence[str]) -> list[str]:
    """Words with ``--zero -31,0,5`` as ``--zero=-31,0,5``: argparse takes a list that begins so for an option."""
    joined: list[str] = []
    for word in words:
        if joined and _OPTION.fullmatch(joined[-1]) and _NEGATIVE_LIST.fullmatch(word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _unknown_option(words: Sequence[str], command: argparse.ArgumentParser) -> str:
    """The first word that looks like an option and is none, nor the beginning of one; empty if there is none."""
    known = ["--help", *_OPTION.findall(command.format_usage())]  # usage writes the first one as -h
    for word in words:
        name = word.partition("=")[0]
        if name == "--":
            break
        if name.startswith("--") and not any(option.startswith(name) for option in known):
            return word
    return ""


@cache
def _parsers() -> tuple[argparse.ArgumentParser, Mapping[str, argparse.ArgumentParser]]:
    """The parser of the command line, and those of the commands."""
    parser = _Parser(prog="trunnion", description="CL files to proven NC programs for five-axis machine tools.")
    parser.add_argument("--version", action="version", version=f"trunnion {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True, dest="command")
    _add_post(commands.add_parser("post", help="write the NC program of one or more CL files"))
    _add_test(commands.add_parser("test", help="post the projects of a folder again, and compare with what is there"))
    _add_verify(
        commands.add_parser("verify", help="prove an NC program: read it, run it, compare it with its CL files")
    )
    _add_sensitivity(
        commands.add_parser("sensitivity", help="rank the numbers of a machine by what they do to an NC program")
    )
    _add_reach(commands.add_parser("reach", help="tell which tool axes and points a machine reaches"))
    _add_fit(commands.add_parser("fit", help="rank the machines that can run CL files or an NC program"))
    _add_diff(commands.add_parser("diff", help="compare what two NC programs make the tool do"))
    _add_convert(
        commands.add_parser("convert", help="turn an NC program into a CL file, or post it for another machine")
    )
    _add_place(commands.add_parser("place", help="find where on the table a part may sit, and where best"))
    _add_simulate(commands.add_parser("simulate", help="cut stock with NC programs: what is left, and what is hit"))
    _add_batch(commands.add_parser("batch", help="post, convert, verify or simulate many files, here or on a cluster"))
    _add_view(commands.add_parser("view", help="show an NC program on its machine, in a browser"))
    _add_twin(commands.add_parser("twin", help="serve an NC program as a running machine: OPC UA and MTConnect"))
    _add_record(commands.add_parser("record", help="record what a machine, or a twin, shows by OPC UA"))
    _add_build(commands.add_parser("build", help="set up the definition of a machine, in a browser"))
    _add_info(commands.add_parser("info", help="show what CL files hold; no machine is needed"))
    _add_curve(commands.add_parser("curve", help="fit curves to measured points; no machine is needed"))
    _add_impeller(commands.add_parser("impeller", help="make an impeller from measured points"))
    _add_new(commands.add_parser("new", help="write the definition of a machine that is like a shipped one"))
    _add_machines(commands.add_parser("machines", help="list the machines, or print one definition"))
    _add_controls(commands.add_parser("controls", help="list the controls, or explain one with all its settings"))
    _add_check(commands.add_parser("check", help="validate the definition of a machine or a control"))
    _add_explain(commands.add_parser("explain", help="say what a code of a message, or a check, means"))
    _add_schema(commands.add_parser("schema", help="print the JSON Schema of definitions or projects, for editors"))
    return parser, commands.choices


def _add_post(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "files", nargs="+", metavar="CL|PROJECT", help="CL file; or one project (.toml), which states all but --set"
    )
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="shipped machine, or a TOML file")
    parser.add_argument(
        "--output", metavar="FILE|-|FOLDER", help="program, stdout, or a folder: one program per CL file"
    )
    add_settings(parser, "what templates print (title, part, date, method, …), or how to read, place and plan")
    add_subprograms(parser, "a template")
    parser.add_argument(
        "--hooks", action="append", default=[], metavar="FILE.py",
        help="Python file whose functions change what the CL files ask for; it is run; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--dialect", choices=READ_DIALECTS, help="what the CL files are written in; by default their content decides"
    )
    parser.add_argument(
        "--feed", choices=FEEDS, help="fastest: of each block what the axes reach, within the feed of the CL file"
    )
    parser.add_argument("--strict", action="store_true", help="unknown CL statements are errors at once")
    parser.add_argument("--force", action="store_true", help="write a program that must not run; its head says so")
    parser.add_argument("--explain", action="store_true", help="say why the axes were planned as they are")
    parser.add_argument("--report", metavar="FILE", help="what was checked, as a page (.html) or data (.json)")
    parser.add_argument("--sheet", metavar="FILE", help="setup sheet to print (.html), or its data (.json)")
    parser.add_argument("--listing", metavar="FILE", help="every motion as text: X Y Z, rotary axes, S, F")
    parser.add_argument("--manifest", metavar="FILE", help="checksums of all files (.json), beside the program")
    parser.add_argument("--watch", action="store_true", help="post again whenever a file that is read changes")
    parser.add_argument(
        "--simulate", action="store_true", help="cut stock with the program too, and refuse what it must not do"
    )
    add_angles(parser, "and its toolpath with it; the head of the program says so")
    parser.add_argument("--project", metavar="PROJECT", help="project file (.toml) that states what --simulate takes")
    add_stock(parser)
    parser.set_defaults(run=_lazy_command("startup", "run"))


def _add_test(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "folder",
        metavar="FOLDER|PROJECT",
        help="every part.toml, case.toml and NAME.case.toml in it and below; or one project",
    )
    parser.add_argument("--accept", action="store_true", help="show what differs, and take the new programs over")
    parser.set_defaults(run=_lazy_command("cases", "run"))


def _add_verify(parser: argparse.ArgumentParser) -> None:
    add_verify(parser)
    parser.set_defaults(run=_lazy_command("verify", "run"))


def _add_sensitivity(parser: argparse.ArgumentParser) -> None:
    add_sensitivity(parser)
    add_subprograms(parser, "it")
    parser.set_defaults(run=_lazy_command("sensitivity", "run"))


def _add_reach(parser: argparse.ArgumentParser) -> None:
    add_reach(parser)
    parser.set_defaults(run=_lazy_command("reach", "run"))


def _add_fit(parser: argparse.ArgumentParser) -> None:
    add_fit(parser)
    add_subprograms(parser, "the NC program")
    parser.set_defaults(run=_lazy_command("fit", "run"))


def _add_diff(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs=2, metavar="NC", help="NC program")
    parser.add_argument("--machine", required=True, metavar="NAME_OR_FILE", help="machine that runs the first program")
    parser.add_argument("--to-machine", metavar="NAME_OR_FILE", help="machine that runs the second one, if another")
    add_subprograms(parser, "the first program")
    add_subprograms(parser, "the second one", "--to-with", "to_subprograms")
    parser.add_argument(
        "--tolerance", type=tolerance, default=0.001, metavar="MM",
        help="how far tips may be apart, and in degrees tool axes; 0.001",
    )  # fmt: skip
    parser.add_argument(
        "--path", action="store_true", help="compare where the tool goes, but not feed, spindle, tool and coolant"
    )
    parser.set_defaults(run=_lazy_command("diff", "run"))


def _add_convert(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="NC|CL", help="NC program; without --machine, a CL file")
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="machine that the program is for")
    add_subprograms(parser, "it")
    into = parser.add_mutually_exclusive_group(required=True)
    into.add_argument("--to-cl", action="store_true", help="write a CL file")
    into.add_argument("--to-machine", metavar="NAME_OR_FILE", help="write a program for this machine")
    parser.add_argument(
        "--dialect", choices=tuple(WRITTEN_DIALECTS), dest="to_dialect",
        help="what the CL file is written in; by default clsf",
    )  # fmt: skip
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the program's own machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool there, gauge point to tip")
    parser.add_argument("--output", metavar="FILE|-|FOLDER", help="result; without it a file of that name here")
    add_settings(parser, "what templates print, in place of what the program says, and zero")
    parser.add_argument(
        "--force", action="store_true", help="convert what was understood, and write a program that must not run"
    )
    parser.set_defaults(run=_lazy_command("convert", "run"))


def _add_batch(parser: argparse.ArgumentParser) -> None:
    add_batch(parser)
    add_settings(parser, "for a folder: settings as post has them")
    parser.set_defaults(run=_lazy_command("batch", "run"))


def _add_view(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "files", nargs="*", metavar="NC|CL|PROJECT",
        help="NC program, with its subprograms behind it; CL files, which are posted; or a project (.toml)",
    )  # fmt: skip
    parser.add_argument(
        "--live", metavar="ADDRESS",
        help="follow a machine, or a twin, by OPC UA (opc.tcp://HOST:PORT/…), as it moves; no program is needed",
    )  # fmt: skip
    add_machine_access(parser)
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="machine that runs it; a project may state it")
    parser.add_argument("--against", metavar="NC|CL", help="a second program, beside it on the same tool path")
    parser.add_argument("--against-machine", metavar="NAME_OR_FILE", help="machine of that, if it is another")
    parser.add_argument("--setup", metavar="NAME", help="set-up of a project, if it has several: its name or number")
    add_settings(parser, "for CL files, as post has it")
    parser.add_argument("--cl", action="append", default=[], metavar="CL", help="CL file that it was made from")
    add_subprograms(parser, "it")
    add_stock(parser)
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, gauge point to tip")
    parser.add_argument("--output", metavar="FILE.html", help="write a page that works offline, and serve nothing")
    _add_serving(parser)
    parser.set_defaults(run=_lazy_command("view", "run"))


def _add_place(parser: argparse.ArgumentParser) -> None:
    add_place(parser)
    parser.set_defaults(run=_lazy_command("place", "run"))


def _add_twin(parser: argparse.ArgumentParser) -> None:
    add_twin(parser)
    add_subprograms(parser, "it")
    parser.set_defaults(run=_lazy_command("twin", "run"))


def _add_record(parser: argparse.ArgumentParser) -> None:
    add_record(parser)
    parser.set_defaults(run=_lazy_command("record", "run"))


def _add_build(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", nargs="?", default="", metavar="MACHINE.toml", help="definition; none: a new one")
    _add_serving(parser)
    parser.set_defaults(run=_lazy_command("build", "run"))


def _add_serving(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--no-browser", action="store_false", dest="browser", help="only print the address")
    parser.add_argument("--host", default="127.0.0.1", help="serve other computers, too, on this address; with a token")
    parser.add_argument("--port", type=int, default=0, help="a free one by default")


def _add_simulate(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "files", nargs="+", metavar="NC|PROJECT",
        help="NC program; several cut the same stock in their order. Or a project (.toml), which may state all options",
    )  # fmt: skip
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="machine that runs them")
    add_stock(parser)
    parser.add_argument("--cl", action="append", default=[], metavar="CL", help="CL file whose tools these are")
    add_subprograms(parser, "they")
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, gauge point to tip")
    add_angles(parser, "as the head of its program says; stock, part and fixtures are given as drawn")
    parser.add_argument("--stop-at", choices=("none", "first"), help="end after the block of the first finding")
    parser.add_argument("--until", metavar="BLOCK", help="N number of the block before which the last program ends")
    parser.add_argument("--json", metavar="FILE", help="all results as data; - is stdout")
    parser.add_argument(
        "--report", metavar="FILE", help="findings, tables and pictures as a page (.html), or data (.json)"
    )
    parser.add_argument(
        "--save-stock", metavar="FILE", help="the finished stock: .stl, .ply, .3mf or .glb; .png: a picture of it"
    )
    parser.set_defaults(run=_lazy_command("simulate", "run"))


def _add_info(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs="+", metavar="CL", help="CL file; several are one job in their order")
    parser.add_argument("--units", choices=("mm", "inch"), help="length unit of the files, whatever they state")
    parser.add_argument("--dialect", choices=READ_DIALECTS, help="what they are written in")
    parser.add_argument("--strict", action="store_true", help="unknown statements are errors")
    parser.add_argument("--json", action="store_true", help="data in place of text")
    parser.add_argument("--plot", metavar="FILE", help="the path by operation in space, as a page (.html)")
    parser.set_defaults(run=_lazy_command("info", "info"))


def _add_curve(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="POINTS", help="table of points (.csv): columns x, y, z, or tip_x, tip_y, …")
    ends = "natural (no curvature), tangent:X,Y,Z or derivative:X,Y,Z (by the parameter, which goes from 0 to 1)"
    parser.add_argument("--start", default="natural", metavar="END", help=f"how curves begin: {ends}")
    parser.add_argument("--end", default="natural", metavar="END", help="how they end")
    parser.add_argument(
        "--parameterization", choices=("chord-length", "centripetal"), default="chord-length",
        help="how far apart the parameters of two points are; chord-length",
    )  # fmt: skip
    parser.add_argument(
        "--tolerance", type=tolerance, metavar="MM", help="pass the points within it, with few control points"
    )
    parser.add_argument("--fair", type=tolerance, metavar="MM", help="first move points by as much, for an even curve")
    parser.add_argument("--scale", type=scale, default=1.0, metavar="FACTOR", help="multiply the points by it")
    parser.add_argument("--json", action="store_true", help="data in place of text")
    parser.add_argument("--picture", metavar="FILE", help="curves with their curvature combs (.svg)")
    parser.set_defaults(run=_lazy_command("curve", "run"))


def _add_impeller(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "step",
        choices=("model", "cut"),
        help="model: a closed mesh or solid of it; cut: CL files and a proven program",
    )
    parser.add_argument("file", metavar="IMPELLER", help="definition of the impeller (.toml)")
    parser.add_argument(
        "--output",
        metavar="FILE|FOLDER",
        help="the mesh (.stl, .ply, .3mf or .glb), a picture of it (.png), or a STEP file (.stp); folder of a cut",
    )
    parser.add_argument(
        "--tolerance",
        type=tolerance,
        metavar="MM",
        help="model: how far facets may be off, 0.01; of STEP: faces, 0.005",
    )
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="cut: machine that runs the program")
    parser.add_argument(
        "--operation", action="append", default=[], metavar="NAME", dest="operations",
        help="cut: make this operation of the definition only; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--cell", type=cell, metavar="MM",
        help="cut: simulate the program in cells of this width, and compare the part with the model",
    )  # fmt: skip
    add_settings(parser, "cut: settings as for post")
    parser.add_argument("--json", action="store_true", help="data in place of text")
    parser.set_defaults(run=_lazy_command("impeller", "run"))


def _add_machines(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", nargs="?", metavar="NAME", help="machine whose definition is printed")
    parser.add_argument(
        "--resolved", action="store_true", help="with all that it extends, and the file and line of each value"
    )
    parser.set_defaults(run=_lazy_command("definitions", "machines"))


def _add_controls(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", nargs="?", metavar="NAME_OR_FILE", help="control to explain, or a machine's")
    parser.add_argument("--json", action="store_true", help="data in place of text")
    parser.set_defaults(run=_lazy_command("controls", "controls"))


def _add_new(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="name of the machine: NAME.toml is written")
    parser.add_argument("--like", required=True, metavar="MACHINE", help="shipped machine that it extends")
    parser.set_defaults(run=_lazy_command("new", "new"))


def _add_schema(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("kind", choices=SCHEMAS, help="what the files are")
    parser.set_defaults(run=_lazy_command("new", "schema"))


def _add_check(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="NAME_OR_FILE", help="definition to validate: a TOML file, or a shipped one")
    parser.add_argument("--json", action="store_true", help="what it means as data in place of text")
    parser.set_defaults(run=_lazy_command("definitions", "check"))


def _add_explain(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("codes", nargs="*", metavar="CODE", help="as messages end with it, such as CL110, or a check")
    parser.add_argument("--json", action="store_true", help="print it as data")
    parser.set_defaults(run=_lazy_command("explain", "explain"))
