"""What points under CUTCOM are: those of the tool's centre, or of the contour, where the control adds the radius."""

from trunnion.cl.builder import StatedPoints
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class CutcomPoints:
    """What a file, or else its user, says of the points.

    asked  value of the setting ``cutcom``; None: nobody has given it
    said   the last that the file says; where it has sections, it counts within its operation only
    """

    asked: str | None = None
    said: StatedPoints | None = None

    def take(self, state: ReaderState, said: StatedPoints) -> None:
        """Take what the file says from here on."""
        self.said = state.builder.points = said

    def are_of_contour(self, state: ReaderState, statement: Statement, *, contact: bool) -> bool:
        """Return whether the points behind a CUTCOM are those of the contour; ``contact``: it says so itself.

        Raises ``StatementError`` if something else says otherwise.
        """
        claims = [(True, f"CUTCOM/{statement.listed()}")] if contact else []
        said = state.builder.points or (None if state.dialect.in_sections else self.said)
        if said is not None:
            claims.append((said.contour, said.words))
        if self.asked is not None:
            claims.append((self.asked == "contour", f"cutcom={self.asked}"))
        words = dict(claims)
        if len(words) > 1:
            raise StatementError(Wording("CL470", "points_contradicted", contour=words[True], centre=words[False]))
        return True in words
