"""Steps that are missing or come too late: what stands before each of them."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.locations import ROOT
from trunnion import InputError, load_impeller
from trunnion.errors import Severity
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.material import material_before, order_problems, side_problems
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.steps import StepKind
from trunnion.simulation.tools.profile import Role

FOLDER = ROOT / "examples" / "impeller"

#: What must have been before a step of the published impeller: one of these. What was made elsewhere may be made again.
NEEDS = {
    StepKind.STOCK_FINISHING: {StepKind.STOCK_ROUGHING, StepKind.STOCK_FINISHING},
    StepKind.CHANNEL_ROUGHING: {StepKind.STOCK_ROUGHING, StepKind.STOCK_FINISHING},
    StepKind.HUB_FINISH: {StepKind.CHANNEL_ROUGHING, StepKind.HUB_FINISH},
    StepKind.BLADE_FINISH: {StepKind.CHANNEL_ROUGHING, StepKind.HUB_FINISH},
    StepKind.ROOT_BLEND: {StepKind.CHANNEL_ROUGHING, StepKind.HUB_FINISH},
}

KINDS = [StepKind.STOCK_ROUGHING, *NEEDS]


@pytest.fixture(scope="module")
def published() -> Impeller:
    return load_impeller(FOLDER / "impeller.toml")


def with_steps(impeller: Impeller, kinds: Sequence[StepKind], premachined: Sequence[StepKind] = ()) -> Impeller:
    """The impeller with these of its steps, in this order."""
    own = {step.kind: step for step in impeller.definition.steps}
    steps = tuple(own[kind] for kind in kinds)
    return replace(impeller, definition=replace(impeller.definition, steps=steps, premachined=tuple(premachined)))


@given(st.permutations(KINDS), st.integers(0, 6), st.sets(st.sampled_from(KINDS)))
def test_a_step_is_told_that_finds_what_none_before_it_took(
    published: Impeller, order: list[StepKind], count: int, premachined: set[StepKind]
) -> None:
    steps = order[:count]
    impeller = with_steps(published, steps, sorted(premachined))
    missing = [kind for k, kind in enumerate(steps) if kind in NEEDS and not NEEDS[kind] & {*steps[:k], *premachined}]
    told = list(order_problems(impeller))
    own = {step.kind: step for step in impeller.definition.steps}
    assert [problem.line for problem in told] == [own[kind].line for kind in missing]
    for kind, problem in zip(missing, told, strict=True):
        assert problem.severity is Severity.WARNING
        assert problem.what.startswith(f"{own[kind].name}: up to 1")
        clears = StepKind.STOCK_ROUGHING if StepKind.STOCK_ROUGHING in NEEDS[kind] else StepKind.CHANNEL_ROUGHING
        if clears in steps:
            assert problem.cure == f"put {own[clears].name} before it"
        else:
            assert f'stock.premachined = ["{clears}"]' in problem.cure


@pytest.mark.parametrize("name", ["impeller", "mixed_flow", "turbo3d"])
def test_the_examples_are_in_order_and_leave_less_from_step_to_step(name: str) -> None:
    impeller = load_impeller(FOLDER / f"{name}.toml")
    assert list(order_problems(impeller)) == []
    stands = material_before(impeller)
    assert len(stands) == len(impeller.definition.steps) + 1
    for earlier, later in pairwise(stands):
        assert later.form <= earlier.form
        assert later.hub <= earlier.hub
    assert stands[0].blades is None
    assert stands[-1].hub < 0.02
    assert (stands[-1].blades or 0.0) < 0.02


def test_a_part_of_the_steps_counts_those_that_are_not_made_now(published: Impeller) -> None:
    assert list(order_problems(published, ["ROOT_BLEND"])) == []
    late = with_steps(published, [StepKind.HUB_FINISH, StepKind.BLADE_FINISH, StepKind.CHANNEL_ROUGHING])
    assert [problem.what.split(":")[0] for problem in order_problems(late, ["BLADE_FINISH", "HUB_FINISH"])] == [
        "HUB_FINISH"
    ]


def test_an_allowance_that_is_more_than_the_next_ball_takes_is_told(published: Impeller) -> None:
    steps = tuple(
        replace(step, hub_allowance=4.0) if step.kind is StepKind.CHANNEL_ROUGHING else step
        for step in published.definition.steps
    )
    thick = replace(published, definition=replace(published.definition, steps=steps))
    (problem,) = order_problems(thick)
    assert problem.what.startswith("HUB_FINISH: up to 4.0 mm of metal stand on the hub")
    assert problem.cure == "let CHANNEL_ROUGHING leave less"


@pytest.mark.parametrize(
    ("part", "body", "distance", "told"),
    [
        (Role.SHANK, "blade 2", 0.3, True),
        (Role.SHANK, "blade 2", 0.35, False),
        (Role.HOLDER, "the hub", 0.32, True),
        (Role.HOLDER, "the hub", 0.33, False),
        (Role.CUTTER, "blade 2", 0.1, False),
    ],
)
def test_a_shank_or_holder_in_what_was_left_is_told(
    published: Impeller, part: Role, body: str, distance: float, told: bool
) -> None:
    step, before = published.definition.steps[3], material_before(published)[3]
    clearance = PartClearance(part, body, distance, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    found = list(side_problems("part.toml", step, before, [clearance]))
    assert bool(found) is told
    assert all(f"{part} comes as near as" in problem.what for problem in found)


def test_what_was_made_elsewhere_is_a_kind_of_operation(tmp_path: Path) -> None:
    for table in ("blade_points.csv", "impeller.toml"):
        (tmp_path / table).write_bytes((FOLDER / table).read_bytes())
    file = tmp_path / "impeller.toml"
    text = file.read_text("utf-8")
    file.write_text(text.replace("height_mm = 35.0", 'height_mm = 35.0\npremachined = ["turning"]'), "utf-8")
    with pytest.raises(InputError, match=r"stock.premachined names 'turning', which is no kind of operation"):
        load_impeller(file)
    file.write_text(text.replace("height_mm = 35.0", 'height_mm = 35.0\npremachined = ["stock roughing"]'), "utf-8")
    assert load_impeller(file).definition.premachined == (StepKind.STOCK_ROUGHING,)


def test_a_step_down_deeper_than_the_form_is_told(published: Impeller) -> None:
    impeller = with_steps(published, [StepKind.STOCK_ROUGHING])
    (step,) = impeller.definition.steps
    assert list(order_problems(impeller)) == []
    deep = replace(impeller.definition, steps=(replace(step, step_down=40.0),))
    (problem,) = order_problems(replace(impeller, definition=deep))
    assert (problem.severity, problem.line) == (Severity.WARNING, step.line)
    assert "step_down_mm = 40 cuts the whole" in problem.what
