"""All files that a command writes, one after the other, reach their places together when it ends."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

from trunnion.files.hidden_folders import HiddenFolders
from trunnion.files.interrupts import held_interrupts
from trunnion.files.moves import Moves, moving_alone
from trunnion.files.places import OutputPlace


class _CommandOutput:
    """Complete files that wait in hidden folders for the end of a command, and what is done afterwards."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Callable[[Moves], None], list[OutputPlace]]] = []
        self.folders: list[HiddenFolders] = []
        self.afterwards: list[Callable[[], None]] = []

    def publish(self) -> None:
        """Bring all files to their places."""
        if self.waiting:
            with moving_alone(place for _, places in self.waiting for place in places):
                moves = Moves()
                for bring, _ in self.waiting:
                    bring(moves)
                moves.carry_out()
        for each in self.afterwards:
            each()

    def remove(self) -> None:
        """Remove what has not reached its place."""
        for folders in self.folders:
            folders.is_waiting = False
            folders.remove()


#: What the command writes that is being carried out; None: each file appears when it is complete.
_COMMAND: Final[ContextVar[_CommandOutput | None]] = ContextVar("command_output", default=None)


@contextmanager
def command_output() -> Iterator[None]:
    """Files that are completed in this thread reach their places together when the block ends.

    So do those that are complete where it raises, such as the report of a refusal; not where it is interrupted.

    Raises ``InputError`` if a file cannot be written; all earlier files stay as they were then.
    """
    command = _CommandOutput()
    token = _COMMAND.set(command)
    # An interruption of the first removal leaves the second one to do it.
    try:
        try:
            try:
                yield
            except Exception:
                command.publish()
                raise
            command.publish()
        finally:
            _COMMAND.reset(token)
            command.remove()
    finally:
        command.remove()


@contextmanager
def output_at_once() -> Iterator[None]:
    """Let files appear as soon as they are complete, in a command that goes on until it is stopped."""
    token = _COMMAND.set(None)
    try:
        yield
    finally:
        _COMMAND.reset(token)


def move_together(
    bring: Callable[[Moves], None], places: Iterable[OutputPlace], folders: Iterable[HiddenFolders]
) -> None:
    """Bring complete files to their places: at once, or with all others of the command.

    bring    adds them to those that move
    places   theirs
    folders  in which they wait; they stay until the command ends, where it is that long

    Raises ``InputError`` if a file cannot be written.
    """
    command = _COMMAND.get()
    if command is not None:
        with held_interrupts():
            for each in folders:
                each.is_waiting = True
                command.folders.append(each)
            command.waiting.append((bring, list(places)))
        return
    with moving_alone(places):
        moves = Moves()
        bring(moves)
        moves.carry_out()


def once_in_place(function: Callable[[], None]) -> None:
    """Call a function when the files that were completed are in their places."""
    command = _COMMAND.get()
    if command is None:
        function()
    else:
        command.afterwards.append(function)
