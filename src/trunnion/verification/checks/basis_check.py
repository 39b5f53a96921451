"""What is demanded that the proof stands on, and is not stated or not measured."""

from trunnion.verification.basis import missing_demands
from trunnion.verification.context import Context
from trunnion.verification.results import Check

_KEY = "basis"
_TITLE = "what the proof must stand on"


def check_basis(context: Context) -> list[Check]:
    """Return whether all is stated that settings and the definition demand; nothing if they demand nothing."""
    machine = context.run.machine
    demands = {*context.settings.demands, *machine.demands}
    if not demands:
        return []
    if missing := list(missing_demands(demands, context.run, context.settings.register_holds)):
        return [Check(_KEY, _TITLE, False, "; ".join(wording.what for wording in missing))]
    return [Check(_KEY, _TITLE, True, f"stated: {', '.join(sorted(demands))}")]
