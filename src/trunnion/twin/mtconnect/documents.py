"""The documents of an agent: what the device is, what it showed, and why a request is refused (MTConnect 2.0)."""

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from datetime import datetime
from typing import Final
from xml.sax.saxutils import escape, quoteattr

from trunnion.records import dataclass
from trunnion.twin.mtconnect.buffer import Observation, ObservationBuffer
from trunnion.twin.mtconnect.observations import UNAVAILABLE, shown_number, stamp_text
from trunnion.twin.mtconnect.request_errors import RequestError
from trunnion.twin.mtconnect.shdr import shown_text

VERSION: Final = "2.0"

#: Groups of a component's stream, in their order, by the category of the items.
_GROUPS: Final = {"SAMPLE": "Samples", "EVENT": "Events", "CONDITION": "Condition"}

#: There are none; the schema has room for one at least.
_NO_ASSETS: Final = {"assetBufferSize": "1", "assetCount": "0"}

#: Factors from the units in which a machine shows a value to those of the standard.
_FACTORS: Final = {("MILLIMETER/MINUTE", "MILLIMETER/SECOND"): 1.0 / 60.0}


@dataclass(frozen=True, slots=True)
class _Item:
    """How a data item is written: its component, its group, its element, attributes, and the factor of its units."""

    component: str
    group: str
    element: str
    attributes: str
    factor: float


class Documents:
    """Writes the documents of one agent.

    device    its device model
    buffer    its observations
    sender    where it is served
    begun     when it began: this tells its runs apart
    """

    def __init__(self, device: ET.Element, buffer: ObservationBuffer, sender: str, begun: datetime) -> None:
        self._device, self._buffer = device, buffer
        self._head = {"instanceId": str(int(begun.timestamp())), "version": f"{VERSION}.0.0", "sender": sender}
        self._size, self._model = {"bufferSize": str(buffer.size)}, {"deviceModelChangeTime": stamp_text(begun)}
        self._components: dict[str, str] = {}
        self._items: dict[str, _Item] = {}
        for component in device.iter():
            items = component.findall("DataItems/DataItem")
            if items:
                key = component.get("id", "")
                names = _attributes({name: component.get(name, "") for name in ("name", "nativeName")})
                self._components[key] = f'<ComponentStream component="{component.tag}"{names} componentId="{key}">'
                self._items |= {item.get("name", ""): _item(key, item) for item in items}

    def devices(self, now: datetime) -> bytes:
        """Return the document of the device."""
        body = ET.tostring(self._device, encoding="unicode")
        return self._document("Devices", now, self._size | _NO_ASSETS | self._model, f"<Devices>{body}</Devices>")

    def assets(self, now: datetime) -> bytes:
        """Return the document of the assets: there are none."""
        return self._document("Assets", now, _NO_ASSETS | self._model, "<Assets/>")

    def streams(self, now: datetime, observations: Iterable[Observation], next_sequence: int) -> bytes:
        """Return the document of observations; a reader goes on with the next sequence number."""
        groups: dict[str, dict[str, list[str]]] = {key: {} for key in self._components}
        for observation in observations:
            item = self._items[observation.key]
            groups[item.component].setdefault(item.group, []).append(_written(item, observation))
        streams = [
            head + "".join(f"<{name}>{''.join(of[name])}</{name}>" for name in _GROUPS.values() if name in of)
            + "</ComponentStream>"
            for key, head in self._components.items()
            if (of := groups[key])
        ]  # fmt: skip
        device = _attributes({"name": self._device.get("name", ""), "uuid": self._device.get("uuid", "")})
        body = f"<DeviceStream{device}>{''.join(streams)}</DeviceStream>" if streams else ""
        sequences = {
            "firstSequence": str(self._buffer.first), "lastSequence": str(self._buffer.last),
            "nextSequence": str(next_sequence),
        }  # fmt: skip
        return self._document("Streams", now, self._size | self._model | sequences, f"<Streams>{body}</Streams>")

    def error(self, now: datetime, refusal: RequestError) -> bytes:
        """Return the document that says why a request is refused."""
        text = escape(shown_text(refusal.text))
        return self._document(
            "Error", now, self._size, f'<Errors><Error errorCode="{refusal.code}">{text}</Error></Errors>'
        )

    def _document(self, kind: str, now: datetime, further: dict[str, str], body: str) -> bytes:
        name, space = f"MTConnect{kind}", f"urn:mtconnect.org:MTConnect{kind}:{VERSION}"
        schema = f"{space} http://schemas.mtconnect.org/schemas/{name}_{VERSION}.xsd"
        root = _attributes(
            {"xmlns": space, "xmlns:xsi": "http://www.w3.org/2001/XMLSchema-instance", "xsi:schemaLocation": schema}
        )
        head = _attributes({"creationTime": stamp_text(now), **self._head, **further})
        return f'<?xml version="1.0" encoding="UTF-8"?>\n<{name}{root}><Header{head}/>{body}</{name}>\n'.encode()


def _item(component: str, item: ET.Element) -> _Item:
    kind, category = item.get("type", ""), item.get("category", "")
    element = "".join(word.capitalize() for word in kind.split("_"))
    names = {"dataItemId": item.get("id", ""), "name": item.get("name", ""), "subType": item.get("subType", "")}
    if category == "CONDITION":
        names["type"] = kind
    if kind in ("ASSET_CHANGED", "ASSET_REMOVED"):
        names["assetType"] = UNAVAILABLE
    factor = _FACTORS.get((item.get("nativeUnits", ""), item.get("units", "")), 1.0)
    return _Item(component, _GROUPS[category], element, _attributes(names), factor)


def _written(item: _Item, observation: Observation) -> str:
    """Return the element of an observation."""
    place = f' sequence="{observation.sequence}" timestamp="{stamp_text(observation.time)}"'
    value = observation.value
    if isinstance(value, str):
        shown = shown_text(value)
        if item.factor != 1.0 and shown != UNAVAILABLE:
            shown = shown_number(float(shown) * item.factor)
        return f"<{item.element}{item.attributes}{place}>{escape(shown)}</{item.element}>"
    level, code, severity, qualifier, text = value
    told = _attributes({"nativeCode": code, "nativeSeverity": severity, "qualifier": qualifier})
    element = level.capitalize()
    return f"<{element}{item.attributes}{told}{place}>{escape(shown_text(text))}</{element}>"


def _attributes(values: dict[str, str]) -> str:
    """Return attributes as they are written; those without a value are not."""
    return "".join(f" {name}={quoteattr(shown_text(value))}" for name, value in values.items() if value)
