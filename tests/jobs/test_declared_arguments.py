"""Arguments of the library are those that the commands declare: names, types and what they are by default."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Literal, get_args, get_origin

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.batch import run_batch
from trunnion.cli import main
from trunnion.errors import InputError
from trunnion.jobs.arguments import EARLIER, LIBRARY, PostArguments, SimulateArguments, taken
from trunnion.jobs.registry import JOBS
from trunnion.jobs.twin.recording import record
from trunnion.jobs.twin.serving import serve_twin
from trunnion.options.groups import BODIES, CUTTING
from trunnion.options.kinds import Choice, Number, Switch

#: What the command line has of a simulation in the same run, and the library in ``simulation``.
_OF_SIMULATION: Final = {"simulate", "project", *(each.name for each in (*BODIES, *CUTTING))}

#: Arguments that only the library has, besides those of all: an address of a machine that moves is up to the command,
#: and the files that a command writes besides those of its batch.
_LIBRARY: Final = {"observer", "written", *LIBRARY}


@dataclass(frozen=True)
class Front:
    """A function of the library.

    without  options of its command that it does not have
    """

    function: Callable[..., Any]
    command: str
    without: frozenset[str] = frozenset()


FRONTS: Final = [
    Front(trunnion.post, "post", frozenset(_OF_SIMULATION)),
    Front(trunnion.convert, "convert"),
    Front(trunnion.place, "place"),
    Front(trunnion.verify, "verify"),
    Front(trunnion.simulate, "simulate"),
    Front(trunnion.reach, "reach"),
    Front(trunnion.fit, "fit"),
    Front(trunnion.sensitivity, "sensitivity"),
    Front(trunnion.write_view, "view", frozenset({"nodes", "rate", "secure", "trust", "user"})),
    Front(serve_twin, "twin"),
    Front(record, "record"),
    Front(run_batch, "batch"),
]


def given_of(function: Callable[..., Any]) -> dict[str, Any]:
    """The names and types of what a function takes as ``**given``."""
    found = list(inspect.signature(function).parameters.values())[-1]
    assert found.kind is inspect.Parameter.VAR_KEYWORD, function
    return dict(get_args(found.annotation)[0].__annotations__)


def names_of(function: Callable[..., Any]) -> set[str]:
    """All arguments of a function."""
    return {*list(inspect.signature(function).parameters)[:-1], *given_of(function)}


@pytest.mark.parametrize("front", FRONTS, ids=lambda each: each.command)
def test_functions_have_the_arguments_that_their_commands_declare(front: Front) -> None:
    declared = {each.name for each in JOBS[front.command].options if not each.own} - front.without
    assert names_of(front.function) - _LIBRARY == declared - _LIBRARY


def wrong_type(kind: object, annotation: Any) -> bool:
    """Whether a type of an argument does not go with the kind of its option."""
    parts = [annotation] if get_origin(annotation) is Literal else [*get_args(annotation), annotation]
    words = [word for part in parts if get_origin(part) is Literal for word in get_args(part)]
    if isinstance(kind, Switch):
        return annotation is not bool
    if isinstance(kind, Number):
        return not {int, float} & set(parts)
    return isinstance(kind, Choice) and bool(words) and tuple(words) != kind.words


def test_types_of_arguments_are_those_of_their_options() -> None:
    wrong = [
        f"{front.command}: {option.name}"
        for front in FRONTS
        for option in JOBS[front.command].options
        if (annotation := given_of(front.function).get(option.name)) is not None and wrong_type(option.kind, annotation)
    ]
    assert wrong == []


def test_what_is_not_given_is_what_the_command_has_by_default() -> None:
    found = taken(PostArguments, "post", {"units": "inch"})
    assert (found["settings"], found["strict"], found["hooks"], found["columns"]) == (
        {"cl_units": "inch"},
        False,
        [],
        True,
    )


def test_one_thing_is_said_once() -> None:
    with pytest.raises(InputError, match="zero: error: is the setting zero, which is given too") as error:
        trunnion.post(YL569 / "2_hub_rough.cls", machine="yl569", zero="0,0,50", settings={"zero": (0, 0, 40)})
    assert error.value.problems[0].code == "ARG130"


def test_earlier_names_are_taken_with_a_warning() -> None:
    assert EARLIER == {"libraries": "tool_libraries"}
    earlier: Any = {"libraries": ["tools.toml"]}
    with pytest.warns(FutureWarning, match="'libraries' is now called 'tool_libraries'"):
        found = taken(SimulateArguments, "simulate", earlier)
    assert found["tool_libraries"] == ["tools.toml"]


def test_a_name_that_nothing_has_is_a_type_error_with_the_near_one() -> None:
    with pytest.raises(TypeError, match="verify has no argument 'toleranze'; did you mean 'tolerance'"):
        trunnion.verify("a.mpf", machine="yl569", toleranze=0.1)  # type: ignore[call-arg]


def test_a_value_is_refused_in_the_words_of_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    program = str(YL569 / "2_hub_rough.expected.mpf")
    with pytest.raises(InputError) as caught:
        trunnion.verify(program, machine="yl569", tolerance=-1.0)
    with pytest.raises(SystemExit):
        main(["verify", program, "--machine", "yl569", "--tolerance=-1"])
    said = "is not a tolerance; write a number above 0 and below 1000000, such as 0.001"
    assert said in str(caught.value)
    assert said in capsys.readouterr().err
