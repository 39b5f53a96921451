"""What the page asks for: a start, changes that are judged at their fields, a sample that is proven, and to save."""

import os
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion import InputError, load_machine
from trunnion.builder.chains import CHAINS
from trunnion.builder.document import with_value, without_value
from trunnion.builder.draft import MOST_LETTERS
from trunnion.builder.likeness import definition_like
from trunnion.builder.sample import shipped_sample
from trunnion.builder.saved_file import file_text, page_text
from trunnion.builder.session import BuilderSession, RequestError
from trunnion.machines.loading import machine_library, shipped_machines
from trunnion.schemas import file_name, first_line, schema_text


@pytest.fixture
def session(tmp_path: Path) -> BuilderSession:
    return BuilderSession(tmp_path)


def ask(session: BuilderSession, what: str, **given: Any) -> dict[str, Any]:
    found = session.answer(what, given)
    assert found is not None
    return found


def begun(session: BuilderSession, base: str = "yl569") -> str:
    return str(ask(session, "begin", name="Ours", base=base)["text"])


def field(data: dict[str, Any], *path: Any) -> dict[str, Any]:
    wanted = [list(step) if isinstance(step, tuple) else step for step in path]
    return next(each for page in data["pages"].values() for each in page if each["path"] == wanted)


def test_a_definition_that_extends_marks_what_it_takes_over_as_trunnion_new_does(session: BuilderSession) -> None:
    text = begun(session)
    assert text == definition_like(load_machine("yl569"), "Ours")
    mark = "limits_deg = [-11, 100] # measure: software limits of the control\n"
    assert text.count(mark) == 1
    limits = ["axis", ["B"], "limits_deg"]
    changed = ask(session, "change", text=text, path=limits, value=[-5, 95])
    assert changed["text"] == text.replace(mark, "limits_deg = [-5, 95]\n")
    assert changed["problems"] == []
    told = field(changed, "axis", ("B",), "limits_deg")
    assert (told["value"], told["inherited"], told["own"]) == ([-5, 95], [-11, 100], True)
    back = ask(session, "change", text=changed["text"], path=limits, value=[-11, 100])
    assert back["text"] == text.replace(mark, "")
    assert not field(back, "axis", ("B",), "limits_deg")["own"]
    # Measured, and the same as the other machine's: it stays, without the mark.
    same = ask(session, "change", text=text, path=limits, value=[-11, 100])
    assert same["text"] == text.replace(mark, "limits_deg = [-11, 100]\n")


@pytest.mark.third
@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["axis", ["B"], "limits_deg"], [5, -5]),
        (["axis", ["B"], "point_mm"], "1,5"),
        (["axis", ["X"], "direction"], [0, 0, 0]),
        (["spindle", "max_rpm"], -4),
        (["control", "settings", "edge"], "0"),
        (["control", "block_numbers", "step"], 0.5),
        (["control", "templates", "program_start"], "{nothing}\n"),
    ],
)
def test_a_bad_value_is_told_at_its_field(session: BuilderSession, path: list[Any], value: Any) -> None:
    changed = ask(session, "change", text=begun(session), path=path, value=value)
    wrong = [each for each in changed["problems"] if each["path"] == path]
    assert wrong, changed["problems"]
    assert wrong[0]["line"] > 2
    assert "; " in wrong[0]["text"]


def test_a_text_that_is_not_toml_is_told_at_its_line(session: BuilderSession) -> None:
    found = ask(session, "judge", text='name = "x"\naxis = [\n')
    assert [each["line"] for each in found["problems"]] == [3]
    assert found["machine"] is None
    again = ask(session, "change", text='name = "x"\naxis = [\n', path=["name"], value="y")
    assert again["unclear"] == "broken"
    assert (
        ask(session, "change", text="spindle.max_rpm = 5\n", path=["spindle", "min_rpm"], value=1)["unclear"]
        == "unclear"
    )


