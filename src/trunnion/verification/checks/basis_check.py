"""What is demanded that the proof stands on, and is not stated or not measured."""

from trunnion.messages import Wording
from trunnion.verification.basis import missing_demands
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.results import Check


def check_basis(context: Context) -> list[Check]:
    """Return whether all is stated that settings and the definition demand; nothing if they demand nothing."""
    machine = context.run.machine
    demands = {*context.settings.demands, *machine.demands}
    if not demands:
        return []
    assumes_unit = isinstance(context, ComparedContext) and context.expected.assumes_unit
    holds = context.settings.register_holds
    if missing := tuple(missing_demands(demands, context.run, holds, assumes_unit)):
        return [Check("basis", False, Wording("basis", "missing", missing=missing))]
    return [Check("basis", True, Wording("basis", "stated", demands=tuple(sorted(demands))))]
