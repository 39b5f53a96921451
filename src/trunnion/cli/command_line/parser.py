"""The command line, taken apart as the registry declares it; nothing else knows argparse."""

import argparse
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, NoReturn

from trunnion.cli.command_line.help_texts import command_help, overview, signature
from trunnion.cli.command_line.language import LANGUAGE, is_language_option
from trunnion.cli.command_line.post_mistakes import post_mistake
from trunnion.cli.printing import print_result
from trunnion.errors import Problem, Severity
from trunnion.jobs.job import Given, Job
from trunnion.jobs.registry import JOBS
from trunnion.messages import LANGUAGES, Wording
from trunnion.options.kinds import Choice, Setting, Switch, WrongValueError
from trunnion.options.option import Many, Option
from trunnion.wording import nearest_word

#: An option in a line, and a list of numbers that begins like one.
_OPTION: Final = re.compile(r"--[a-z][a-z-]*")
_NEGATIVE_LIST: Final = re.compile(r"-[0-9.]+(?:,[-+0-9.eE]+)+")

#: An option of one letter, which no command has, and a number.
_SHORT_OPTION: Final = re.compile(r"-[A-Za-z]")
_NUMBER: Final = re.compile(r"[-+]?[0-9.]+")

#: How argparse names numbers of words.
_NARGS: Final = {Many.MAYBE: "?", Many.ANY: "*", Many.SOME: "+", Many.TWO: 2, Many.LIST: "+"}

#: Values of options that have one, by their names, while a command line is parsed.
_GIVEN: Final = "given once"


def parse(words: Sequence[str]) -> Given:
    """Return the command and what it was given.

    Ends the process after ``--help``, and with exit code 2 where it cannot be understood.
    """
    if wrong := _wrong_language(words):
        _fail("trunnion", wrong)
    if not words:
        _fail("trunnion", Wording("ARG120", "no_command"))
    if words[0] in ("-h", "--help"):
        _print(overview())
    if words[0] == "help":
        _print(command_help(JOBS[words[1]]) if words[1:] and words[1] in JOBS else overview())
    if words[0] not in JOBS:
        _fail("trunnion", _no_command(words[0]))
    job = JOBS[words[0]]
    rest = _with_values(_with_present_names(words[1:], job), job)
    if any(word in ("-h", "--help") for word in rest):
        _print(command_help(job))
    if wrong := _unclear_option(rest, job):
        _fail_command(job, wrong)
    values = _values(rest, job)
    typed = {each.setting: each for each in job.options if each.setting and values[each.name]}
    for option in typed.values():
        _add_setting(job, option, values)
    given = Given(job, values, typed)
    if job.name == "post" and (mistake := post_mistake(given)):
        _fail_command(job, mistake)
    return given


def _values(words: list[str], job: Job) -> dict[str, Any]:
    """Return the value of each option by its name; all that must be there is there."""
    found, parser = argparse.Namespace(), _parser(job)
    try:
        unknown = parser.parse_known_args(words, found)[1]
    except argparse.ArgumentError as error:
        if error.argument_name is not None:
            _fail_command(job, _of_argument(error, job))
        unknown = []  # something is missing
    values = vars(found)
    values.pop(_GIVEN, None)
    if unknown:
        _fail_command(job, _one_too_many(unknown[0], words, job))
    if missing := [*_missing(values, job)]:
        _fail_command(job, _are_missing(missing, values, job))
    for option in job.options:
        others = [each for each in job.options if each.either and each.either == option.either]
        stated = [each for each in others if values[each.name] not in (None, False, [])]
        if len(stated) > 1:
            _fail_command(job, Wording("ARG120", "either", option=stated[1].flag, other=stated[0].flag))
    return values


def _one_too_many(word: str, words: Sequence[str], job: Job) -> Wording:
    """Return what is said of a word that nothing takes: a short option, a number of a list, or any other."""
    if _SHORT_OPTION.match(word):
        return _no_option(word, job)
    if _NUMBER.fullmatch(word):
        before = [each for each in words[: words.index(word)] if _OPTION.fullmatch(each)]
        if before:
            return Wording("ARG120", "number_apart", word=repr(word), option=before[-1])
    return Wording("ARG120", "one_too_many", word=repr(word))