@pytest.mark.third
@pytest.mark.parametrize("chain", CHAINS)
def test_every_order_of_axes_makes_a_machine_whose_sample_is_proven(session: BuilderSession, chain: str) -> None:
    found = ask(session, "begin", name='Our "B"', chain=chain, control="heidenhain_tnc640")
    assert found["problems"] == []
    assert found["axes"] == CHAINS[chain].order.replace("|", " ").split()
    sample = ask(session, "sample", text=found["text"])
    assert sample["passed"], sample["problems"]
    assert {check["state"] for check in sample["checks"]} <= {"ok", "not checked"}
    assert "nobody measured" in sample["standing"]


@pytest.mark.third
@pytest.mark.parametrize("name", shipped_machines())
def test_the_shipped_sample_is_proven_on_every_machine(session: BuilderSession, name: str) -> None:
    sample = ask(session, "sample", text=begun(session, name))
    assert sample["passed"], sample["problems"]


def test_what_is_not_known_of_a_new_machine_is_left_out_or_marked(session: BuilderSession) -> None:
    found = ask(session, "begin", name="Ours", chain="head_table_bc", control="haas_ngc")
    assert "limits_mm" not in found["text"]
    marked = [each["path"] for each in found["marks"]]
    assert marked == [["axis", ["C"], "point_mm"], ["axis", ["B"], "point_mm"], ["axis", ["B"], "limits_deg"]]
    assert [found["text"].split("\n")[each["line"] - 1].count("# ") for each in found["marks"]] == [1, 1, 1]
    for path, value in zip(marked, ([0, 0, 1], [0, 0, 212.5], [-30, 110]), strict=True):
        found = ask(session, "change", text=found["text"], path=path, value=value)
    assert found["marks"] == []
    assert "#" not in found["text"].removeprefix(first_line("machine"))
    warned = ask(session, "sample", text=found["text"])
    assert any("travel" in each["text"] and each["severity"] == "warning" for each in warned["problems"])


def test_a_comment_of_the_users_own_is_no_mark(session: BuilderSession) -> None:
    text = 'extends = "yl569"\nname = "x" # the old one\n'
    changed = ask(session, "change", text=text, path=["name"], value="y")
    assert changed["text"] == text.replace('"x"', '"y"')
    assert changed["marks"] == []


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (["axis", ["X"], "limits_mm"], [-20, 20], "X"),
        (["spindle", "max_rpm"], 5999, "6000"),
        (["control", "settings", "work_offset"], "2", "work_offset"),
        (["control", "codes", "plane_xy"], 18, ""),
    ],
)
def test_a_sample_that_is_refused_has_a_reason(session: BuilderSession, path: list[Any], value: Any, told: str) -> None:
    changed = ask(session, "change", text=begun(session), path=path, value=value)
    assert changed["problems"] == []
    sample = ask(session, "sample", text=changed["text"])
    assert not sample["passed"]
    failed = [each for each in sample["checks"] if each["state"] == "FAIL"]
    assert failed or any(each["severity"] == "error" for each in sample["problems"])
    assert "force" not in str(sample)
    assert (sample["lines"], sample["all"]) == ([], 0)
    assert told in str(sample["problems"]) + str(sample["checks"])


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["control", "block_numbers", "highest"], 5),
        (["control", "extension"], "../x"),
        (["control", "extension"], "mpf"),
    ],
)
def test_what_posting_could_not_use_is_told_at_its_field(session: BuilderSession, path: list[Any], value: Any) -> None:
    changed = ask(session, "change", text=begun(session), path=path, value=value)
    assert [each["path"] for each in changed["problems"]] == [path]


def test_each_page_has_a_file_of_its_own(session: BuilderSession, tmp_path: Path) -> None:
    one, other = 'extends = "yl569"\nname = "one"\n', 'extends = "dmu65"\nname = "other"\n'
    seen = ask(session, "save", text=one, name="one.toml", seen="")["seen"]
    ask(session, "save", text=other, name="other.toml", seen="")
    assert session.start("one.toml")["text"] == one
    assert session.start("other.toml")["title"] == "other.toml"
    assert session.start()["text"] == ""
    found = field(ask(session, "judge", text=one, file="one.toml"), "name")
    assert found["from"].startswith("one.toml")
    (tmp_path / "one.toml").write_text("x", encoding="utf-8")
    assert ask(session, "save", text=one, name="one.toml", file="one.toml", seen=seen)["why"] == "changed"
    assert ask(session, "save", text=one, name="one.toml", file="other.toml", seen=seen)["why"] == "exists"
    for name in ("../one.toml", "/etc/passwd", "a/b.toml"):
        with pytest.raises(RequestError):
            session.start(name)


