"""The fields of a definition, by the names of the tables that they are in."""

from trunnion.builder.fields import fields_of, named_path, value_at
from trunnion.definitions.source_lines import locate_values

ROOT = locate_values({"axis": [{"home_mm": 1.0}, {"name": "X", "home_mm": 2.0}, {"name": "Y", "home_mm": 3.0}]}, "", {})


def test_a_value_is_that_of_the_table_with_the_name() -> None:
    assert named_path(ROOT, "axis[2].home_mm") == ("axis", ("Y",), "home_mm")
    found = [value_at(ROOT, ("axis", (name,), "home_mm")) for name in ("X", "Y", "", "Z")]
    assert [each and each.value for each in found] == [2.0, 3.0, None, None]


def test_a_setting_has_the_unit_of_its_rule() -> None:
    rules = {"operation_clearance": {"kind": "number", "unit": "mm"}, "rotary_tolerance": {"unit": "degrees"}}
    named = dict.fromkeys((*rules, "bore_lift", "title"), "1")
    root = locate_values({"control": {"settings": named, "setting_rules": rules}}, "", {})
    units = {each.path[-1]: each.unit for each in fields_of(root) if each.path[1:2] == ("settings",)}
    assert units == {"operation_clearance": "mm", "rotary_tolerance": "°", "bore_lift": "mm", "title": ""}