def _missing(values: Mapping[str, Any], job: Job) -> Iterator[str]:
    """Yield what must be given and is not, as it is written."""
    for option in job.arguments:
        if option.many not in (Many.MAYBE, Many.ANY) and values[option.name] in (None, []):
            yield option.value_name
    for option in job.flags:
        if option.required and values[option.name] is None:
            yield signature(option)
    for group in dict.fromkeys(each.either for each in job.flags if each.either.endswith("!")):
        choices = [each for each in job.flags if each.either == group]
        if all(values[each.name] in (None, False) for each in choices):
            yield " or ".join(map(signature, choices))


def _are_missing(missing: Sequence[str], values: Mapping[str, Any], job: Job) -> Wording:
    """Return what is said of what is missing: with an example, or with what took its place."""
    file = values.get("json")
    if file and not file.endswith((".json", "-")):
        return Wording("ARG120", "missing_behind_data", names=tuple(missing), file=file)
    return Wording("ARG120", "missing", names=tuple(missing), example=job.example)


def _no_command(word: str) -> Wording:
    """Return what is said of a command that does not exist."""
    if near := nearest_word(word, JOBS):
        return Wording("ARG120", "unknown_command_but_near", word=repr(word), near=near)
    return Wording("ARG120", "unknown_command", word=repr(word))


def _add_setting(job: Job, option: Option, values: dict[str, Any]) -> None:
    """Put an option that stands for a setting among the settings."""
    if option.setting in dict(values["settings"]):
        _fail_command(job, Wording("ARG120", "option_and_setting", option=option.flag, name=option.setting))
    values["settings"] = [*values["settings"], (option.setting, values[option.name])]


class _Parser(argparse.ArgumentParser):
    """Says nothing itself."""

    def error(self, message: str) -> NoReturn:
        """Raise what concerns no single argument: some are missing, and ``_values`` finds out which."""
        raise argparse.ArgumentError(None, message)


class _WordedError(argparse.ArgumentError):
    """An error with a wording of its own."""

    def __init__(self, action: argparse.Action, wording: Wording) -> None:
        super().__init__(action, str(wording))
        self.wording = wording


class _TypeError(argparse.ArgumentTypeError):
    """A text that is no value of an option."""

    def __init__(self, wording: Wording) -> None:
        super().__init__(str(wording))
        self.wording = wording


def _of_argument(error: argparse.ArgumentError, job: Job) -> Wording:
    """Return what is wrong with an argument."""
    if isinstance(error, _WordedError):
        return error.wording
    name = error.argument_name or ""
    if isinstance(cause := error.__context__, _TypeError):
        return Wording("ARG120", "wrong_value", option=name, value=cause.wording)
    option = next(each for each in job.options if name in (each.flag, each.value_name))
    if isinstance(option.kind, Switch):
        return Wording("ARG120", "value_of_switch", option=name)
    return Wording("ARG120", "no_value", option=name, written=signature(option))


def _parser(job: Job) -> _Parser:
    parser = _Parser(prog=f"trunnion {job.name}", add_help=False, exit_on_error=False)
    for option in job.options:
        parser.add_argument(*_names(option), **_details(option))
    return parser


def _names(option: Option) -> list[str]:
    return [option.flag] if option.flag else [option.name]


def _details(option: Option) -> dict[str, Any]:
    """Return what argparse is told of an option."""
    found: dict[str, Any] = {"default": option.empty}
    if option.flag:
        found["dest"] = option.name
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
    if option.many is Many.MAYBE and option.flag:
        found["const"] = "-"
    return found


def _type(option: Option) -> Callable[[str], Any]:
    def parsed(text: str) -> Any:
        try:
            return option.kind.parse(text)
        except WrongValueError as error:
            raise _TypeError(error.wording) from None

    return parsed


class _Once(argparse.Action):
    """Takes a value; another one after it is refused, for the first would be lost."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        given: dict[str, Any] = vars(namespace).setdefault(_GIVEN, {})
        # Compared in lists, which take a value for equal to itself: one that is no number is not.
        if [given.setdefault(self.dest, values)] != [values]:
            first, second = str(given[self.dest]), str(values)
            raise _WordedError(
                self, Wording("ARG120", "two_values", option=self.option_strings[0], first=first, second=second)
            )
        setattr(namespace, self.dest, values)


class _AddSetting(argparse.Action):
    """Collects the settings; one that is given two values is refused, for the first would be lost."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        settings: list[tuple[str, str]] = list(getattr(namespace, self.dest))
        (key, value), before = values, dict(settings)
        if before.get(key, value) != value:
            said = {"option": self.option_strings[0], "first": repr(before[key]), "second": repr(value)}
            if not _may_differ(key):
                raise _WordedError(self, Wording("ARG120", "written_twice", name=key, **said))
            raise _WordedError(self, Wording("ARG120", "setting_twice", name=key, value=before[key], **said))
        setattr(namespace, self.dest, [*settings, (key, value)])


