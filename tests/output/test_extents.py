"""What operations cut, with arcs as far as they go."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.model.subdivision import subdivide
from trunnion.model.toolpath import Kind
from trunnion.output.coordinates.extents import cut_box

ARCS = {
    "quarter": "CIRCLE/0,0,5,0,0,1,10\nGOTO/0.0,10.0,5.0\n",
    "three quarters": "CIRCLE/0,0,5,0,0,-1,10\nGOTO/0.0,10.0,5.0\n",
    "whole": "CIRCLE/0,0,5,0,0,1,10\nGOTO/10.0,0.0,5.0\n",
    "upright": "CIRCLE/0,0,5,0,1,0,10\nGOTO/0.0,0.0,-5.0\n",
    "a little": "CIRCLE/0,0,5,0,0,1,10\nGOTO/9.9,1.410674,5.0\n",
}


@pytest.mark.parametrize("name", ARCS)
def test_a_box_has_what_arcs_pass_and_no_more(name: str, tmp_path: Path) -> None:
    source = tmp_path / "part.cls"
    source.write_text(HEAD + ARCS[name] + FOOT, encoding="utf-8")
    result = trunnion.post(source, machine="yl569")
    run = result.run
    assert run is not None
    box = cut_box(result.motions)
    assert box is not None
    cuts = [subdivide(run, 720, slice(row, row + 1)).tip for row in np.flatnonzero(run.kind != Kind.RAPID).tolist()]
    tips = np.concatenate((*cuts, [[0.0, 0.0, 50.0]]))
    np.testing.assert_allclose(box, (tips.min(axis=0), tips.max(axis=0)), atol=2e-3)
