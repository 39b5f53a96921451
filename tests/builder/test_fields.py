"""The fields of a definition, by the names of the tables that they are in."""

from trunnion.builder.fields import named_path, value_at
from trunnion.definitions.source_lines import locate_values

ROOT = locate_values({"axis": [{"home_mm": 1.0}, {"name": "X", "home_mm": 2.0}, {"name": "Y", "home_mm": 3.0}]}, "", {})


def test_a_value_is_that_of_the_table_with_the_name() -> None:
    assert named_path(ROOT, "axis[2].home_mm") == ("axis", ("Y",), "home_mm")
    found = [value_at(ROOT, ("axis", (name,), "home_mm")) for name in ("X", "Y", "", "Z")]
    assert [each and each.value for each in found] == [2.0, 3.0, None, None]
