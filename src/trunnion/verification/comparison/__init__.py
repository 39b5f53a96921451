"""Two programs side by side: whether they make the tool do the same."""

from trunnion.verification.comparison.comparison import align, compare
from trunnion.verification.comparison.control_rules import ControlRules
from trunnion.verification.comparison.nominal_runs import cuts_by_place
from trunnion.verification.comparison.result import Alignment, Comparison, Difference

__all__ = ["Alignment", "Comparison", "ControlRules", "Difference", "align", "compare", "cuts_by_place"]
