"""Machining times in the text of a program: those of its proof, so that program and report agree.

In:     the files of a program that prints times, with a token for each; the times of the program as it was run.
Out:    the same files, with times in place of the tokens. Tokens stand in comments: nothing else changes.
"""

import re
from collections.abc import Sequence
from typing import BinaryIO, Final

from trunnion.files import OutputFiles
from trunnion.output.program import Program
from trunnion.output.template_values import (
    TIME_TOKEN_DIGITS,
    TIME_TOKEN_LETTERS,
    estimated_seconds,
    new_time_token,
    prints_times,
)
from trunnion.verification import Verification, durations
from trunnion.wording import format_duration

__all__ = ["new_time_token", "operation_times", "prints_times", "write_times"]

#: Bytes of a token: no time is longer.
_LENGTH: Final = TIME_TOKEN_LETTERS + TIME_TOKEN_DIGITS

#: Bytes that are read at once.
_PIECE: Final = 1 << 20


def operation_times(program: Program, verification: Verification | None) -> list[float]:
    """Return the seconds of each operation as the report has them; without a proof as they were planned."""
    if verification is None:
        return estimated_seconds(program)
    seconds, _ = durations(verification)
    return [float(seconds[rows.first : rows.end].sum()) for rows in verification.operations]


def write_times(files: OutputFiles, program: Program, seconds: Sequence[float]) -> None:
    """Write times in place of their tokens into all files of a program.

    seconds  of each operation, in their order; token 0 is the sum of all, token k the k-th
    """
    times = [sum(seconds), *seconds]
    capitals = program.effective_setting("comments") == "capitals"
    family = program.control.family
    colons = family.escape_comment(":") == ":"
    shown = [family.escape_comment(format_duration(time, colons)) for time in times]
    texts = [(text.upper() if capitals else text).encode() for text in shown]
    token = re.compile(program.time_token.encode() + rb"(\d{%d})" % TIME_TOKEN_DIGITS)
    for sink in files.sinks():
        _replace_tokens(sink, token, texts)


def _replace_tokens(sink: BinaryIO, token: re.Pattern[bytes], texts: Sequence[bytes]) -> None:
    """Replace tokens in place, piece by piece: no text is longer than its token."""
    read = write = 0
    while True:
        sink.seek(read)
        piece = sink.read(_PIECE) + sink.readline()
        if not piece:
            break
        read += len(piece)
        changed = token.sub(lambda match: texts[int(match[1])][:_LENGTH], piece)
        if write < read - len(piece) or changed is not piece:
            sink.seek(write)
            sink.write(changed)
        write += len(changed)
    sink.truncate(write)
    sink.seek(write)
