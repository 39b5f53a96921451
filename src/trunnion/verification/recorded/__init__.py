"""A recording of the machine against the program: where it really was, and where the program wanted it.

``path`` is where the program goes, ``order`` says which block each position belongs to, ``nearest`` finds the place of
the path that is nearest to it, ``compared`` puts them together, and ``check`` judges.
"""

from trunnion.verification.recorded.check import check_recorded
from trunnion.verification.recorded.compared import RecordedComparison, compare_recording
from trunnion.verification.recorded.driven import by_program_rows

__all__ = ["RecordedComparison", "by_program_rows", "check_recorded", "compare_recording"]