def _may_differ(key: str) -> bool:
    """Whether operations may differ in a setting; a variable, whose name has a capital, has one value."""
    from trunnion.jobs.inputs.run_settings import RUN_SETTINGS  # a command line without mistakes does without them
    from trunnion.jobs.inputs.settings import BY_OPERATION

    return key in BY_OPERATION or (key.islower() and key not in RUN_SETTINGS)


def _with_present_names(words: Iterable[str], job: Job) -> list[str]:
    """Return the words with options of earlier names under their present ones, of which a warning says so."""
    earlier = {alias: option.flag for option in job.options for alias in option.aliases}
    found: list[str] = []
    for word in words:
        name, equals, value = word.partition("=")
        if name in earlier and "--" not in found:
            wording = Wording("ARG190", "earlier_option", option=name, present=earlier[name])
            _say(f"trunnion {job.name}", wording, Severity.WARNING)
            word = f"{earlier[name]}{equals}{value}"
        found.append(word)
    return found


def _with_values(words: Iterable[str], job: Job) -> list[str]:
    """Words with values that argparse would take for something else joined to their options.

    A list of numbers may begin with a minus: ``--zero -31,0,5``.
    """
    streams = {each.flag for each in job.flags if each.many is Many.MAYBE}
    joined: list[str] = []
    for word in words:
        last = joined[-1] if joined else ""
        if (last in streams and word == "-") or (_OPTION.fullmatch(last) and _NEGATIVE_LIST.fullmatch(word)):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _unclear_option(words: Iterable[str], job: Job) -> Wording | None:
    """Return what is wrong with the first word that looks like an option but is not one, or an abbreviation of several;
    None if there is none.
    """
    known = ["--help", LANGUAGE, *(each.flag for each in job.flags)]
    for word in words:
        name = word.partition("=")[0]
        if name == "--":
            break
        meant = [flag for flag in known if flag.startswith(name)]
        if name.startswith("--") and not meant:
            return _no_option(name, job)
        if name.startswith("--") and len(meant) > 1 and name not in meant:
            return Wording("ARG120", "several_options", option=name, flags=tuple(meant))
    return None


def _wrong_language(words: Sequence[str]) -> Wording | None:
    """Return what is wrong with a language that is none: those that there are have been taken out of the words."""
    before = words[: words.index("--")] if "--" in words else words
    for at, word in enumerate(before):
        name, equals, value = word.partition("=")
        if not is_language_option(name):
            continue
        if not equals and at + 1 == len(before):
            return Wording("ARG120", "no_value", option=LANGUAGE, written=f"{LANGUAGE} {'|'.join(LANGUAGES)}")
        try:
            Choice(LANGUAGES).parse(value if equals else before[at + 1])
        except WrongValueError as error:
            return Wording("ARG120", "wrong_value", option=LANGUAGE, value=error.wording)
    return None


def _no_option(name: str, job: Job) -> Wording:
    """Return what is said of an option that a command lacks."""
    others = [each.name for each in JOBS.values() if any(option.flag == name for option in each.flags)]
    if others:
        variant = "option_of_other" if len(others) == 1 else "option_of_others"
        return Wording("ARG120", variant, option=name, command=job.name, others=tuple(others[:3]))
    flags = [each.flag for each in job.flags]
    short = next((flag for flag in flags if flag[1:].startswith(name)), "") if _SHORT_OPTION.match(name) else ""
    if near := short or nearest_word(name, flags):
        return Wording("ARG120", "unknown_option_but_near", option=name, command=job.name, near=near)
    return Wording("ARG120", "unknown_option", option=name, command=job.name)


def _fail_command(job: Job, wording: Wording) -> NoReturn:
    _fail(f"trunnion {job.name}", wording)


def _fail(where: str, wording: Wording) -> NoReturn:
    _say(where, wording, Severity.ERROR)
    raise SystemExit(2)


def _say(where: str, wording: Wording, severity: Severity) -> None:
    from trunnion.cli.wording import painted_line  # a command line without mistakes does without it

    print(painted_line(Problem(where, 0, wording, severity=severity)), file=sys.stderr)


def _print(text: str) -> NoReturn:
    print_result(text, end="", own=True)
    raise SystemExit(0)
