"""The command line: the only place that prints, and that ends the process.

Results go to stdout, everything else to stderr. Exit 0: done. 1: understood, but the program must not run as it is.
2: input or usage error. An output file appears whole or not at all.
"""

import gc
import logging
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from importlib import import_module
from typing import TYPE_CHECKING, NoReturn

from trunnion.cli.printing import print_result
from trunnion.cli.process import Ended, end_cleanly, let_messages_go
from trunnion.errors import Problem, RefusedError, TrunnionError
from trunnion.messages import Wording
from trunnion.version import __version__

if TYPE_CHECKING:
    from trunnion.jobs.job import Given


def configure_process() -> None:
    """Keep NumPy's linear algebra to one thread, and have cycles collected seldom; call it before NumPy is imported.

    Trunnion multiplies vectors of three. OpenBLAS's idle threads spin on the processors that its own two threads need.
    Imports make a hundred thousand objects that stay: looking through them for cycles again and again takes a tenth of
    the post of 200 lines (0.17 of 1.58 s on the machine where this was measured). A run has next to no cycles.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(1_000_000)


def run_and_exit() -> NoReturn:
    """Run the command of the shell, and end the process.

    The process ends as soon as everything is written: taking the interpreter apart lengthens the post of 200 lines by a
    sixth (1.44 to 1.72 s on the machine where this was measured).
    """
    configure_process()
    end_cleanly()
    let_messages_go()
    _show_log()
    try:
        code = main()
    except SystemExit as end:  # of help, and of a command line that cannot be understood
        code = int(end.code or 0)
    try:
        sys.stdout.flush()
    except OSError as error:
        if code == 0 and not isinstance(error, BrokenPipeError):
            print(Problem("stdout", 0, Wording("FIL230", "stdout_broken", strerror=error.strerror)), file=sys.stderr)
        code = code or 2
    sys.stderr.flush()
    os._exit(code)


class SpokenLog(logging.Formatter):
    """Says what is logged in the language of the command."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line of a record."""
        match record.args:
            case (Wording() as wording,):
                from trunnion.cli.wording import spoken

                return record.msg % wording.text("what", spoken())
        return super().format(record)


def _show_log() -> None:
    """Have what the package logs for its user, such as that kernels are being compiled, printed to stderr."""
    log = logging.getLogger("trunnion")
    handler = logging.StreamHandler()
    handler.setFormatter(SpokenLog())
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    log.propagate = False


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    from trunnion.cli.command_line.language import follow_terminals, speaking, with_language

    follow_terminals()
    words, language = with_language(list(sys.argv[1:] if argv is None else argv))
    with speaking(language):
        return _run(words)


def _run(words: Sequence[str]) -> int:
    """Run one command in the language that is spoken; returns the exit code."""
    try:
        if words[:1] == ["--version"]:
            print_result(f"trunnion {__version__}")
            return 0
        from trunnion.cli.command_line.parser import parse
        from trunnion.cli.wording import speak_of

        given = parse(words)
        speak_of(given.job.name)
        code = _carry_out(given)
    except TrunnionError as error:
        from trunnion.cli.wording import error_lines

        print(error_lines(error), file=sys.stderr)
        return 1 if isinstance(error, RefusedError) else 2
    except BrokenPipeError:  # whatever reads the output has closed the pipe
        return 2
    except KeyboardInterrupt as stop:
        ended = stop.signal if isinstance(stop, Ended) else 0
        notes = getattr(stop, "__notes__", [])
        if notes or not ended:
            from trunnion.cli.wording import said

            print(": ".join([said("stopped"), *notes]), file=sys.stderr)
        return 128 + ended if ended else 2
    return code


def _carry_out(given: "Given") -> int:
    """Run a command, once it is known that it writes over nothing that it reads."""
    from trunnion.options.kinds import FileIn, FileOut
    from trunnion.options.option import outputs

    named = (
        each for each in given.job.options if isinstance(each.kind, FileIn | FileOut) or "FOLDER" in each.value_name
    )
    if any(given.values[each.name] for each in named):
        from trunnion.cli.stopped_jobs import settle_stopped_jobs

        settle_stopped_jobs(given)
    written = [each for each in outputs(given.job.options) if given.values[each.name] is not None]
    if written and not given.job.guards:
        from trunnion.jobs.guard import guard

        given.read = guard(given)
    elif any(isinstance(each.kind, FileOut) and not each.kind.ends_so(given.values[each.name]) for each in written):
        from trunnion.jobs.guard import check_names  # imports much that a command may want in another order

        check_names(given)
    if any(not each.kind.told for each in written if isinstance(each.kind, FileOut)):
        from trunnion.jobs.replaced_outputs import check_replaced

        check_replaced(given)
    module, _, name = given.job.run.partition(":")
    run: Callable[[Given], int] = getattr(import_module(module), name)
    with ExitStack() as around:
        if given.typed:
            from trunnion.jobs.inputs.settings import reported_as_arguments

            typed = {setting: option.name for setting, option in given.typed.items()}
            around.enter_context(reported_as_arguments(typed))
        if not given.job.goes_on:
            from trunnion.files import command_output

            around.enter_context(command_output())
        return run(given)
