"""Every state of a program that a reader knows: carried, in the path, reported or refused, as the table says."""

import ast
import re
from dataclasses import fields
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import ROOT
from tests.support.program_states import MACHINES, SAMPLES, Sample
from tests.support.states_page import PAGE, page
from trunnion.conversion.states import STATES, TARGETS, Fate, State, loss_of
from trunnion.model.run_columns import ModalState


def test_each_state_has_a_program() -> None:
    assert [state.name for state in STATES] == list(SAMPLES)


def test_each_column_of_a_run_belongs_to_one_state() -> None:
    columns = [column for state in STATES for column in state.columns]
    assert sorted(columns) == sorted(each.name for each in fields(ModalState))


def test_each_kind_of_event_belongs_to_one_state() -> None:
    kinds = [kind for state in STATES for kind in state.kinds]
    assert len(kinds) == len(set(kinds))
    assert _kinds_of_readers() <= set(kinds)


def test_an_event_that_no_state_has_is_refused() -> None:
    fate, loss = loss_of("bar_feed")
    assert fate is Fate.REFUSED
    assert loss is not None
    assert "bar_feed" in loss.what


def test_the_page_has_the_table() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()


@pytest.mark.third
@pytest.mark.parametrize("state", STATES, ids=lambda state: state.name.replace(" ", "_"))
def test_each_cell_of_the_table_is_so(state: State, tmp_path: Path) -> None:
    sample = SAMPLES[state.name]
    wrong = [
        f"{target}: {state.on(target)}, but {found}"
        for target in TARGETS
        if target != sample.source and (found := _outcome(state, sample, target, tmp_path))
    ]
    assert not wrong, "\n".join(wrong)


def _outcome(state: State, sample: Sample, target: str, folder: Path) -> str:
    """What a conversion does, if it is not what the table says; else empty."""
    others = []
    for name, text in sample.also:
        others.append(folder / name)
        others[-1].write_text(text, encoding="utf-8")
    program, output = folder / "part.nc", folder / f"{target}.out"
    program.write_text(sample.text, encoding="utf-8")
    machine, fate = MACHINES[sample.source], state.on(target)
    to_machine = MACHINES.get(target)
    try:
        result = trunnion.convert(
            program,
            machine=machine,
            to_machine=to_machine,
            to_cl=to_machine is None,
            output=output,
            subprograms=others,
            zero=sample.zero,
            tool_length=sample.tool_length,
        )
    except trunnion.TrunnionError as error:
        text = str(error)
        return "" if fate is Fate.REFUSED and sample.says in text else f"refused: {text}"
    said = [str(problem) for problem in result.problems if sample.says and sample.says in str(problem)]
    if fate is Fate.REFUSED:
        return "written"
    if fate is Fate.REPORTED:
        return "" if said else f"nothing is said of it: {[str(each) for each in result.problems]}"
    if said:
        return f"said: {said}"
    if to_machine is None:
        text = output.read_text(encoding="utf-8")
        return "" if re.search(sample.cl, text) else f"the CL file is\n{text}"
    assert result.posted is not None
    if not result.posted.passed:
        return "the proof fails"
    run = trunnion.read_program(output, machine=to_machine)
    return "" if sample.probe is None or sample.probe(run) else f"not in\n{output.read_text(encoding='utf-8')}"


def _kinds_of_readers() -> set[str]:
    """The kinds of events that the sources of the readers add."""
    found = set[str]()
    for file in (ROOT / "src" / "trunnion" / "readers").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "add_event":
                kind = node.args[0].elts[0] if isinstance(node.args[0], ast.Tuple) else node.args[0]
                found |= {str(each.value) for each in ast.walk(kind) if isinstance(each, ast.Constant)}
    return {kind for kind in found if re.fullmatch("[a-z]+[a-z0-9_]*", kind)}