def test_axes_move_in_a_definition_of_its_own(session: BuilderSession) -> None:
    text = ask(session, "begin", name="Ours", chain="table_table_bc", control="haas_ngc")["text"]
    moved = ask(session, "change", text=text, move="X", by=1)
    assert moved["axes"] == ["C", "B", "Y", "X", "Z"]
    assert moved["problems"] == []


def test_the_sample_marks_what_a_change_has_done(session: BuilderSession) -> None:
    text = begun(session)
    first = ask(session, "sample", text=text)
    assert not first["changed"]
    settings = ["control", "settings", "work_offset"]
    changed = ask(session, "change", text=text, path=settings, value="G57")["text"]
    second = ask(session, "sample", text=changed, before=first["lines"])
    assert second["changed"]
    assert all("G57" in second["lines"][line] for line in second["changed"])
    assert second["removed"]


def test_one_more_line_is_one_change_although_blocks_are_numbered(session: BuilderSession) -> None:
    text = begun(session)
    first = ask(session, "sample", text=text)
    start = field(ask(session, "judge", text=text), "control", "templates", "program_start")
    changed = ask(session, "change", text=text, path=start["path"], value=";one more\n" + start["value"])["text"]
    second = ask(session, "sample", text=changed, before=first["lines"])
    assert len(second["changed"]) == 1
    assert second["removed"] == 0


def test_a_cl_file_of_the_users_is_posted_or_refused_by_its_line(session: BuilderSession) -> None:
    import base64

    own = shipped_sample().replace(b"S4000", b"").replace(b"FEDRAT/MMPM,300.0000", b"FEDRAT/MMPM,WRONG")
    content = base64.b64encode(own).decode()
    found = ask(session, "sample", text=begun(session), cl=content, clName="own.cls")
    assert not found["passed"]
    line = own[: own.index(b"WRONG")].count(b"\n") + 1
    assert line in [each["line"] for each in found["problems"]]


def test_it_is_saved_only_where_nothing_is_lost(session: BuilderSession, tmp_path: Path) -> None:
    text = begun(session)
    saved = ask(session, "save", text=text, name="ours.toml", seen="")
    assert Path(saved["saved"]) == tmp_path / "ours.toml"
    assert load_machine(tmp_path / "ours.toml").name == "Ours"
    assert ask(session, "save", text=text + "#\n", name="ours.toml", seen="")["why"] == "exists"
    opened = BuilderSession(tmp_path, "ours.toml")
    seen = opened.start()["seen"]
    (tmp_path / "ours.toml").write_text(text + "# by hand\n", encoding="utf-8")
    assert ask(opened, "save", text=text, name="ours.toml", seen=seen)["why"] == "changed"
    assert (tmp_path / "ours.toml").read_text(encoding="utf-8") == text + "# by hand\n"
    assert ask(opened, "save", text=text, name="ours.toml", seen=seen, replace=True)["saved"]
    assert (tmp_path / "ours.toml").read_text(encoding="utf-8") == text


def test_a_name_gets_its_ending(session: BuilderSession, tmp_path: Path) -> None:
    saved = ask(session, "save", text=begun(session), name="ours", seen="")
    assert (saved["name"], Path(saved["saved"])) == ("ours.toml", tmp_path / "ours.toml")
    assert ask(session, "save", text="#", name="ours", seen="")["why"] == "exists"


def test_what_is_saved_can_be_opened_again(session: BuilderSession, tmp_path: Path) -> None:
    for size, saved in ((MOST_LETTERS, True), (MOST_LETTERS + 1, False)):
        name = f"long{size}.toml"
        found = ask(session, "save", text="#" * size, name=name, seen="")
        assert bool(found["saved"]) is saved
        assert (tmp_path / name).exists() is saved
    assert "PAG213" in found["problems"][0]
    assert BuilderSession(tmp_path, f"long{MOST_LETTERS}.toml").start()


