"""The command line, taken apart as the registry declares it; nothing else knows argparse."""

import argparse
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final, NoReturn

from trunnion.cli.command_line.help_texts import command_help, overview
from trunnion.cli.command_line.post_mistakes import post_mistake
from trunnion.cli.printing import print_result
from trunnion.cli.terminal_text import error_line, warning_line
from trunnion.jobs.job import Given, Job
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import Setting, Switch, WrongValueError
from trunnion.options.option import Many, Option
from trunnion.wording import nearest_word

#: The code of a command line that cannot be understood, and that of an option with an earlier name.
_USAGE: Final = "ARG120"
_EARLIER: Final = "ARG190"

#: An option in a line, and a list of numbers that begins like one.
_OPTION: Final = re.compile(r"--[a-z][a-z-]*")
_NEGATIVE_LIST: Final = re.compile(r"-[0-9.]+(?:,[-+0-9.eE]+)+")

#: How argparse names numbers of words.
_NARGS: Final = {Many.MAYBE: "?", Many.BARE: "?", Many.ANY: "*", Many.SOME: "+", Many.TWO: 2, Many.LIST: "+"}

_LINE_OF_ALL: Final = "trunnion --help lists them"


def parse(words: Sequence[str]) -> Given:
    """Return the command and what it was given.

    Ends the process after ``--help``, and with exit code 2 where it cannot be understood.
    """
    if not words:
        _fail("trunnion", f"name a command; {_LINE_OF_ALL}")
    if words[0] in ("-h", "--help"):
        _print(overview())
    if words[0] not in JOBS:
        near = nearest_word(words[0], JOBS)
        _fail("trunnion", f"{words[0]!r} is no command; {f'did you mean {near}? ' if near else ''}{_LINE_OF_ALL}")
    job = JOBS[words[0]]
    rest = _with_values(_with_present_names(words[1:], job), job)
    if any(word in ("-h", "--help") for word in rest):
        _print(command_help(job))
    if wrong := _unknown_option(rest, job):
        _fail_command(job, _no_option(wrong, job))
    found, unknown = _parser(job).parse_known_args(rest)
    if unknown:
        _fail_command(job, f"{unknown[0]!r} is one argument too many; {_one_too_many(rest, unknown[0], job)}")
    values = vars(found)
    values.pop(_GIVEN, None)
    for option in job.options:
        if option.setting and values[option.name]:
            _add_setting(job, option, values)
    given = Given(job, values)
    if job.name == "post" and (wrong := post_mistake(given)):
        _fail_command(job, wrong)
    return given


def _one_too_many(words: list[str], word: str, job: Job) -> str:
    """Return the cure for an argument that nothing takes."""
    before = words[words.index(word) - 1] if word in words else ""
    bare = next((each.flag for each in job.flags if each.many is Many.BARE and before == f"{each.flag}=-"), "")
    if bare:
        return f"the file of {bare} has a name in .json, or write {bare}={word}"
    return "repeat an option before each of its values, and put a value with blanks in quotes"


def _add_setting(job: Job, option: Option, values: dict[str, Any]) -> None:
    """Put an option that stands for a setting among the settings."""
    if option.setting in dict(values["settings"]):
        _fail_command(job, f"{option.flag} and --set {option.setting}=… are the same: give one of them")
    values["settings"] = [*values["settings"], (option.setting, values[option.name])]


#: Values of options that have one, by their names, while a command line is parsed.
_GIVEN: Final = "given once"


class _Parser(argparse.ArgumentParser):
    """Ends with one line."""

    def error(self, message: str) -> NoReturn:
        _fail(self.prog, message)


def _parser(job: Job) -> _Parser:
    parser = _Parser(prog=f"trunnion {job.name}", add_help=False)
    groups: dict[str, Any] = {}
    for option in job.options:
        either = option.either
        if either and either not in groups:
            groups[either] = parser.add_mutually_exclusive_group(required=either.endswith("!"))
        target = groups[either] if either else parser
        target.add_argument(*_names(option), **_details(option))
    return parser


def _names(option: Option) -> list[str]:
    return [option.flag] if option.flag else [option.name]


