"""Files of hooks: Python that a user names, run once for its functions.

In:     paths.
Out:    the functions of each file; what is wrong with one, at its line.
"""

import inspect
import sys
import types
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from pathlib import Path
from typing import Final

from trunnion.controls.places import OUTPUT_PLACES
from trunnion.definitions.messages import meant_word
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: The functions that a file of hooks may have, and what each is called with.
_FUNCTIONS: Final = {
    "on_operation": ("operation", "context"),
    "on_event": ("event", "context"),
    "on_block": ("block", "context"),
    **{place.function: ("place",) for place in OUTPUT_PLACES if place.function},
}

#: Those that change what the CL file asks for.
_OF_PATHS: Final = tuple(name for name in _FUNCTIONS if name.startswith("on_"))

#: What their names begin with.
_BEGINNINGS: Final = ("on_", "at_")

_MODULE: Final = "trunnion_hooks"


@dataclass(frozen=True, slots=True, eq=False)
class HookFile:
    """A file of hooks that has been run: its functions by name."""

    path: Path
    functions: dict[str, Callable[..., object]]

    def line_of(self, name: str) -> int:
        """Return the line of a function, 0 if it is not in the file."""
        code = getattr(self.functions[name], "__code__", None)
        return code.co_firstlineno if code is not None and code.co_filename == str(self.path) else 0


def load_hooks(paths: Iterable[Path]) -> tuple[HookFile, ...]:
    """Run files of hooks, in their order.

    Raises ``InputError`` if a file is none, fails, or has no hooks, at its line.
    """
    return tuple(_load(path) for path in paths)


def _load(path: Path) -> HookFile:
    problem = unusable_file(path, phrase("file_of_hooks"))
    if problem is None and path.suffix != ".py":
        problem = Problem(str(path), 0, Wording("HOK110", "no_python_file"))
    if problem is not None:
        raise InputError(problem)
    module = types.ModuleType(_MODULE)
    module.__file__ = str(path)
    try:
        with redirect_stdout(sys.stderr):
            exec(compile(path.read_text(encoding="utf-8-sig"), str(path), "exec"), module.__dict__)
    except (Exception, SystemExit) as error:
        raise InputError(failure(path, error, Wording("HOK120", "file_fails", error=_said(error)))) from error
    named = {name: value for name, value in vars(module).items() if name.startswith(_BEGINNINGS) and callable(value)}
    for name, function in named.items():
        if name not in _FUNCTIONS:
            line = getattr(getattr(function, "__code__", None), "co_firstlineno", 0)
            near = meant_word(name, _FUNCTIONS)
            wording = (
                Wording("HOK110", "no_hook_but_near", name=name, near=near)
                if near
                else Wording("HOK110", "no_hook", name=name, known=tuple(_FUNCTIONS))
            )
            raise InputError(Problem(str(path), line, wording))
        _check_signature(path, name, function)
    if not named:
        wording = Wording("HOK110", "file_no_hooks", functions=_OF_PATHS, place="at_tool_change")
        raise InputError(Problem(str(path), 0, wording))
    return HookFile(path, {name: named[name] for name in _FUNCTIONS if name in named})


def _check_signature(path: Path, name: str, function: Callable[..., object]) -> None:
    try:
        inspect.signature(function).bind(*_FUNCTIONS[name])
    except (TypeError, ValueError):
        line = getattr(getattr(function, "__code__", None), "co_firstlineno", 0)
        raise InputError(
            Problem(
                str(path),
                line,
                Wording("HOK110", "takes_other_arguments", name=name, functions=tuple(_FUNCTIONS[name])),
            )
        ) from None


def failure(path: Path, error: BaseException, wording: Wording) -> Problem:
    """Return the problem that an exception is, at the line of the file where it came about."""
    line, trace = 0, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == str(path):
            line = trace.tb_lineno
        trace = trace.tb_next
    if isinstance(error, SyntaxError) and error.filename == str(path):
        line = error.lineno or 0
    return Problem(str(path), line, wording)


def _said(error: BaseException) -> str:
    """Return what an exception says, in a line."""
    text = str(error).splitlines()
    return f"{type(error).__name__}: {text[0]}" if text else type(error).__name__


def function_failure(path: Path, error: BaseException, name: str, operation: str) -> Problem:
    """Return the problem that an exception of a function for an operation is, as ``failure``."""
    wording = Wording("HOK120", "function_fails", name=name, operation=operation, error=_said(error))
    return failure(path, error, wording)
