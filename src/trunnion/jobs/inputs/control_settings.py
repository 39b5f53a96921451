"""What the definition of a machine's control says of its programs, whoever wrote them."""

from collections.abc import Mapping

from trunnion.compensation.stretches import RegisterValue
from trunnion.controls import Control, control_library, load_control
from trunnion.controls.vocabulary import RADIUS_REGISTER_SETTING
from trunnion.definitions import resolve_extends
from trunnion.errors import InputError
from trunnion.jobs.inputs.settings import Settings, as_texts
from trunnion.machines import Machine


def written_control(machine: Machine) -> Control | None:
    """Return the control of a machine; None where its programs can be read but not written.

    Raises ``InputError`` with the mistakes of one that has number formats: those of a control that is written.
    """
    try:
        return load_control(machine.control)
    except InputError:
        if "format" in resolve_extends(machine.control.unread_copy(), control_library()):
            raise
        return None


def default_settings(control: Control | None) -> Mapping[str, str]:
    """Return the settings of a control's definition; usual ones where its programs can be read but not written."""
    return control.settings if control else {"edge": "1"}


def blocks_in_compensation(machine: Machine) -> int:
    """Return how many blocks without motion a control reads across within radius compensation; unknown ones read 1."""
    control = written_control(machine)
    return control.blocks_in_compensation if control else 1


def greatest_feed(control: Control | None) -> float | None:
    """Return the largest F per minute that a control takes: no block need be faster; None: no limit is known."""
    return control.formats["feed"].five_axis.greatest if control else None


def rapid_feed_of(machine: Machine) -> float | None:
    """Return the feed at which lines are rapids on a machine, mm/min; None where rapids are written as rapids."""
    feed = default_settings(written_control(machine)).get("rapid_feed")
    return float(feed) if feed else None


def register_value(stated: str | None, settings: Settings | None, machine: Machine) -> RegisterValue:
    """Return what the registers of the radius hold: as is stated, as settings of a post say, or by the definition."""
    given = stated or as_texts(settings).get(RADIUS_REGISTER_SETTING)
    return RegisterValue(given) if given else register_value_of(machine)


def register_value_of(machine: Machine) -> RegisterValue:
    """Return what the registers of the radius hold on a machine, by its definition."""
    return RegisterValue(default_settings(written_control(machine)).get(RADIUS_REGISTER_SETTING, "unknown"))
