"""The arguments of ``trunnion twin``."""

import argparse

from trunnion.twin.limits import FASTEST, LONGEST_RATE, SHORTEST_RATE, SLOWEST


def speed(text: str) -> float | None:
    """Times real time; None for ``max``."""
    if text == "max":
        return None
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not SLOWEST <= value <= FASTEST:
        what = f"{text!r} is no speed; write a number from {SLOWEST:g} to {FASTEST:g} times real time, or max"
        raise argparse.ArgumentTypeError(what)
    return value


def milliseconds(text: str) -> float:
    """Milliseconds between two samples."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not SHORTEST_RATE <= value <= LONGEST_RATE:
        what = f"{text!r} is no rate; write milliseconds from {SHORTEST_RATE:g} to {LONGEST_RATE:g}"
        raise argparse.ArgumentTypeError(what)
    return value


def add_twin(parser: argparse.ArgumentParser) -> None:
    """Add them; the subprograms and the function that runs it are added by the caller."""
    parser.add_argument("file", nargs="?", metavar="NC", help="NC program that the machine runs")
    parser.add_argument("--machine", metavar="NAME_OR_FILE", help="machine that runs it")
    parser.add_argument("--zero", metavar="X,Y,Z", help="the workpiece zero on the machine, mm")
    parser.add_argument("--tool-length", metavar="MM", help="length of the tool, gauge point to tip")
    parser.add_argument(
        "--speed", type=speed, default=1.0, metavar="N|max",
        help="times real time, 0.1 to 1000, or max: as fast as clients can follow; 1",
    )  # fmt: skip
    parser.add_argument("--loop", action="store_true", help="begin anew at the end of the program")
    parser.add_argument("--hold", action="store_true", help="wait for a client to start the program")
    parser.add_argument(
        "--rate", type=milliseconds, default=20.0, metavar="MS",
        help="milliseconds between samples, besides the ends of blocks; 20",
    )  # fmt: skip
    parser.add_argument(
        "--host", default="127.0.0.1", metavar="ADDRESS",
        help="serve OPC UA on this address, encrypted and for users only, unless it is this computer's own; 127.0.0.1",
    )  # fmt: skip
    parser.add_argument("--port", type=int, default=4840, help="port of OPC UA, 0: a free one; 4840")
    parser.add_argument(
        "--adapter-port",
        type=int,
        default=7878,
        metavar="PORT",
        help="port of the MTConnect adapter; 7878",
    )
    parser.add_argument("--no-mtconnect", action="store_true", help="serve OPC UA alone")
    parser.add_argument("--device-xml", metavar="FILE.xml", help="write the devices of an MTConnect agent, and end")
    parser.add_argument("--users", metavar="FILE", help="file of users; by default that in your folder for data")
    parser.add_argument(
        "--add-user", metavar="NAME", help="add a user, whose password is asked for or read from stdin, and end"
    )
    parser.add_argument(
        "--role", choices=("operator", "viewer"), default="operator",
        help="of the user who is added: operates the twin, or only looks; operator",
    )  # fmt: skip
