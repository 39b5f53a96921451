"""Errors of readers that say by a wording why a block, a cycle or a curve is not executed."""

from trunnion.messages import Wording


class WordedError(Exception):
    """A reason that is said by a wording; what reports it may put another sentence around it."""

    def __init__(self, wording: Wording) -> None:
        super().__init__(wording)
        self.wording = wording

    @property
    def code(self) -> str:
        """The code of the reason."""
        return self.wording.code
