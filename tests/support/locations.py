"""Where files of the tests are, and the settings of the golden programs."""

from pathlib import Path

TESTS = Path(__file__).parents[1]
ROOT = TESTS.parent
DOCS = ROOT / "docs"
GOLDEN = TESTS / "golden"
YL569 = GOLDEN / "yl569"

PART = "C:\\Users\\lhx\\Desktop\\中德20210422\\11\\叶轮加工\\jg.prt"

#: Name of the case -> settings with which its program was posted.
HEADS = {
    "2_hub_rough": {"title": "轮毂粗加工", "part": PART, "date": "Tue Apr 30 12:54:07 2021"},
    "3_blade_finish": {"title": "叶片精加工", "part": PART, "date": "Tue Apr 30 14:16:10 2021"},
}

#: Real files of others, which are not part of the project; tests that need them are skipped where they are missing.
SHARED = ROOT.resolve().parent / "shared"

FIDIA = GOLDEN / "hs664rt"

#: Settings with which the program of the HS664RT was posted.
FIDIA_HEAD = {"program": "0001", "title": "3100588-02 REV-"}
