"""The arguments of ``trunnion twin`` and ``trunnion record``."""

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


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"{text!r} is no time; write seconds above 0")
    return value


def add_machine_access(parser: argparse.ArgumentParser) -> None:
    """How a command connects to a machine."""
    parser.add_argument(
        "--nodes", default="cnc", metavar="NAME_OR_FILE",
        help="what is read: cnc (OPC 40502, such as a twin), sinumerik, heidenhain, or a file (.toml); cnc",
    )  # fmt: skip
    parser.add_argument(
        "--rate", type=milliseconds, default=20.0, metavar="MS", help="milliseconds between two looks of the server; 20"
    )
    parser.add_argument("--secure", action="store_true", help="sign and encrypt the channel")
    parser.add_argument("--trust", default="", metavar="FINGERPRINT", help="of the server's certificate; with --secure")
    parser.add_argument(
        "--user", default="", metavar="NAME", help="user at the machine; the password is asked for or read from stdin"
    )


def add_record(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``trunnion record``."""
    parser.add_argument("address", metavar="ADDRESS", help="of the machine's OPC UA server: opc.tcp://HOST:PORT/…")
    parser.add_argument(
        "--output", required=True, metavar="FILE", help="recording (.csv or .parquet); never written over"
    )
    parser.add_argument("--seconds", type=_seconds, metavar="N", help="how long; without it until Ctrl-C")
    add_machine_access(parser)
