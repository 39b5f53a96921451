"""What is demanded that the proof stands on, and is not stated or not measured."""

from trunnion.messages import Wording
from trunnion.verification.basis import missing_demands
from trunnion.verification.context import Context
from trunnion.verification.results import Check


def check_basis(context: Context) -> list[Check]:
    """Return whether all is stated that settings and the definition demand; nothing if they demand nothing."""
    machine = context.run.machine
    demands = {*context.settings.demands, *machine.demands}
    if not demands:
        return []
    if missing := tuple(missing_demands(demands, context.run, context.settings.register_holds)):
        return [Check("basis", False, Wording("basis", "missing", missing=missing))]
    return [Check("basis", True, Wording("basis", "stated", demands=tuple(sorted(demands))))]
