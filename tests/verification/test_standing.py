"""What "passed" stands on: states of checks, what is missing, and what settings and definitions demand."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.verifying import CL_FOOT, CL_HEAD, FOOT, HEAD, Verifier
from trunnion.definitions.marked_values import MarkedValue
from trunnion.errors import InputError, Severity
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.machines.unmeasured import unmeasured_values
from trunnion.messages import foreign
from trunnion.reporting.html_text import verdict_banner
from trunnion.verification import Standing, check_lines
from trunnion.verification.checks import table
from trunnion.verification.results import Check, State, Verification

HUB = YL569 / "2_hub_rough.cls"
PROGRAM = HEAD + "G0 X0 Y0 Z50\nG1 X10 F500\n" + FOOT


def states(verification: Verification) -> dict[str, str]:
    return {check.key: str(check.state) for check in verification.checks}


def test_a_check_without_its_basis_is_not_checked_and_says_what_is_missing(verified: Verifier) -> None:
    found = verified(PROGRAM, CL_HEAD + CL_FOOT)
    travel = next(check for check in found.checks if check.key == "travel")
    assert travel.state is State.NOT_CHECKED
    assert str(travel).startswith("travel        not checked  no workpiece zero stated; no tool length stated; ")
    acceleration = next(check for check in found.checks if check.key == "acceleration")
    assert str(acceleration) == "acceleration  not checked  no acceleration stated"
    assert states(found)["speed"] == "ok"
    placed = replace(found.machine, workpiece_zero=(0.0, 0.0, 0.0), tool_length=100.0)
    assert states(verified(PROGRAM, machine=placed))["travel"] == "ok"


def test_a_fault_counts_more_than_what_is_missing() -> None:
    from trunnion.messages import foreign, phrase

    assert Check("travel", False, foreign("too far"), missing=(phrase("no_zero"),)).state is State.FAIL


def test_without_cl_files_the_checks_that_need_them_are_one_line(verified: Verifier) -> None:
    first, *others = check_lines(verified(PROGRAM))
    assert first == (
        "order, tip, axis, kind, feed, spindle, tool, coolant, compensation, stops, home, holes: not checked,"
        " no CL file given"
    )
    assert [line.split()[0] for line in others][:2] == ["offset", "span"]


def test_the_line_of_the_program_counts_states_warnings_and_what_nobody_measured(verified: Verifier) -> None:
    found = verified(PROGRAM, CL_HEAD + CL_FOOT)
    travel = next(check for check in found.checks if check.key == "travel")
    values = (foreign("C point_mm (a.toml:3)"), foreign("Z home_mm (a.toml:9)"))
    others = [replace(check, stands_on=()) for check in found.checks if check is not travel]
    bare = replace(found, checks=(*others, replace(travel, stands_on=values)))
    standing = bare.standing
    assert (standing.failed > 0, standing.passed) == (True, False)
    sound = replace(bare, checks=tuple(check for check in bare.checks if check.passed))
    ok, every = sound.standing.ok, len(sound.checks)
    assert sound.standing.told == (
        f"Passed in part: {ok} of {every} checks; {every - ok} not checked; stands on 2 values nobody measured; "
        "assumed: the control starts with G40, TRAFOOF, CYCLE800()"
    )


def test_every_page_has_the_banner_of_the_verdict() -> None:
    def banner(standing: Standing) -> list[str]:
        text = verdict_banner(standing.verdict, standing.said())
        return re.findall(r'class="verdict (\w+)"|<strong>([^<]+)|<span>([^<]+)', text)

    found = [
        ["".join(parts) for parts in banner(standing)]
        for standing in (
            Standing(passed=True, ok=21, failed=0, not_checked=0),
            Standing(passed=True, ok=7, failed=0, not_checked=14),
            Standing(passed=False, ok=19, failed=2, not_checked=0),
            Standing(passed=False, ok=21, failed=0, not_checked=0),
            Standing(passed=True, ok=0, failed=0, not_checked=0),
        )
    ]
    assert found == [
        ["good", "Passed", "21 of 21 checks"],
        ["open", "Passed in part", "7 of 21 checks; 14 not checked"],
        ["bad", "Failed", "2 of 21 checks"],
        ["bad", "Failed", "written by force; 21 of 21 checks passed"],
        ["none", "Nothing checked"],
    ]


def test_overruled_errors_do_not_pass(verified: Verifier) -> None:
    found = verified(PROGRAM)
    problem = trunnion.Problem("a.cls", 1, foreign("axis X would leave its travel"))
    assert found.standing.passed
    assert not replace(found, remarks=(problem,)).standing.passed


def test_a_post_says_its_standing_as_data() -> None:
    result = trunnion.post(HUB, machine="yl569")
    assert result.standing is not None
    warnings = sum(problem.severity is Severity.WARNING for problem in result.problems)
    assert (result.standing.not_checked, result.standing.warnings) == (2, warnings)
    assert result.standing.not_measured
    stated = trunnion.post(HUB, machine="yl569", settings={"zero": (-30, 0, -80), "tool_length": 120})
    assert stated.standing is not None
    assert stated.standing.not_checked == 1  # acceleration


def test_strict_makes_a_missing_basis_an_error() -> None:
    with pytest.raises(trunnion.ProofFailedError, match="no workpiece zero stated; no tool length stated; no acc"):
        trunnion.post(HUB, machine="yl569", strict=True)
    program = YL569 / "2_hub_rough.expected.mpf"
    assert trunnion.verify(program, machine="yl569", cl=HUB).passed
    found = trunnion.verify(program, machine="yl569", cl=HUB, strict=True)
    assert (found.passed, states(found)["basis"]) == (False, "FAIL")


def test_a_definition_demands_what_its_proofs_stand_on(tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    file.write_text('schema = 1\nextends = "yl569"\nname = "Own"\n[proof]\nrequire = ["tool_length", "zero"]\n')
    machine: Machine = load_machine(file)
    assert machine.demands == ("zero", "tool_length")
    with pytest.raises(trunnion.ProofFailedError, match=r"no workpiece zero stated; no tool length stated \(basis\)"):
        trunnion.post(HUB, machine=machine)
    result = trunnion.post(HUB, machine=machine, settings={"zero": (-30, 0, -80), "tool_length": 120})
    assert states(result.verification or pytest.fail("not proven"))["basis"] == "ok"
    file.write_text('schema = 1\nextends = "yl569"\nname = "Own"\n[proof]\nrequire = ["zeros"]\n')
    with pytest.raises(InputError, match="has zeros, which no proof stands on"):
        load_machine(file)


def test_a_remark_behind_a_value_marks_it_wherever_it_says_that_it_is_assumed() -> None:
    for name, value in (("mikron_600u", "B limits_deg"), ("mikron_600u", "X limits_mm"), ("ucp800", "C endless")):
        assert value in [each.name for each in load_machine(name).assumed]
    assert all(each.table == "body" for each in load_machine("hs664rt").assumed if "size_mm" in each.name)


def stands_on(found: Verification) -> dict[str, list[str]]:
    return {check.key: [str(value).partition(" (")[0] for value in check.stands_on] for check in found.checks}


#: What a shop has still to measure.
MARKED = """schema = 1
extends = "yl569"
name = "Own"
[spindle]
gauge_point_mm = [0, 0, 0] # measure: where tool lengths begin
max_rpm = 12000 # measure: the plate
[[axis]]
name = "C"
point_mm = [0, 0, 0] # measure: by probe
[[axis]]
name = "B"
point_mm = [0, 0, 0] # measure: by probe
limits_deg = [-11, 100] # measure
home_deg = 0
[[axis]]
name = "X"
limits_mm = [-250, 250] # measure: software limits
rapid_mm_min = 24000 # published; an assumption for this one
[[axis]]
name = "Y"
limits_mm = [-150, 150] # measure: software limits
"""


def test_only_values_that_matter_to_a_program_are_counted(tmp_path: Path, verified: Verifier) -> None:
    file = tmp_path / "own.toml"
    file.write_text(MARKED.replace("# measure\n", "# measure: software limits\n"))
    still = stands_on(verified(PROGRAM, machine=load_machine(file)))
    # X and Z move: no point of a rotary axis matters, and nothing of Y and B. The limits of Z are those of a yl569.
    assert still["travel"] == ["X limits_mm", "Z limits_mm"]
    assert still["speed"] == ["X rapid_mm_min", "Z rapid_mm_min"]
    assert still["acceleration"] == still["words"] == []
    turned = PROGRAM.replace("G1 X10 F500", "G1 X10 C30 F500")
    assert stands_on(verified(turned, machine=load_machine(file)))["travel"] == [
        "spindle gauge_point_mm", "C point_mm", "X limits_mm", "C endless", "C output", "Z limits_mm",
    ]  # fmt: skip


def test_what_another_machine_has_been_measured_for_is_not_measured_for_the_one_that_extends_it(
    tmp_path: Path, verified: Verifier
) -> None:
    """It is that of the file which names it; one without a name is no shipped machine either."""
    (tmp_path / "named.toml").write_text('schema = 1\nextends = "matsuura_mx330"\nname = "Own"\n')
    (tmp_path / "changed.toml").write_text('schema = 1\nextends = "named.toml"\n[workpiece]\nzero_mm = [0, 0, 5]\n')
    (tmp_path / "same.toml").write_text('schema = 1\nextends = "matsuura_mx330"\n[control.settings]\nshop = ""\n')
    names = [value.name for value in load_machine(tmp_path / "named.toml").inherited]
    assert names[:2] == ["spindle gauge_point_mm", "spindle max_rpm"]
    assert {"C point_mm", "X limits_mm", "X home_mm", "A limits_deg", "C endless", "rotary table shape"} <= set(names)
    assert [value.name for value in load_machine(tmp_path / "changed.toml").inherited] == names
    assert [value.name for value in load_machine(tmp_path / "same.toml").inherited] == names
    assert not load_machine("matsuura_mx330").inherited
    assert all(not load_machine(name).inherited for name in shipped_machines())
    turned = PROGRAM.replace("G1 X10 F500", "G1 X10 C30 F500")
    for own, counts in (("", True), ("[spindle]\ngauge_point_mm = [1, 2, 3]\n", False)):
        text = 'schema = 1\nextends = "yl569"\nname = "Own"\n'
        (tmp_path / "base.toml").write_text(f"{text}[spindle]\ngauge_point_mm = [1, 2, 3]\n")
        (tmp_path / "own.toml").write_text(f'schema = 1\nextends = "base.toml"\nname = "Second"\n{own}')
        machine = load_machine(tmp_path / "own.toml", {"proof": {"require": ["measured"]}})
        found = verified(turned, machine=machine)
        assert ("spindle gauge_point_mm" in stands_on(found)["travel"]) == counts
        basis = next(check for check in found.checks if check.key == "basis")
        assert not basis.passed
        assert ("gauge_point_mm (base.toml:5)" in basis.summary) == counts


def test_a_demand_for_measured_values_counts_those_that_matter(tmp_path: Path, verified: Verifier) -> None:
    file = tmp_path / "own.toml"
    file.write_text(MARKED + '[proof]\nrequire = ["measured"]\n')
    basis = next(check for check in verified(PROGRAM, machine=load_machine(file)).checks if check.key == "basis")
    assert not basis.passed
    assert "X limits_mm" in basis.summary
    assert "B point_mm" not in basis.summary


def test_what_nobody_measured_is_asked_once_for_all_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def counted(*given: object) -> tuple[MarkedValue, ...]:
        asked.append(given)
        return unmeasured_values(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(table, "unmeasured_values", counted)
    found = trunnion.verify(YL569 / "2_hub_rough.expected.mpf", machine="yl569", cl=HUB)
    assert sum(bool(check.stands_on) for check in found.checks) > 1
    assert len(asked) == 1


def test_a_program_that_moves_nothing_is_not_passed(tmp_path: Path) -> None:
    for machine, text in (("matsuura_mx330", "%\nO0001\nM30\n%\n"), ("yl569", "M30\n"), ("xyzac_trt", "M2\n")):
        program = tmp_path / "p.nc"
        program.write_text(text, encoding="utf-8")
        standing = trunnion.verify(program, machine=machine).standing
        assert standing.told.startswith("Nothing checked: there is no motion; ")


@pytest.mark.parametrize("machine", ["matsuura_mx330", "yl569", "dmu65", "hs664rt", "xyzac_trt"])
def test_what_is_compared_with_no_point_is_not_checked(machine: str, tmp_path: Path) -> None:
    """A program that moves nothing has nothing at the points of the CL file."""
    program, cl = tmp_path / "p.nc", tmp_path / "p.cls"
    cl.write_text(f"{CL_HEAD}RAPID\nGOTO/0,0,50\nFEDRAT/MMPM,500\nGOTO/10,0,5\n{CL_FOOT}", encoding="utf-8")
    empty = "0 BEGIN PGM P MM\n1 END PGM P MM\n" if machine == "dmu65" else "M30\n"
    program.write_text(empty, encoding="utf-8")
    found = {check.key: check for check in trunnion.verify(program, machine=machine, cl=cl).checks}
    assert not found["order"].passed
    for key in ("kind", "feed", "spindle", "tool", "coolant", "stops"):
        assert found[key].state == "not checked"
        assert found[key].told.startswith("no block goes to any CL point")
