"""Two programs side by side: whether they make the tool do the same."""

from trunnion.verification.comparison.comparison import compare
from trunnion.verification.comparison.result import Comparison, Difference

__all__ = ["Comparison", "Difference", "compare"]
