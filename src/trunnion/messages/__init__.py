"""The texts of all messages: data that a code, a variant and named parameters choose and fill in.

The files of ``en`` hold for each code the variants of its message: ``VARIANT.what`` is the fault, ``VARIANT.cure`` how
to correct it. Another language is another folder with the same names (decision 0018); a text that it lacks is English.
A text is a template:

    {name}, {name:.3f}           a parameter, with a format; of a wording its fault, and its cure by {name:cure}
    {count:# line|# lines}       a number with what it counts: its forms for one and for more, or one for all
    {setting:tool=5}             what a user may set, in the words of who asks (``Words``);
    {argument:trust=X}           so are arguments, and arguments that are switched on
    {switch:force}

A file is read when a text of it is asked for, never before.

What definitions and the code say in English where it stands, such as what a setting means, is in the catalogue
``declared`` of other languages: by its subject and a digest of the English text, since anybody's definition may say
something else of the same subject.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import cache, lru_cache
from numbers import Integral, Real
from string import Formatter
from types import MappingProxyType
from typing import Any, Final, Literal, Self, TypeAlias

from trunnion.records import dataclass

#: The file of each kind of code; what is no such kind is the key of a check.
CATALOGUES: Final = {
    "ARG": "arguments",
    "BAT": "batch",
    "CL": "cl",
    "CNV": "conversion",
    "CTL": "controls",
    "DEF": "definitions",
    "FIL": "files",
    "HOK": "hooks",
    "IMP": "impeller",
    "NC": "programs",
    "PAG": "pages",
    "PLC": "placing",
    "PLN": "planning",
    "PRJ": "projects",
    "RCH": "capability",
    "SIM": "simulation",
    "TWN": "twin",
    "comparison": "comparison",
    "decision": "decisions",
    "foreign": "foreign",
    "kinematics": "kinematics",
    "report": "report",
    "results": "results",
    "sheet": "sheet",
    "survey": "survey",
    "terminal": "terminal",
}

#: The languages that there are catalogues of, the one that has all texts first.
LANGUAGES: Final = ("en", "zh", "de")
ENGLISH: Final = LANGUAGES[0]

#: The files of what checks say, of sentences that stand around others, and of parts that stand in others.
CHECKS: Final = "checks"
AROUND: Final = "around"
PHRASES: Final = "phrases"

#: The file of what stands in English where it is declared.
DECLARED: Final = "declared"

Part: TypeAlias = Literal["what", "cure"]
Parameters: TypeAlias = tuple[tuple[str, object], ...]

_NONE: Final[Mapping[str, object]] = MappingProxyType({})


class Words:
    """The language of who asks, and how what a user may set is called there: here in the words of the library."""

    language: str = ENGLISH

    def setting(self, name: str, value: str) -> str:
        """Return a setting with a value."""
        return f"setting {name}={value}"

    def argument(self, name: str, value: str) -> str:
        """Return an argument with a value."""
        return f"argument {name}={value}"

    def switch(self, name: str) -> str:
        """Return an argument that is switched on."""
        return f"{name}=True"


LIBRARY: Final = Words()


class _TranslatedWords(Words):
    """The words of the library in another language."""

    def __init__(self, language: str) -> None:
        self.language = language


@cache
def library_words(language: str) -> Words:
    """Return the words of the library in a language."""
    return LIBRARY if language == ENGLISH else _TranslatedWords(language)


@dataclass(frozen=True, slots=True, init=False, repr=False)
class Wording:
    """What is said, as data: a text of the catalogues and what is filled in.

    code        such as ``CL110``; the key of the check that says it, or ``all``
                for what all checks say; or ``comparison``
    variant     which text of the code; empty: the parameters ``what`` and ``cure`` are the text, which is another's
    parameters  numbers, texts and other wordings by name, in alphabetical order
    around      sentences that stand around it, the inner one first: their names and their parameters
    """

    code: str
    variant: str
    parameters: Parameters
    around: tuple[tuple[str, Parameters], ...]

    def __init__(self, code: str, variant: str, /, **parameters: object) -> None:
        object.__setattr__(self, "code", code)
        object.__setattr__(self, "variant", variant)
        object.__setattr__(self, "parameters", _plain(parameters))
        object.__setattr__(self, "around", ())

    @property
    def what(self) -> str:
        """The fault, in English and in the words of the library."""
        return self.text("what")

    @property
    def cure(self) -> str:
        """How to correct it; empty if there is nothing to say."""
        return self.text("cure")

    def __str__(self) -> str:
        return self.what

    def __repr__(self) -> str:
        """Return what a notebook shows of it, in records too: the data would hide what is said."""
        return f"Wording({self.what!r})"

    def text(self, part: Part, words: Words = LIBRARY) -> str:
        """Return the fault or its cure, in the language and the words of who asks."""
        return _text(self, part, words)

    def within(self, sentence: str, /, **parameters: object) -> Self:
        """Return the same within another sentence of the catalogue ``around``, which has it as ``{what}``."""
        return self._changed(self.parameters, (*self.around, (sentence, _plain(parameters))))

    def with_cure(self) -> "Wording":
        """Return the fault with its cure, as one sentence."""
        return phrase("with_cure", fault=self) if self.cure else self

    def parameter(self, name: str) -> object:
        """Return a parameter; None if there is none of the name."""
        return dict(self.parameters).get(name)

    def bare(self) -> Self:
        """Return the same without sentences around it."""
        return self._changed(self.parameters, ())

    def of_key(self, path: str) -> Self:
        """Return the same of a key of a definition; of the whole definition if the path is empty."""
        return self.within("of_key", key=path) if path else self.within("of_definition")

    def with_parameters(self, **parameters: object) -> Self:
        """Return the same with other values of some parameters, or with more of them."""
        return self._changed(_plain({**dict(self.parameters), **parameters}), self.around)

    def changed(self, change: Callable[[str], str]) -> Self:
        """Return the same with each text that is filled in changed by a function."""
        return self._changed(
            _changed(self.parameters, change), tuple((name, _changed(found, change)) for name, found in self.around)
        )

    def _changed(
        self,
        parameters: Parameters,
        around: tuple[tuple[str, Parameters], ...],
    ) -> Self:
        other = type(self)(self.code, self.variant)
        object.__setattr__(other, "parameters", parameters)
        object.__setattr__(other, "around", around)
        return other


def phrase(variant: str, /, **parameters: object) -> Wording:
    """Return a part of other sentences, of the catalogue ``phrases``: one that goes into a parameter."""
    return Wording("", variant, **parameters)


def texts(wordings: Iterable[Wording]) -> tuple[str, ...]:
    """Return what wordings say in English, as data have it."""
    return tuple(map(str, wordings))


def joined(wordings: Iterable[Wording], words: Words = LIBRARY) -> str:
    """Return what wordings say, one behind the other, without those that say nothing."""
    texts = tuple(filter(None, (wording.text("what", words) for wording in wordings)))
    return Wording("terminal", "joined", texts=texts).text("what", words) if len(texts) > 1 else "".join(texts)


def foreign(what: str, cure: str = "", code: str = "") -> Wording:
    """Return a text that is in no catalogue, since it is that of others: of a hook, or of a program without a code for
    it.
    """
    return Wording(code, "", what=what, cure=cure)


class _Collected(Words):
    """Collects the settings that a text names."""

    def __init__(self) -> None:
        self.found: list[tuple[str, str]] = []

    def setting(self, name: str, value: str) -> str:
        """Keep a setting with its value."""
        self.found.append((name, value))
        return ""


def declared(english: str, *subject: str) -> Wording:
    """Return a text that stands in English where it is declared; other languages have it in the catalogue
    ``declared``.

    subject  where it is there, such as ``meanings``, ``tool``
    """
    return Wording("", "", what=english, cure="", declared=subject) if english else foreign("")


def word_said(text: str) -> Wording:
    """Return a word of the library that results print, such as a kind or an outcome."""
    return declared(text, "words")


def digest(text: str) -> str:
    """Return what tells one English text from another."""
    from hashlib import sha256  # who reads English does without it

    return sha256(text.encode()).hexdigest()[:6]


def settings_in_cure(wording: Wording) -> tuple[tuple[str, str], ...]:
    """Return the settings that a cure names, in their order: names and values, such as ``OPERATION:RPM``."""
    words = _Collected()
    wording.text("cure", words)
    return tuple(words.found)


def filled_in(template: str, words: Words = LIBRARY, parameters: Mapping[str, object] = _NONE) -> str:
    """Return a template with its parameters.

    >>> filled_in("{count:# line is|# lines are} longer than {most:.1f} mm", LIBRARY, {"count": 2, "most": 0.25})
    '2 lines are longer than 0.2 mm'
    """
    return "".join(
        literal + ("" if field is None else _field(field, spec or "", words, parameters))
        for literal, field, spec, _ in _parsed(template)
    )


@cache
def catalogue(language: str, name: str) -> dict[str, Any]:
    """Return a file of texts: the variants of each code, and their parts; none where a language has no such file."""
    import tomllib  # most runs have nothing to say
    from pkgutil import get_data  # importlib.resources imports ten times as much

    try:
        found = get_data(__name__, f"{language}/{name}.toml")
    except OSError:
        if language == ENGLISH:
            raise
        return {}
    return tomllib.loads((found or b"").decode())


def said_in(language: str, name: str, *path: str, english: str = "") -> str:
    """Return a text without parameters: of a file, in a language, else in English.

    english  what it is where no catalogue has it: English texts stand where they are declared
    """
    for each in dict.fromkeys((language, ENGLISH)):
        try:
            found = _entry(each, name, path)
        except (LookupError, OSError, ValueError, TypeError):
            continue
        if isinstance(found, str) and found:
            return found
    return english


def _entry(language: str, name: str, path: Iterable[str]) -> Any:
    found: Any = catalogue(language, name)
    for key in path:
        found = found[key]
    return found


@lru_cache(4096)
def _text(wording: Wording, part: Part, words: Words) -> str:
    text = _inner_text(wording, part, words)
    if part == "what":
        for sentence, parameters in wording.around:
            around = _filled_entry(words, AROUND, (sentence,), {**dict(parameters), "what": text})
            text = f"{text} ({_unfilled(sentence, parameters)})" if around is None else around
    return text


def _inner_text(wording: Wording, part: Part, words: Words) -> str:
    parameters = dict(wording.parameters)
    if not wording.variant:
        text = str(parameters[part])
        subject = parameters.get("declared")
        if not (text and isinstance(subject, tuple)) or words.language == ENGLISH:
            return text
        return said_in(words.language, DECLARED, *map(str, subject), digest(text), english=text)
    if wording.code:
        file = CATALOGUES.get(wording.code.rstrip("0123456789"), CHECKS)
        found = _filled_entry(words, file, (wording.code, wording.variant, part), parameters)
    else:
        found = _filled_entry(words, PHRASES, (wording.variant,), parameters)
    if found is None:
        return _unfilled(wording.variant, wording.parameters) if part == "what" else ""
    return found


def _filled_entry(words: Words, name: str, path: tuple[str, ...], parameters: Mapping[str, object]) -> str | None:
    """Return the first text that is there and fits: that of the language, else the English one."""
    for language in dict.fromkeys((words.language, ENGLISH)):
        try:
            return filled_in(_entry(language, name, path), words, parameters)
        except (LookupError, OSError, ValueError, TypeError):
            continue
    return None


def _unfilled(variant: str, parameters: Parameters) -> str:
    """Return what is known of a message whose text is missing or does not fit: a fault of the catalogue hides no
    problem.
    """
    return " ".join((variant.replace("_", " "), *(f"{name}={value}" for name, value in parameters)))


@cache
def _parsed(template: str) -> tuple[tuple[str, str | None, str | None, str | None], ...]:
    return tuple(Formatter().parse(template))


def _field(field: str, spec: str, words: Words, parameters: Mapping[str, object]) -> str:
    if field in ("setting", "argument"):
        name, _, given = filled_in(spec, words, parameters).partition("=")
        return words.setting(name, given) if field == "setting" else words.argument(name, given)
    if field == "switch":
        return words.switch(filled_in(spec, words, parameters))
    value = parameters[field]
    if isinstance(value, Wording):
        return value.text("cure" if spec == "cure" else "what", words)
    if isinstance(value, tuple):
        return spec.join(each.text("what", words) if isinstance(each, Wording) else each for each in value)
    if "|" in spec or "#" in spec:
        one, _, more = spec.partition("|")
        return (one if value == 1 else more or one).replace("#", str(value))
    return format(value, spec)


def _plain(parameters: Mapping[str, object]) -> Parameters:
    return tuple((name, _plain_value(value)) for name, value in sorted(parameters.items()))


def _plain_value(value: object) -> object:
    """Return a number, a text or a wording, so that messages can be compared, kept and sent to other processes."""
    if type(value) in (str, int, float, bool, Wording):
        return value
    if isinstance(value, tuple):
        return tuple(map(_plain_value, value))
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        return float(value)
    return str(value)


def _changed(parameters: Parameters, change: Callable[[str], str]) -> Parameters:
    def changed(value: object) -> object:
        if isinstance(value, tuple):
            return tuple(map(changed, value))
        return (
            change(value) if isinstance(value, str) else value.changed(change) if isinstance(value, Wording) else value
        )

    return tuple((name, changed(value)) for name, value in parameters)
