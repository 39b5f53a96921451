"""The sound programs that are edited: parts and cases posted for a machine of each language, and golden programs."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.golden_controls import CASES
from tests.support.locations import GOLDEN, ROOT
from tests.support.recall_proof.parts import PARTS, cl_text
from trunnion.controls import load_control
from trunnion.machines import load_machine

MACHINES: Final = {
    "Sinumerik": "yl569", "Heidenhain": "dmu65", "Fanuc": "matsuura_mx330", "Haas": "haas_umc750",
    "LinuxCNC": "xyzac_trt", "Fidia": "hs664rt",
}  # fmt: skip
_CASES: Final = ROOT / "tests" / "data" / "cases"
#: CL files of golden programs of which only these and planes are published.
_PLANES: Final = ("dmu65/bevel.cls", "dmu65/corner.cls")


@dataclass(frozen=True)
class Base:
    """A program, the machine that runs it, its CL file, and what else ``verify`` needs to know."""

    family: str
    name: str
    machine: str | Path
    cl: Path
    text: str
    stated: dict[str, Any] = field(default_factory=dict)

    @property
    def tolerance(self) -> float:
        """INTOL and OUTTOL of the first operation of its CL file together, mm; 0 if it has neither."""
        text = self.cl.read_text(encoding="utf-8")
        found = (re.search(rf"^{word}\s*/\s*([\d.]+)", text, re.MULTILINE) for word in ("INTOL", "OUTTOL"))
        return sum(float(each[1]) for each in found if each)


def bases(folder: Path, family: str | None = None) -> Iterator[Base]:
    """Yield every base; ``folder`` takes the files that are made on the way."""
    yield from _goldens(family)
    files = [*sorted(_CASES.glob("*.cls")), *(GOLDEN / name for name in _PLANES)]
    for name in PARTS:
        file = folder / f"{name}.cls"
        file.write_text(cl_text(name), encoding="utf-8")
        files.append(file)
    for each, machine in MACHINES.items():
        for cl in files if family in (None, each) else ():
            program = folder / f"{machine}_{cl.stem}.nc"
            try:
                trunnion.post(cl, machine=machine, output=program)
            except trunnion.TrunnionError:  # mist, which not every machine here has
                continue
            yield Base(each, program.stem, machine, cl, program.read_text(encoding="utf-8"))


def language_of(machine: str | Path) -> str:
    """The language of a machine's programs, as the name of its control begins with."""
    return load_control(load_machine(machine).control).name.split()[0]


def _goldens(family: str | None) -> Iterator[Base]:
    for name, case in CASES.items():
        machine = GOLDEN / case.machine if case.machine.endswith(".toml") else case.machine
        if family in (None, language := language_of(machine)):
            text = (GOLDEN / name).read_text(encoding="utf-8")
            yield Base(language, name, machine, GOLDEN / case.cl, text, _stated(case.settings))
    published = {
        "Sinumerik": [f"yl569/{name}" for name in ("1_contour_rough", "2_hub_rough", "3_blade_finish")],
        "Fidia": ["hs664rt/radial_holes"],
    }
    for each, names in published.items():
        for name in names if family in (None, each) else ():
            program = next(iter((GOLDEN / name).parent.glob(f"{Path(name).name}.expected.*")))
            yield Base(each, name, MACHINES[each], GOLDEN / f"{name}.cls", program.read_text(encoding="utf-8"))


def _stated(settings: tuple[str, ...]) -> dict[str, Any]:
    """What ``verify`` must be told of a program's settings."""
    given = dict(setting.split("=", 1) for setting in settings)
    stated: dict[str, Any] = {}
    if "work_offset" in given:
        stated["work_offset"] = given["work_offset"]
    if "zero" in given:
        stated["zero"] = [float(value) for value in given["zero"].split(",")]
    if "tool_length" in given:
        stated["tool_length"] = float(given["tool_length"])
    return stated
