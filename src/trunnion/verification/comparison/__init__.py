"""Two programs side by side: whether they make the tool do the same."""

from trunnion.verification.comparison.comparison import align, compare
from trunnion.verification.comparison.result import Alignment, Comparison, Difference

__all__ = ["Alignment", "Comparison", "Difference", "align", "compare"]
