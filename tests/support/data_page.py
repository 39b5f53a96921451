"""The page of all data of results, made of their records; run as a module, this writes it."""

import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any, Final, get_args

from tests.support.locations import DOCS
from trunnion.capability.reach import Reach
from trunnion.capability.sensitivity import Sensitivity
from trunnion.errors import Problem
from trunnion.formulas.description import Kinematics
from trunnion.geometry.fitting import CurveFit
from trunnion.jobs.capability.fitting import MachineFit
from trunnion.jobs.convert.result import ConvertResult
from trunnion.jobs.describe.cl_files import ClDescription
from trunnion.jobs.impeller.cut import ImpellerCut
from trunnion.jobs.post.papers.manifests import ManifestCheck
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.placing.placement import Placement
from trunnion.reporting.setup_sheet import SetupSheet
from trunnion.results import KeyFigure, figures_of
from trunnion.survey.result import Survey
from trunnion.verification.comparison.result import Comparison

PAGE: Final = DOCS / "data.md"

#: The data of each command: its title, where its records are, and their class.
DOCUMENTS: Final = (
    ("trunnion place --json", "", Placement),
    ("trunnion simulate --json", "", SimulationResult),
    ("trunnion reach --json", "", Reach),
    ("trunnion sensitivity --json", "", Sensitivity),
    ("trunnion kinematics --json", "", Kinematics),
    ("trunnion fit --json", "machines[]", MachineFit),
    ("trunnion info --json", "", ClDescription),
    ("trunnion curve --json", "curves[]", CurveFit),
    ("trunnion impeller cut --json", "", ImpellerCut),
    ("trunnion post --json", "programs[]", PostResult),
    ("trunnion convert --json", "", ConvertResult),
    ("trunnion diff --json", "", Comparison),
    ("trunnion verify MANIFEST --json", "", ManifestCheck),
    ("trunnion survey --json", "", Survey),
    ("--sheet FILE.json", "", SetupSheet),
)

_HEAD: Final = """# Results as data

Every key of the data that commands give, made from the records of the library by the tests. `[]` stands for each item
of a list, and a dot for a key within another. Lengths are in mm, angles in degrees, volumes in mm³ and times in seconds
unless the key says otherwise. There is no `NaN` and no infinity: `null` stands where there is no value. `remarks` have
[the same keys everywhere](codes.md#messages-in-data). A number of `schema` rises when programs that read older data
would be misled. [Reports](report.md#the-data) have a page of their own.
"""

#: A line of a record's docstring that explains fields, and one that goes on.
_MEANING: Final = re.compile(r"    ((?:[a-z_]+, )*[a-z_]+) {1,}(\S.*)")
_NEXT: Final = re.compile(r"     +(\S.*)")


def page() -> str:
    """The page of the docs."""
    text = _HEAD
    for title, place, kind in DOCUMENTS:
        schema = getattr(kind, "SCHEMA", None)
        text += f"\n## `{title}`\n\n| key | meaning |\n| --- | --- |\n"
        text += "" if schema is None else f"| `schema` | {schema} |\n"
        text += "".join(_rows(kind, f"{place}." if place else "", _others(kind), {}))
    return text


def _others(kind: type) -> dict[type, str]:
    """Where the keys of other documents are shown."""
    return {other: title for title, _, other in DOCUMENTS if other is not kind}


def meanings(kind: type) -> dict[str, str]:
    """What the docstring of a record says of its fields."""
    known = {each.name for each in fields(kind)}
    found, names = dict[str, str](), list[str]()
    for line in (kind.__doc__ or "").splitlines()[1:]:
        if (start := _MEANING.fullmatch(line)) and known >= set(start[1].split(", ")):
            names = start[1].split(", ")
            found |= dict.fromkeys(names, start[2])
        elif more := _NEXT.fullmatch(line):
            found |= {name: f"{found[name]} {more[1]}" for name in names}
        else:
            names = []
    return found


def _rows(kind: type, place: str, shown: dict[type, str], before: dict[str, str]) -> Iterator[str]:
    """The keys of a record; one that was shown before is not shown again.

    What it says nothing of means the same as ``before``, in the records that were shown.
    """
    shown[kind] = place
    said, types = meanings(kind), {each.name: each.type for each in fields(kind)}
    before |= said
    for each in figures_of(kind):
        if each.figure.is_extra:
            continue
        inner, is_list = _record_of(types.get(each.attribute), each)
        group = f"{each.figure.within}." if each.figure.within else ""
        key = place + group + each.key + ("[]" if is_list else "")
        if inner is not None and each.figure.is_flat:
            yield from _rows(inner, place, shown, before)
            continue
        meaning = said.get(each.attribute) or _of_property(kind, each.attribute) or before.get(each.attribute, "")
        if inner in shown:
            meaning = f"{meaning}; keys as of `{shown[inner].rstrip('.')}`".removeprefix("; ")
        yield f"| `{key}` | {_cell(meaning)} |\n"
        if inner is not None and inner not in shown:
            yield from _rows(inner, f"{key}.", shown, before)


def _record_of(annotation: Any, figure: KeyFigure) -> tuple[type | None, bool]:
    """The class of the records in a field, and whether there are several."""
    if figure.figure.take is not None:
        return None, False
    found, is_list = [annotation], False
    while found:
        each = found.pop()
        if isinstance(each, type) and is_dataclass(each) and each is not Problem:
            return each, is_list
        is_list = is_list or getattr(each, "__origin__", None) is tuple
        found += get_args(each)
    return None, False


def _of_property(kind: type, name: str) -> str:
    getter = getattr(vars(kind).get(name), "fget", None)
    text = " ".join((getter.__doc__ or "").split()).partition(". ")[0].rstrip(".") if getter else ""
    return text[:1].lower() + text[1:]


def _cell(text: str) -> str:
    return text.replace("``", "`").replace("|", "\\|").replace("None", "null")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
