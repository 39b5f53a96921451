"""Rotary axes of a SINUMERIK 840D sl: the data of TRAORI, and the swivel data of CYCLE800 (a tool carrier).

In:     machine data ``$MC_TRAFO5_…_1`` and system variables ``$TC_CARR1`` to ``$TC_CARR65``.
Out:    lines of rotation under the keys of a definition, what is not taken, and which rotary axis carries what.
Units:  mm and degrees. Vectors are in machine coordinates with all axes at zero, from the gauge point, which is the
        zero of the frame here.

As Siemens's manuals of commissioning have it. Kinds are T (two axes in the head), P (two tables) and M (one of each,
the first in the head); the first axis carries the second. Offsets go

    T   I3 from the gauge point to the second axis, I2 from there to the first, I1 = -(I2 + I3)
    P   I2 from the reference point of the machine to the first axis, I3 from there to the second, I4 = -(I2 + I3)
    M   I2 from the gauge point to the first axis, I1 = -I2; I3 from the reference point to the second, I4 = -I3

and vectors V1, V2 are right-handed about the motion of what really moves, so that those of tables are the other way
round than ISO 841 counts. TRAORI has the same vectors under other names for its types 24, 40 and 56; type 72 takes
those of a tool carrier.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from typing import Final, TypeAlias

from trunnion.foreign.machine import Key, Left, Stated, because, index, not_taken, number
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Machine data and system variables: name and index -> value.
Data: TypeAlias = Mapping[tuple[str, str], Stated]

#: Kinds of kinematics -> what the first and the second axis carry.
MOUNTS: Final = {"T": ("tool", "tool"), "P": ("part", "part"), "M": ("tool", "part")}

#: Types of the transformation (24100) -> the kind; only the generic ones (24, 40, 56) have the vectors of a carrier.
TYPES: Final = (
    dict.fromkeys((16, 18, 20, 21, 24), "T")
    | dict.fromkeys((32, 33, 34, 35, 40), "P")
    | dict.fromkeys((48, 49, 50, 51, 56), "M")
)
_GENERIC: Final = (24, 40, 56)
OF_CARRIER: Final = 72

#: Offsets of each kind -> the machine data that have them.
_OFFSETS: Final = {
    "T": {1: "PART_OFFSET", 2: "JOINT_OFFSET", 3: "BASE_TOOL"},
    "P": {2: "BASE_TOOL", 3: "JOINT_OFFSET", 4: "PART_OFFSET"},
    "M": {1: "JOINT_OFFSET", 2: "BASE_TOOL", 3: "JOINT_OFFSET_PART", 4: "PART_OFFSET"},
}

#: Kinds -> offsets whose sum is the place of the first and of the second axis, and the sums that are zero.
_PLACES: Final = {"T": ((3, 2), (3,)), "P": ((2,), (2, 3)), "M": ((2,), (3,))}
_CLOSED: Final = {"T": ((1, 2, 3),), "P": ((2, 3, 4),), "M": ((1, 2), (3, 4))}

#: Offset -> the first of its three variables, and the first of its fine offsets.
_OF_TC_CARR: Final = {1: (1, 41), 2: (4, 44), 3: (15, 55), 4: (18, 58)}

#: Variables of a tool carrier that no definition takes: first, last, why (texts of the catalogue ``foreign``).
_NOT_TAKEN: Final = (
    (13, 14, "angle_set_by_hand"),
    (24, 25, "zero_position"),
    (26, 29, "no_hirth"),
    (34, 40, "names_the_data"),
    (41, 60, "fine_offset"),
    (61, 63, "meaning_unknown"),
    (64, 65, "fine_offset_of_angle"),
)

#: Chains that are closed to this, mm.
_CLOSES: Final = 1e-6


@dataclass(slots=True)
class Chain:
    """What the data say of two rotary axes; ``order`` goes from the first to the second, with what each carries."""

    order: tuple[tuple[str, str], ...] = ()
    values: dict[Key, Stated] = field(default_factory=dict)
    left: list[Left] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class _Source:
    """Vectors by their numbers, from one kind of data: ``offsets`` I1 to I4, ``axes`` V1 and V2."""

    name: Wording
    kind: str
    offsets: Mapping[int, Stated]
    axes: Mapping[int, Stated]


def chain_of(data: Data, names: Mapping[int, str]) -> Chain:
    """Return the two rotary axes of a channel: those of TRAORI count before those of the swivel data."""
    chain = Chain()
    kind = data.get(("TRAFO_TYPE_1", ""))
    kind_number = 0 if kind is None else index(kind.value) or 0
    carrier, others = _carriers(data, kind_number == OF_CARRIER)
    if kind is not None and kind_number not in TYPES and kind_number != OF_CARRIER:
        chain.left.append(not_taken(kind, because("no_five_axes")))
    if kind_number in TYPES and len(axes := _transformed(data)) == 2 and all(axis in names for axis in axes):
        mounts = MOUNTS[TYPES[kind_number]]
        chain.order = ((names[axes[0]], mounts[0]), (names[axes[1]], mounts[1]))
    if not chain.order:
        chain.order = _order_of_carrier(data, names, carrier)
    traori = _of_traori(data, kind_number, chain.left)
    swivel = _of_carrier(data, carrier, chain.left)
    for source in (traori, swivel):
        if source is not None:
            _take(source, chain)
    if carrier:
        _take_limits(data, carrier, chain)
        chain.left += _left_of_carrier(data, carrier, chain)
    for other in others:
        count = sum(1 for name, row in data if name.startswith("TC_CARR") and row == other)
        place = _first_of(data, other)
        values = because("values_of_swivel_data", count=count, carrier=other)
        chain.left.append(Left(values, place.place, because("other_data_count", carrier=carrier)))
    return chain


def _carriers(data: Data, by_transformation: bool) -> tuple[str, list[str]]:
    """Return the number of the tool carrier that counts, and the others: that of type 72, else the first."""
    found = list(dict.fromkeys(row for name, row in data if name.startswith("TC_CARR")))
    named = data.get(("TRAFO5_TCARR_NO_1", ""))
    if by_transformation and named is not None and str(named.value) in found:
        first = str(named.value)
    else:
        first = min(found, key=lambda row: (index(row) is None, index(row) or 0, row), default="")
    return first, [row for row in found if row != first]


def _first_of(data: Data, carrier: str) -> Stated:
    """Return the first value of a tool carrier."""
    return next(value for (name, row), value in data.items() if name.startswith("TC_CARR") and row == carrier)


def _transformed(data: Data) -> list[int]:
    """Return the numbers of the two rotary axes of the first transformation, as its data have them."""
    found = []
    for place in ("3", "4"):
        channel = data.get(("TRAFO_AXES_IN_1", place))
        row = 0 if channel is None else index(channel.value) or 0
        used = data.get(("AXCONF_MACHAX_USED", str(row - 1)))
        if used is not None and (axis := index(used.value)):
            found.append(axis)
    return found if len(set(found)) == 2 else []


def _order_of_carrier(data: Data, names: Mapping[int, str], carrier: str) -> tuple[tuple[str, str], ...]:
    """Return the axes that the swivel data name (21 and 22, else 35 and 36), with what they carry."""
    kind = data.get(("TC_CARR23", carrier))
    if kind is None or str(kind.value).upper() not in MOUNTS:
        return ()
    found = []
    for own, user in ((21, 35), (22, 36)):
        stated = [data.get((f"TC_CARR{each}", carrier)) for each in (own, user)]
        called = [_axis_name(str(each.value), names) for each in stated if each is not None]
        found.append(next((name for name in called if name), ""))
    if not all(found) or found[0] == found[1]:
        return ()
    return tuple(zip(found, MOUNTS[str(kind.value).upper()], strict=True))


def _axis_name(text: str, names: Mapping[int, str]) -> str:
    """Return how a definition calls an axis: ``AX4`` by its number, ``B1`` and ``B`` by their letter."""
    text = text.upper()
    if text.startswith("AX") and (row := index(text[2:])) is not None:
        return names.get(row, "")
    short = text[:1] if len(text) == 2 and text.endswith("1") else text
    return short if short in names.values() or (len(short) == 1 and short in "ABC") else ""


def _of_traori(data: Data, kind: int, left: list[Left]) -> _Source | None:
    if kind not in _GENERIC:
        for (name, _), value in data.items():
            if name.removesuffix("_1") in _OF_TRAORI:
                left.append(not_taken(value, because("generic_types_alone")))
        return None
    offsets = {
        which: found
        for which, name in _OFFSETS[TYPES[kind]].items()
        if (found := _vector(data, [(f"TRAFO5_{name}_1", str(k)) for k in range(3)], left))
    }
    axes = {
        which: found
        for which in (1, 2)
        if (found := _vector(data, [(f"TRAFO5_AXIS{which}_1", str(k)) for k in range(3)], left))
    }
    used = {f"TRAFO5_{name}" for name in _OFFSETS[TYPES[kind]].values()} | {"TRAFO5_AXIS1", "TRAFO5_AXIS2"}
    for (name, _), value in data.items():
        if name.removesuffix("_1") in set(_OF_TRAORI) - used:
            left.append(not_taken(value, because("type_without_it", kind=kind)))
    return _Source(because("of_traori"), TYPES[kind], offsets, axes)


_OF_TRAORI: Final = (
    "TRAFO5_PART_OFFSET", "TRAFO5_JOINT_OFFSET", "TRAFO5_JOINT_OFFSET_PART", "TRAFO5_BASE_TOOL", "TRAFO5_AXIS1",
    "TRAFO5_AXIS2",
)  # fmt: skip


def _of_carrier(data: Data, carrier: str, left: list[Left]) -> _Source | None:
    kind = data.get(("TC_CARR23", carrier))
    if not carrier:
        return None
    if kind is None or str(kind.value).upper() not in MOUNTS:
        place = _first_of(data, carrier)
        vectors = because("vectors_of_swivel_data", carrier=carrier)
        left.append(Left(vectors, (kind or place).place, because("head_or_table_unknown")))
        return None
    offsets = {
        which: found
        for which, (first, _) in _OF_TC_CARR.items()
        if (found := _vector(data, [(f"TC_CARR{first + k}", carrier) for k in range(3)], left))
    }
    axes = {
        which: found
        for which, first in ((1, 7), (2, 10))
        if (found := _vector(data, [(f"TC_CARR{first + k}", carrier) for k in range(3)], left))
    }
    return _Source(because("of_swivel_data", carrier=carrier), str(kind.value).upper(), offsets, axes)


def _vector(data: Data, keys: Sequence[tuple[str, str]], left: list[Left]) -> Stated | None:
    """Return three components, of which those that are not in the file are 0; None if none is there, or one is no
    number.
    """
    found = [data.get(key) for key in keys]
    first = next((each for each in found if each is not None), None)
    if first is None:
        return None
    components = [0.0 if each is None else number(each.value) for each in found]
    if None in components:
        bad = next(each for each in found if each is not None and number(each.value) is None)
        left.append(not_taken(bad, because("no_number_in_vector")))
        return None
    return first.as_value(components)


def _take(source: _Source, chain: Chain) -> None:
    """Put the lines of rotation under the keys of a definition; what was taken before counts."""
    if len(chain.order) != 2 or tuple(mount for _, mount in chain.order) != MOUNTS[source.kind]:
        for value in (*source.offsets.values(), *source.axes.values()):
            chain.left.append(not_taken(value, because("kind_does_not_fit", kind=source.kind, source=source.name)))
        return
    for which, (name, mount) in enumerate(chain.order, 1):
        if (vector := source.axes.get(which)) and (size := math.hypot(*vector.value)) > 0.0:
            turned = [(-each if mount == "part" else each) / size + 0.0 for each in vector.value]
            is_back = sum(turned) < 0.0
            line = [-each + 0.0 if is_back else each for each in turned]
            _keep(chain, ("axis", name, "direction"), vector.as_value(line))
            _keep(chain, ("axis", name, "positive"), vector.as_value("reversed" if is_back else "standard"))
        elif vector is not None:
            chain.left.append(not_taken(vector, because("vector_without_length")))
        terms = [source.offsets[each] for each in _PLACES[source.kind][which - 1] if each in source.offsets]
        for each in _PLACES[source.kind][which - 1] if terms else ():
            if each not in source.offsets:
                offset = because("offset_of", offset=f"I{each}", source=source.name)
                chain.left.append(Left(offset, terms[0].place, because("counts_as_zero", axis=name)))
        if terms:
            place = [sum(each.value[k] for each in terms) for k in range(3)]
            _keep(chain, ("axis", name, "point_mm"), terms[-1].as_value(place))
            chain.values.setdefault(("spindle", "gauge_point_mm"), terms[0].as_value([0.0, 0.0, 0.0]))
    for closed in _CLOSED[source.kind]:
        terms = [source.offsets[each] for each in closed if each in source.offsets]
        rest = [sum(each.value[k] for each in terms) for k in range(3)]
        if len(terms) == len(closed) and math.hypot(*rest) > _CLOSES:
            sums = " + ".join(f"I{each}" for each in closed)
            found = because("offset_of", offset=f"{sums} = {rest}", source=source.name)
            chain.left.append(Left(found, terms[-1].place, because("chain_not_closed")))


def _keep(chain: Chain, key: Key, value: Stated) -> None:
    known = chain.values.setdefault(key, value)
    if known is not value and not _is_same(known.value, value.value):
        why = because("other_has", name=known.name, value=str(known.value), place=known.place)
        chain.left.append(Left(of_value(key, value), value.place, why))


def of_value(key: Key, value: Stated) -> Wording:
    """Return a value under its key, and of what it is."""
    return because("value_of", key=".".join(key), value=str(value.value), name=value.name)


def _is_same(one: object, other: object) -> bool:
    if isinstance(one, list) and isinstance(other, list):
        return all(math.isclose(a, b, abs_tol=_CLOSES) for a, b in zip(one, other, strict=True))
    return one == other


def _take_limits(data: Data, carrier: str, chain: Chain) -> None:
    """Take the angular ranges; those that are both zero do not count."""
    for which, (name, _) in enumerate(chain.order):
        low, high = (data.get((f"TC_CARR{first + which}", carrier)) for first in (30, 32))
        ends = [number(each.value) if each is not None else 0.0 for each in (low, high)]
        at = low or high
        if at is None or ends == [0.0, 0.0]:
            continue
        if None in ends or not (ends[0] or 0.0) < (ends[1] or 0.0):
            ends_said = because("axis_from_to", name=at.name, axis=name, low=str(ends[0]), high=str(ends[1]))
            chain.left.append(Left(ends_said, at.place, because("no_range")))
        else:
            chain.values[("axis", name, "limits_deg")] = at.as_value(ends)


def _left_of_carrier(data: Data, carrier: str, chain: Chain) -> Iterator[Left]:
    """Yield what no definition takes of the swivel data; values that are zero or empty in one line."""
    nothing: list[Stated] = []
    for first, last, why in _NOT_TAKEN:
        for variable in range(first, last + 1):
            value = data.get((f"TC_CARR{variable}", carrier))
            if value is not None and (number(value.value) == 0.0 or not str(value.value)):
                nothing.append(value)
            elif value is not None:
                yield not_taken(value, because(why))
    if nothing:
        values = because("values_of_swivel_data", count=len(nothing), carrier=carrier)
        yield Left(values, nothing[0].place, because("zero_or_empty"))
    if not chain.order:
        at = _first_of(data, carrier)
        yield Left(because("axes_of_swivel_data", carrier=carrier), at.place, because("no_two_axes_named"))