def test_a_file_keeps_its_line_ends(tmp_path: Path) -> None:
    (tmp_path / "ours.toml").write_bytes(b'extends = "yl569"\r\nname = "Ours"\r\n')
    session = BuilderSession(tmp_path, "ours.toml")
    start = session.start()
    assert "\r" not in start["text"]
    changed = ask(session, "change", text=start["text"], path=["description"], value="new")["text"]
    assert ask(session, "save", text=changed, name="ours.toml", seen=start["seen"])["saved"]
    assert (tmp_path / "ours.toml").read_bytes().count(b"\r\n") == 3


@pytest.mark.third
@pytest.mark.parametrize(
    ("above", "below"),
    [
        ("", "\r\n# dos\r\n"),
        ("", "\n# unix"),
        ("# unix\n\r\n\n", "\n# dos\r\n"),
        ("# dos\r\n# unix\n", "\r\n# dos"),
    ],
)
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_a_line_that_is_not_changed_is_saved_as_it_was(tmp_path: Path, mark: str, above: str, below: str) -> None:
    before, after = (f'{mark}extends = "yl569"\r\n{above}name = "{name}"{below}' for name in "bc")
    (tmp_path / "ours.toml").write_bytes(before.encode())
    session = BuilderSession(tmp_path, "ours.toml")
    start = session.start()
    changed = ask(session, "change", text=start["text"], path=["name"], value="c")["text"]
    assert ask(session, "save", text=changed, name="ours.toml", seen=start["seen"])["saved"]
    assert (tmp_path / "ours.toml").read_bytes() == after.encode()


@given(
    st.lists(st.tuples(st.sampled_from(["", "a", "b", "# c"]), st.sampled_from(["\n", "\r\n"])), max_size=8),
    st.sampled_from(["", "\ufeff"]),
    st.sampled_from(["", "end"]),
)
def test_a_text_that_is_not_changed_is_saved_to_the_letter(lines: list[tuple[str, str]], mark: str, end: str) -> None:
    raw = mark + "".join(map("".join, lines)) + end
    assert "\r" not in page_text(raw)
    assert file_text(page_text(raw), raw) == raw


