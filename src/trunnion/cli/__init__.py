"""The command line: the only place that prints, and that ends the process.

Results go to stdout, everything else to stderr. Exit 0: done. 1: understood, but the program must not run as it is.
2: input or usage error. An output file appears whole or not at all.
"""

import gc
import logging
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from trunnion.errors import InputError, RefusedError

#: Seconds for which one thread may keep another one from Python.
_SWITCH_INTERVAL = 0.0002


def configure_process() -> None:
    """Settle the interpreter for a run that does one thing and ends; before NumPy is imported.

    A run makes no garbage in circles: the collector stays off. NumPy's linear algebra here is of vectors of three:
    threads help nothing, and wait for more by turning round and round on the processors that the command's own two
    threads need. And who of these wants to go on in Python is not kept waiting for the usual 5 ms.
    """
    gc.disable()
    sys.setswitchinterval(_SWITCH_INTERVAL)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def run_and_exit() -> NoReturn:
    """The command of the shell: do it, and be gone.

    Taking the interpreter down piece by piece takes a fifth of the time that posting a small file does: the process
    ends as soon as everything is written.
    """
    configure_process()
    _show_log()
    code = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def _show_log() -> None:
    """Have what the package logs for its user, such as that kernels are being compiled, printed to stderr."""
    log = logging.getLogger("trunnion")
    log.addHandler(logging.StreamHandler())
    log.setLevel(logging.INFO)
    log.propagate = False


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    from trunnion.cli.arguments import parse_arguments

    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # Windows consoles and pipes do not speak UTF-8 by themselves
            stream.reconfigure(encoding="utf-8", errors="replace")
    arguments = parse_arguments(sys.argv[1:] if argv is None else argv)
    try:
        code: int = arguments.run(arguments)
    except RefusedError as refused:
        print(refused, file=sys.stderr)
        return 1
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    except BrokenPipeError:  # the reader of our output has gone away
        return 2
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 2
    return code
