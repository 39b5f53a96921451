"""Every function that reads CL files can be told how: ``units``, ``dialect`` and ``strict``, as its command can."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.jobs.view.viewing import prepare_view

PROGRAM = YL569 / "2_hub_rough.expected.mpf"

#: What each function does with a CL file.
CALLS: dict[str, Callable[..., Any]] = {
    "post": lambda cl, **how: trunnion.post(cl, machine="yl569", **how),
    "verify": lambda cl, **how: trunnion.verify(PROGRAM, machine="yl569", cl=cl, **how),
    "describe_cl": trunnion.describe_cl,
    "convert": lambda cl, **how: trunnion.convert(cl, to_cl=True, **how),
    "place": lambda cl, **how: trunnion.place(cl, machine="yl569", turns=[0.0], **how),
    "reach": lambda cl, **how: trunnion.reach("yl569", cl=cl, step=45.0, **how),
    "fit": lambda cl, **how: trunnion.fit(cl, machines="yl569", turns=[0.0], tool_length=100.0, **how),
    "view": lambda cl, **how: prepare_view(PROGRAM, machine="yl569", cl=cl, **how),
    "simulate": lambda cl, **how: trunnion.simulate(
        PROGRAM, machine="yl569", stock="box:80,40,40,-10,-20,-40", tools=["2=ball:8,length=80"], cell=2.0, cl=cl, **how
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_function_reads_cl_files_as_it_is_told(name: str, tmp_path: Path) -> None:
    file = tmp_path / "part.cls"
    text = (YL569 / "2_hub_rough.cls").read_text(encoding="utf-8")
    file.write_text(text.replace("GOTO/", "WHATISIT/1\nGOTO/", 1), encoding="utf-8")
    call = CALLS[name]
    with pytest.raises(trunnion.InputError, match="WHATISIT"):
        call(file, strict=True)
    for argument, wrong in (("units", "furlong"), ("dialect", "klingon")):
        with pytest.raises(trunnion.InputError, match=f"{argument}: error: .*'{wrong}'"):
            call(file, **{argument: wrong})


def test_the_unit_of_cl_files_counts() -> None:
    cl = YL569 / "2_hub_rough.cls"
    asked: dict[str, Any] = {"machines": "yl569", "turns": [0.0], "tool_length": 100.0}
    (mm,), (inch,) = trunnion.fit(cl, **asked, units="mm"), trunnion.fit(cl, **asked, units="inch")
    assert mm.seconds == trunnion.fit(cl, **asked)[0].seconds
    assert (mm.status, mm.seconds) != (inch.status, inch.seconds)
    with pytest.raises(trunnion.InputError, match="units: error: is for CL files, and a program is read"):
        trunnion.fit(PROGRAM, machine="yl569", machines="hs664rt", units="inch")