@pytest.mark.third
@pytest.mark.parametrize(
    "name", ["our mill (2).toml", "[a],b&c.toml", ".ours.toml", "-ours.toml", "铣床.toml", "a.b.toml"]
)
def test_a_file_that_is_opened_can_be_saved_under_its_name(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text('extends = "yl569"\nname = "x"\n', encoding="utf-8")
    session = BuilderSession(tmp_path, name)
    start = session.start()
    text = start["text"].replace("x", "y")
    assert ask(session, "save", text=text, name=name, seen=start["seen"])["saved"]
    assert ask(BuilderSession(tmp_path), "save", text=text, name=f"new {name}", seen="")["saved"]
    assert (tmp_path / name).read_text(encoding="utf-8") == text


@pytest.fixture
def outside(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("outside")


def link(place: Path, target: Path) -> None:
    try:
        place.symlink_to(target)
    except OSError:
        pytest.skip("this system makes no links")


@pytest.mark.parametrize("is_there", [True, False])
def test_nothing_is_written_through_a_link(
    session: BuilderSession, tmp_path: Path, outside: Path, is_there: bool
) -> None:
    target = outside / "target.toml"
    if is_there:
        target.write_text("x", encoding="utf-8")
    link(tmp_path / "ours.toml", target)
    for replace in (False, True):
        found = ask(session, "save", text="y", name="ours.toml", seen="", replace=replace)
        assert (found["saved"], found["why"]) == ("", "cannot")
        assert "link" in found["problems"][0]
    assert [each.read_text(encoding="utf-8") for each in outside.iterdir()] == ["x"] * is_there
    with pytest.raises(InputError, match="link"):
        BuilderSession(tmp_path, "ours.toml").start()


def test_a_link_within_the_folder_is_a_file_of_it(tmp_path: Path) -> None:
    (tmp_path / "true.toml").write_text('extends = "yl569"\nname = "x"\n', encoding="utf-8")
    link(tmp_path / "ours.toml", tmp_path / "true.toml")
    session = BuilderSession(tmp_path, "ours.toml")
    assert ask(session, "save", text="y", name="ours.toml", seen=session.start()["seen"])["saved"]
    assert (tmp_path / "true.toml").read_text(encoding="utf-8") == "y"


@pytest.mark.parametrize("make", ["mkfifo", "mkdir"])
def test_what_is_no_file_is_neither_opened_nor_written(session: BuilderSession, tmp_path: Path, make: str) -> None:
    if not hasattr(os, make):
        pytest.skip("this system has no such thing")
    getattr(os, make)(tmp_path / "ours.toml")
    with pytest.raises(InputError, match=r"regular file|folder"):
        BuilderSession(tmp_path, "ours.toml").start()
    assert ask(session, "save", text="y", name="ours.toml", seen="", replace=True)["why"] == "cannot"


def test_a_body_that_is_no_file_hangs_nothing(session: BuilderSession, tmp_path: Path) -> None:
    if not hasattr(os, "mkfifo"):
        pytest.skip("this system has no pipes with names")
    os.mkfifo(tmp_path / "body.stl")
    text = begun(session) + '[[body]]\nname = "t"\nlink = "bed"\nshape = "file"\nfile = "body.stl"\n'
    (tmp_path / "machine.toml").write_text(text, encoding="utf-8")
    assert "is not a regular file" in ask(session, "judge", text=text)["remark"]


@pytest.mark.third
@pytest.mark.parametrize("name", shipped_machines())
def test_another_control_and_back_leaves_no_trace(session: BuilderSession, name: str) -> None:
    text = begun(session, name)
    own = field(ask(session, "judge", text=text), "control", "extends")["value"]
    other = "haas_ngc" if own != "haas_ngc" else "sinumerik_840d"
    changed = ask(session, "change", text=text, path=["control", "extends"], value=other)
    told = field(changed, "control", "extends")
    assert (told["value"], told["inherited"], told["own"]) == (other, own, True)
    assert ask(session, "change", text=changed["text"], path=["control", "extends"], value=own)["text"] == text
    assert ask(session, "change", text=changed["text"], path=["control", "extends"], value=None)["text"] == text


def test_a_setting_of_another_control_is_inherited_from_that(session: BuilderSession) -> None:
    text = 'extends = "dmu65"\nname = "x"\n\n[control]\nextends = "haas_ngc"\n'
    for path in (["control", "extension"], ["control", "block_numbers", "letter"]):
        told = field(ask(session, "judge", text=text), *path)
        assert told["value"] == told["inherited"]
        assert not told["own"]


@pytest.mark.third
@pytest.mark.parametrize(
    ("value", "shown"),
    [("inf", "inf"), ("2020-01-01", "2020-01-01"), ("[1, 2]", "[1, 2]"), ("[{ a = 1 }]", "[{ a = 1 }]"),
     ("9007199254740993", "9007199254740993"), ("1e3", 1000.0), ("true", True)],
)  # fmt: skip
def test_what_a_field_cannot_hold_is_shown_as_the_text_has_it(session: BuilderSession, value: str, shown: Any) -> None:
    text = f'extends = "yl569"\nname = "x"\n\n[spindle]\nmax_rpm = {value}\ndirection = {value}\n'
    found = ask(session, "judge", text=text)
    assert field(found, "spindle", "max_rpm")["value"] == shown
    if value != "1e3":
        assert any(each["path"] == ["spindle", "max_rpm"] for each in found["problems"])


@pytest.mark.third
@pytest.mark.parametrize(
    "name",
    [
        "../ours.toml",
        "/tmp/ours.toml",
        "ours.py",
        "",
        "a/b.toml",
        "C:ours.toml",
        ".toml",
        "NUL.toml",
        "a\\b.toml",
        "a\n.toml",
        "a.TOML",
    ],
)
def test_nothing_is_saved_elsewhere(session: BuilderSession, tmp_path: Path, name: str) -> None:
    assert ask(session, "save", text="", name=name, seen="")["why"] == "name"
    assert list(tmp_path.iterdir()) == []


def test_a_definition_reaches_only_what_lies_below_it(session: BuilderSession, tmp_path: Path) -> None:
    (tmp_path.parent / "secret.toml").write_text('name = "secret"\n', encoding="utf-8")
    found = ask(session, "judge", text='extends = "../secret.toml"\n')
    assert found["problems"]
    assert "secret.toml" not in str(found["pages"])
    (tmp_path / "base.toml").write_text('extends = "yl569"\n', encoding="utf-8")
    assert ask(session, "judge", text='extends = "base.toml"\nname = "x"\n')["problems"] == []


def test_requests_that_the_page_does_not_make_are_refused(session: BuilderSession) -> None:
    assert session.answer("shutdown", {}) is None
    requests: list[tuple[str, dict[str, Any]]] = [
        ("judge", {"text": 5}), ("change", {"text": "", "path": []}),
        ("change", {"text": "", "path": [["a"]], "value": 1}),
        ("change", {"text": "", "path": ["a"], "value": {"b": 1}}), ("change", {"text": "", "move": "X", "by": 7}),
        ("begin", {"base": "../x"}), ("begin", {"chain": "x", "control": "haas_ngc"}),
        ("sample", {"text": "", "before": "x"}), ("save", {"text": [], "name": "a.toml"}),
    ]  # fmt: skip
    for what, asked in requests:
        with pytest.raises(RequestError):
            session.answer(what, asked)


def test_a_file_that_cannot_be_read_is_told_before_anything_is_served(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        BuilderSession(tmp_path, "missing.toml").start()
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        BuilderSession(tmp_path, "binary.toml").start()


#: Of each kind of field, a value that no definition has.
OTHERS: dict[str, Any] = {
    "text": "zz", "lines": ";one\n", "number": 12.5, "whole": 7, "vector": [1, 2, 3], "interval": [-1.5, 2.5],
}  # fmt: skip


@pytest.mark.parametrize("base", ["dmu65", ""])
def test_every_field_can_be_set_and_taken_back(session: BuilderSession, base: str) -> None:
    """In a definition that extends and in a whole one: each change shows in its field, and leaves no trace."""
    whole = machine_library().joinpath("matsuura_mx330.toml").read_text(encoding="utf-8")
    text = f'extends = "{base}"\nname = "x"\n' if base else whole
    fields = [each for page in ask(session, "judge", text=text)["pages"].values() for each in page]
    assert len(fields) > 100
    for each in fields[:: 1 if base else 3]:
        value = OTHERS.get(each["kind"], not each["value"])
        if each["kind"] == "choice":
            value = next(choice for choice in each["choices"] if choice != each["value"])
        if each["path"] in (["control", "extends"], ["name"]):
            continue
        path = [(step[0],) if isinstance(step, list) else step for step in each["path"]]
        changed = with_value(text, tuple(path), value)
        assert value_of(changed, each["path"]) == value
        back = with_value(changed, tuple(path), each["value"]) if each["own"] else without_value(changed, tuple(path))
        assert back == text


def value_of(text: str, path: list[Any]) -> Any:
    found: Any = tomllib.loads(text)
    for step in path:
        found = next(item for item in found if item["name"] == step[0]) if isinstance(step, list) else found[step]
    return found


def test_what_is_saved_has_its_schema_beside_it(session: BuilderSession, tmp_path: Path) -> None:
    text = begun(session)
    assert ask(session, "save", text=text, name="ours.toml", seen="")["saved"]
    assert (tmp_path / file_name("machine")).read_text(encoding="utf-8") == schema_text("machine")
    (tmp_path / file_name("machine")).unlink()
    assert ask(session, "save", text=text.removeprefix(first_line("machine")), name="other.toml", seen="")["saved"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["other.toml", "ours.toml"]