def _details(option: Option) -> dict[str, Any]:
    """Return what argparse is told of an option."""
    found: dict[str, Any] = {"default": option.empty}
    if option.flag:
        found |= {"dest": option.name, "required": option.required}
    if isinstance(option.kind, Switch):
        return {**found, "action": "store_const", "const": option.kind.value}
    found |= {"type": _type(option), "metavar": option.value_name}
    if isinstance(option.kind, Setting):
        return {**found, "action": _AddSetting}
    if option.many is Many.REPEAT:
        return {**found, "action": "append"}
    if option.many is Many.ONE and option.flag:
        found["action"] = _Once
    if option.many is Many.LIST:
        found["action"] = "extend"
    if option.many in _NARGS:
        found["nargs"] = _NARGS[option.many]
    if option.many in (Many.MAYBE, Many.BARE) and option.flag:
        found["const"] = "-"
    return found


def _type(option: Option) -> Callable[[str], Any]:
    def parsed(text: str) -> Any:
        try:
            return option.kind.parse(text)
        except WrongValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return parsed


class _Once(argparse.Action):
    """Takes a value; another one after it is refused, for the first would be lost."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        given: dict[str, Any] = vars(namespace).setdefault(_GIVEN, {})
        # Compared in lists, which take a value for equal to itself: one that is no number is not.
        if [given.setdefault(self.dest, values)] != [values]:
            raise argparse.ArgumentError(self, f"has two values, {given[self.dest]} and {values}; write one")
        setattr(namespace, self.dest, values)


class _AddSetting(argparse.Action):
    """Collects the settings; one that is given two values is refused, for the first would be lost."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        settings: list[tuple[str, str]] = list(getattr(namespace, self.dest))
        (key, value), before = values, dict(settings)
        if before.get(key, value) != value:
            once = f"{key}={before[key]},OPERATION:VALUE where a setting differs by operation"
            raise argparse.ArgumentError(
                self, f"{key} has two values, {before[key]!r} and {value!r}; write one, or {once}"
            )
        setattr(namespace, self.dest, [*settings, (key, value)])


def _with_present_names(words: Iterable[str], job: Job) -> list[str]:
    """Return the words with options of earlier names under their present ones, of which a warning says so."""
    earlier = {alias: option.flag for option in job.options for alias in option.aliases}
    found: list[str] = []
    for word in words:
        name, equals, value = word.partition("=")
        if name in earlier and "--" not in found:
            what = f"{name} is now called {earlier[name]}; the next version no longer knows {name}"
            print(warning_line(f"trunnion {job.name}", what, _EARLIER), file=sys.stderr)
            word = f"{earlier[name]}{equals}{value}"
        found.append(word)
    return found


def _with_values(words: Iterable[str], job: Job) -> list[str]:
    """Words with values that argparse would take for something else joined to their options.

    A list of numbers may begin with a minus: ``--zero -31,0,5``. An option that had no value in earlier versions takes
    the name of a file of data only: in ``explain --json CL110`` the code is not its value.
    """
    bare = {each.flag for each in job.flags if each.many is Many.BARE}
    streams = {each.flag for each in job.flags if each.many is Many.MAYBE}
    joined: list[str] = []
    for word in words:
        last = joined[-1] if joined else ""
        is_value = (last in bare and word.lower().endswith(".json")) or (last in bare | streams and word == "-")
        if is_value or (_OPTION.fullmatch(last) and _NEGATIVE_LIST.fullmatch(word)):
            joined[-1] += f"={word}"
            continue
        if last in bare:
            joined[-1] += "=-"
        joined.append(word)
    return joined


def _unknown_option(words: Iterable[str], job: Job) -> str:
    """Return the first word that looks like an option but is not one, nor an abbreviation of one; empty if there is
    none.
    """
    known = ["--help", *(each.flag for each in job.flags)]
    for word in words:
        name = word.partition("=")[0]
        if name == "--":
            break
        if name.startswith("--") and not any(flag.startswith(name) for flag in known):
            return name
    return ""


def _no_option(name: str, job: Job) -> str:
    """Return what is wrong with an option that a command lacks, and the cure."""
    near = nearest_word(name, [each.flag for each in job.flags])
    asked = f"did you mean {near}? " if near else ""
    others = [each.name for each in JOBS.values() if any(option.flag == name for option in each.flags)]
    elsewhere = f"trunnion {' and '.join(others[:3])} {'has' if len(others) == 1 else 'have'} it; " if others else ""
    return f"{name} is no option of this command; {elsewhere or asked}trunnion {job.name} --help lists its options"


def _fail_command(job: Job, message: str) -> NoReturn:
    _fail(f"trunnion {job.name}", message)


def _fail(where: str, message: str) -> NoReturn:
    print(error_line(where, message, _USAGE), file=sys.stderr)
    raise SystemExit(2)


def _print(text: str) -> NoReturn:
    print_result(text, end="")
    raise SystemExit(0)
