"""Defects in sound programs are found, in the right block, and nothing else: a part of ``benchmarks/recall.py``."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from tests.support.recall import Defect, Reference, Sound, gouges, outcome, simulated
from tests.support.recall_ribs import rib_gouges, ribs
from tests.support.recall_setups import golden_programs, setups_of_contour, sound_contour_setups, standing, wrong_tools


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("recall")


@pytest.fixture(scope="module")
def sounds(folder: Path) -> list[Sound]:
    return golden_programs(folder)[:2]


@pytest.fixture(scope="module")
def references(sounds: list[Sound], folder: Path) -> list[Reference]:
    return [Reference.of(sound, folder) for sound in sounds]


def test_nothing_is_found_in_sound_programs(sounds: list[Sound], references: list[Reference], folder: Path) -> None:
    for sound, reference in zip(sounds, references, strict=True):
        assert simulated(sound, folder, reference.mesh).passed
    held = next(sound_contour_setups(sounds[0]))
    assert simulated(held, folder, Reference.of(held, folder).mesh).passed


def _some(contour: Sound, hub: Sound, reference: Reference) -> Iterator[Defect]:
    """About twenty of all kinds."""
    yield from (each for each in gouges(hub, reference, 1) if each.cells >= 0.5)
    yield from islice(wrong_tools(hub), 2)
    yield from standing(hub, 2)
    yield from (each for k, each in enumerate(setups_of_contour(contour)) if k % 6 == 5)


def test_gouges_into_thin_ribs_are_found_against_a_design_of_boxes(folder: Path) -> None:
    sound, reference = ribs(folder)
    assert simulated(sound, folder, reference.mesh).passed
    for defect in list(rib_gouges(sound))[10::7]:
        each = outcome(defect, reference, folder)
        assert (each.found, each.right, each.invented) == (True, True, ()), (defect.kind, defect.cells)
        assert 0.6 * defect.mm <= each.depth <= 1.01 * defect.mm


def test_defects_are_found_in_the_right_block(sounds: list[Sound], references: list[Reference], folder: Path) -> None:
    found = []
    for defect in _some(sounds[0], sounds[1], references[1]):
        reference = references[sounds.index(next(each for each in sounds if each.name == defect.sound.name))]
        found.append(outcome(defect, reference, folder))
    assert len(found) >= 15
    for each in found:
        assert (each.found, each.right, each.invented) == (True, True, ()), each.defect.kind
        if each.defect.mm and each.defect.kind.startswith("gouge"):
            assert each.depth >= 0.7 * each.defect.mm
