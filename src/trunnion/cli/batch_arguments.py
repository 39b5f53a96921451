"""The arguments of ``trunnion batch``."""

import argparse


def _whole(text: str) -> int:
    if not text.isascii() or not text.isdigit() or not 1 <= int(text[:6]) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of workers; write one from 1 to 1024")
    return int(text)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value <= 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is no time; write seconds, such as 600")
    return value


def add_batch(parser: argparse.ArgumentParser) -> None:
    """Add all but the settings, which other commands have too."""
    parser.add_argument("jobs", metavar="JOBS.toml|FOLDER", help="file of jobs, which states what is done; or a folder")
    parser.add_argument(
        "--results", metavar="FOLDER|URL", help="where results go: a folder, or an address such as s3://bucket/folder"
    )
    parser.add_argument(
        "--summary", metavar="FILE", help="a table of all files with their figures: .sqlite or .parquet"
    )
    parser.add_argument(
        "--workers", type=_whole, metavar="N", help="processes; by default as many as there are processors"
    )
    parser.add_argument(
        "--timeout", type=_seconds, metavar="SECONDS", help="how long a file may take; by default any time"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="let the workers of Dask do it: tcp://HOST:PORT or tls://"
    )
    parser.add_argument(
        "--wait", type=_seconds, metavar="SECONDS", help="end if the scheduler is without workers for so long"
    )
    parser.add_argument("--tls-ca", metavar="FILE", help="certificate of the authority, for tls://")
    parser.add_argument("--tls-cert", metavar="FILE", help="certificate of this computer")
    parser.add_argument("--tls-key", metavar="FILE", help="its key")
    folder = parser.add_argument_group("for a folder")
    folder.add_argument("--action", choices=("post", "convert", "verify", "simulate"), help="what is done")
    folder.add_argument("--machine", metavar="NAME_OR_FILE", help="machine of the programs")
    folder.add_argument(
        "--files", action="append", default=[], metavar="PATTERN",
        help="names of the files, such as '**/*.nc'; may be repeated",
    )  # fmt: skip
    into = folder.add_mutually_exclusive_group()
    into.add_argument("--to-machine", metavar="NAME_OR_FILE", help="convert: machine of the new programs")
    into.add_argument("--to-cl", action="store_true", help="convert: write CL files")
    folder.add_argument(
        "--cl", action="append", default=[], metavar="NAME",
        help="verify: CL file of each program, such as '{folder}/{stem}.cls'; may be repeated",
    )  # fmt: skip
    folder.add_argument("--stock", metavar="STOCK", help="simulate: as trunnion simulate has it")
    folder.add_argument(
        "--tool", action="append", default=[], metavar="N=KIND:SIZES", dest="tools", help="simulate: a tool"
    )
    folder.add_argument(
        "--tiles", metavar="N", help="simulate: tasks among which each simulation is divided; by default one"
    )
    folder.add_argument("--report", choices=("html", "json"), help="a report of each file")
