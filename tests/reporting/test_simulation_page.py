"""The report of a simulation: all text from outside is text, and the page needs nothing else."""

import re
from dataclasses import replace

import numpy as np

from trunnion.messages import phrase
from trunnion.reporting.simulation_content import DeviationBin, SimulationContent, StockState, no_remarks
from trunnion.reporting.simulation_page import render_simulation_page
from trunnion.simulation.setup_findings import BlockRemoval, NearMiss, SimulatedOperation, SimulationFinding
from trunnion.verification import Verdict

EVIL = '<script>alert("&")</script>'
FINDING = SimulationFinding(
    "gouge", (EVIL, EVIL), EVIL, 3, 30, 4, 40, 5, 12.0, 0.25, (1.0, -2.0, 3.0), cl_file=EVIL, setup=EVIL
)
NEAR = NearMiss((EVIL, EVIL), EVIL, 3, 30, 3, 30, 12.0, 0.25, (1.0, -2.0, 3.0), EVIL)
REMOVAL = BlockRemoval(np.zeros(0, np.int32), np.zeros(0), np.zeros(0))
CONTENT = SimulationContent(
    title=EVIL,
    verdict=Verdict.FAILED,
    facts=(("Machine", EVIL),),
    findings=(FINDING,) * 250,
    near=(NEAR,),
    operations=(SimulatedOperation(EVIL, EVIL, 3, 4, 60.0, 0.5, 30.0, 4.0, 1, REMOVAL),),
    states=(
        StockState(
            EVIL, 60.0, (0.5, 2.0), (0.25, 1.0),
            (DeviationBin(-0.25, -0.1, 10.0), DeviationBin(-0.1, 0.1, 500.0), DeviationBin(0.1, 0.5, 20.0)),
            ((EVIL, b"\x89PNG"),),
        ),
    ),
    remarks=lambda words: (EVIL,),
    data={},
)  # fmt: skip


def page(content: SimulationContent) -> str:
    return b"".join(render_simulation_page(content)).decode()


def test_text_from_outside_stays_text_and_nothing_is_run_or_loaded() -> None:
    text = page(CONTENT)
    assert "<script" not in text
    assert text.count("&lt;script&gt;") > 10
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', text)
    assert policy is not None
    assert "default-src 'none'" in policy[1]
    assert "script-src" not in policy[1]
    assert not re.findall(r"(?:src|href)=\"(?!data:image/png;base64,)", text)
    assert not re.findall(r"<[^>]* style=", text)  # the policy would drop it
    assert "url(" not in text


def test_it_shows_findings_tables_bars_and_pictures() -> None:
    text = page(CONTENT)
    assert "and 50 more, in the data" in text
    assert "<td class=n>120</td>" in text  # mm³ in a minute
    assert re.findall(r'<rect width="([\d.]+)"', text) == ["120.0", "240.0"]  # to the scale of what deviates
    assert text.count("data:image/png;base64,iVBORw==") == 1
    sound = page(replace(CONTENT, verdict=Verdict.PASSED, findings=(), near=(), remarks=no_remarks))
    assert "Nothing was found." in sound
    assert "Near misses" not in sound
    assert 'class="verdict good"' in sound
    in_part = page(
        replace(CONTENT, verdict=Verdict.IN_PART, not_checked=(phrase("not_all_judged", codes=("SIM146",)),))
    )
    assert 'class="verdict open"' in in_part
    assert "<strong>Passed in part</strong>\n<span>nothing found; not all was judged (SIM146)</span>" in in_part
