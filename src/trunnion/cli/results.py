"""Results on stdout."""

import json
import sys

from trunnion.errors import InputError, Problem


def print_result(*lines: str, end: str = "\n") -> None:
    """Print lines to stdout.

    Raises
    ------
    InputError
        If stdout takes no more, as on a disk that is full.
    BrokenPipeError
        If its reader has gone away.
    """
    try:
        print(*lines, sep="\n", end=end)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        what = f"cannot be written: {error.strerror or error}"
        raise InputError(Problem("stdout", 0, what, "let it go elsewhere")) from None


def as_json(value: object) -> str:
    """Data as text."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False, indent=1)
