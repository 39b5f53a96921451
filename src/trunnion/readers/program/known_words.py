"""Words that a definition declares: what codes of the machine builder, macros and probing calls do to a program.

``[control.known]`` maps a word to its effects, separated by commas, and after a colon to what it means. A word that is
an M code acts wherever it stands in a block, and a G code or a name without effect takes only itself out of it. Any
other word begins a block, and the whole block belongs to it.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.duplicate_keys import report_duplicates
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.virtual_control import VirtualControl
from trunnion.readers.program.settings import GIVEN, control_of
from trunnion.readers.program.words_beside import has_other_codes, is_other, without_words
from trunnion.records import dataclass

#: What a word may do.
EFFECTS: Final = (
    "no effect", "comes back", "comes back home", "stop", "optional stop", "tool change", "spindle clockwise",
    "spindle counter-clockwise", "spindle off", "coolant flood", "coolant mist", "coolant through", "coolant off",
    "tcp on", "tcp off", "waits", "door opens", "door closes", "clamp opens", "clamp closes",
    "brake on", "brake off",
)  # fmt: skip

#: Other names of effects.
_ALIKE: Final = {"moves nothing": "no effect"}

#: The effect of a word after which the machine is elsewhere.
HOME: Final = "comes back home"

#: The effect of a word at which the program waits, for the operator or a signal.
WAITS: Final = "waits"

#: Effects that act before the motion of their block; all others act after it.
_BEFORE_MOTION: Final = (
    "spindle clockwise", "spindle counter-clockwise", "coolant flood", "coolant mist", "coolant through", "tcp on",
)  # fmt: skip

#: Effects that are not events of their own: the word itself says what happens.
_SILENT: Final = frozenset(
    {
        "no effect", "comes back", HOME, WAITS, "door opens", "door closes", "clamp opens", "clamp closes",
        "brake on", "brake off",
    }
)  # fmt: skip

#: Effects that no path shows and no CL file asks for: programs are told of them.
_ALTERING: Final = frozenset({"brake on", "brake off"})

#: Kinds of effects of which one excludes another.
_ONE_MODE: Final = ("spindle", "tcp", "door", "clamp", "brake")

#: So many letters and points are shown of a key.
_MOST_LETTERS: Final = 40
_LEADING_ZEROS: Final = re.compile(r"^([GM])0+([0-9])")
_M_CODE: Final = re.compile(r"M0*([0-9]{1,9})")
#: A code with a word right behind it: ``G65P9810``.
_GLUED: Final = re.compile(r"^([GM][0-9]+(?:\.[0-9])?)(?=[A-Z])")
_CODE: Final = re.compile(r"^[GM](?=[0-9])")
_HAS_CODE: Final = re.compile(r"[GM][0-9]")
#: A G code without tenths: one with them is another word.
_G_CODE: Final = re.compile(r"G[0-9]+")
#: Words that may stand among others: a G code, also with a value, or a name with its arguments.
_BESIDE: Final = re.compile(r"G[0-9]+(?:\.[0-9])?(?: [ELPQ][0-9]+)?|[A-Z]{2}[A-Z0-9_]*|[A-Z][0-9]{2,}")
#: Words that call a program: letters of their block are its arguments.
_CALL: Final = re.compile(r"G6[56](?![0-9])|M9[78](?![0-9])|M198(?![0-9])")
_OWN_ARGUMENTS: Final = r"(?:\((?:\"[^\"]*\"|[^()\"]|\([^()]*\))*\)|[ \t]*=[ \t]*(?:\"[^\"]*\"|[-+.0-9]+))?"
_BLOCK_BEGIN: Final = re.compile(r"[ \t]*/?[0-9]?[ \t]*(?:N[0-9]+|[0-9]+(?=[ \t]))?[ \t]*/?[ \t]*")
_TOOL: Final = re.compile(r"(?<![A-Z0-9])T=?[ \t]*([0-9]{1,9})")


#: Whether one of some codes takes positions.
Takes = Callable[[Sequence[str]], bool]


@dataclass(frozen=True, slots=True)
class KnownWord:
    """A declared word: its ``effects``, and what it ``means`` to people; empty if that is not said.

    says      its effects as they are written
    is_given  it is declared for one run, and not by the definition
    """

    word: str
    effects: tuple[str, ...]
    means: str
    says: str = ""
    is_given: bool = False

    @property
    def code(self) -> int | None:
        """Its number if it is an M code."""
        match = _M_CODE.fullmatch(self.word)
        return int(match[1]) if match else None

    @property
    def is_silent(self) -> bool:
        """Whether nothing but the word itself says what happens."""
        return set(self.effects) <= _SILENT


@lru_cache(maxsize=8)
def known_words(machine: Machine) -> tuple[KnownWord, ...]:
    """Return the words that the definition of a machine's control declares.

    Raises ``InputError`` if one of them is written wrongly.
    """
    return _read(control_of(machine).table("known"), None)


def check_known_words(machine: Machine, is_own_word: Callable[[str], bool]) -> None:
    """Check the words that the definition of a machine's control declares.

    Raises ``InputError`` if one of them is written wrongly, declared twice, or a word that the control has itself.
    """
    _read(control_of(machine).table("known"), is_own_word)


def _read(table: Table, is_own_word: Callable[[str], bool] | None) -> tuple[KnownWord, ...]:
    found: dict[str, KnownWord] = {}
    plain = table.to_dict()
    for key in table.names():
        if isinstance(inner := plain[key], dict):
            # TOML takes G54.4 without quotation marks as a key 4 of a table G54.
            whole = ".".join((key, *_first_path(inner)))
            table.mark_read(key)
            table.add_problem(key, Wording("NC190", "table_word_point", whole=whole))
            continue
        word = _known_word(table, key)
        normal = plain_code(word.word)
        if is_own_word is not None and is_own_word(normal):
            table.add_problem(key, Wording("NC190", "own_word"))
        elif normal != word.word and word.code is None:
            table.add_problem(key, Wording("NC190", "begins_code_leading_zeros", normal=normal))
        found[normal] = word
    report_duplicates(table, lambda key: plain_code(normal_word(key)))
    table.raise_problems()
    return tuple(found.values())


def _first_path(table: dict[str, object]) -> list[str]:
    """Return the keys to the first value in a table of tables."""
    path: list[str] = []
    inner: object = table
    while isinstance(inner, dict) and inner:
        key, inner = next(iter(inner.items()))
        path.append(str(key)[:_MOST_LETTERS])
    return path[:_MOST_LETTERS]


def _known_word(table: Table, key: str) -> KnownWord:
    value = table.text(key, None)  # None: no text, which is noted
    text, _, means = (value if value is not None else EFFECTS[0]).partition(":")
    written = tuple(effect.strip() for effect in text.split(","))
    effects = tuple(_ALIKE.get(effect, effect) for effect in written)
    if unknown := [effect for effect in effects if effect not in EFFECTS]:
        known = (*EFFECTS, *_ALIKE)
        table.add_problem(key, Wording("NC190", "no_effect", unknown=repr(unknown[0]), effects=known))
    elif fault := _contradiction(effects):
        table.add_problem(key, fault)
    if not key.strip():
        table.add_problem("", Wording("NC190", "word_without_letters"))
    elif not re.fullmatch(r"[A-Z][A-Z0-9_ .:\\/\"-]{0,60}", key.upper()):
        table.add_problem(key, Wording("NC190", "no_word_program"))
    is_given = table.location(key)[0] == GIVEN
    return KnownWord(normal_word(key), effects, means.strip(), ", ".join(written), is_given)


def _contradiction(effects: Sequence[str]) -> Wording | None:
    """Return what is wrong with effects of which one excludes another; None: nothing."""
    for k, one in enumerate(effects):
        for other in effects[k + 1 :]:
            kinds = one.partition(" ")[0], other.partition(" ")[0]
            is_one_mode = kinds[0] == kinds[1] and (kinds[0] in _ONE_MODE or "coolant off" in (one, other))
            if one != other and (is_one_mode or "no effect" in (one, other)):
                return Wording("NC190", "excluding_effects", one=repr(one), other=repr(other))
    return None


def normal_word(key: str) -> str:
    """Return a word in capitals, with single blanks, one of them between a code and the word behind it."""
    return _GLUED.sub(r"\1 ", " ".join(key.upper().split()))


def plain_code(word: str) -> str:
    """Return a word in capitals whose G or M code has no leading zeros."""
    return _LEADING_ZEROS.sub(r"\1\2", word)


def beginning_call(raw: str, call: str) -> str:
    """Return the call with which a block begins as a word that can be declared; empty if it begins otherwise.

    call  regular expression of a call
    """
    found = re.match(rf"{_BLOCK_BEGIN.pattern}({call})(?![A-Z0-9_.])", raw, re.IGNORECASE)
    return normal_word(found[1]) if found is not None else ""


def begins_with(words: Iterable[KnownWord], text: str) -> bool:
    """Whether a block begins with a declared word, which then has the whole block."""
    patterns = [_pattern(word.word) for word in words if word.code is None]
    return any(re.match(rf"[ \t]*{pattern}(?![A-Z0-9_])", text, re.IGNORECASE) for pattern in patterns)


class WordsBesideError(Exception):
    """A block in which nobody knows what belongs to a declared word; ``wording`` says what."""

    def __init__(self, wording: Wording) -> None:
        super().__init__(str(wording))
        self.wording = wording


class KnownWords:
    """Finds and executes declared words, line by line."""

    def __init__(self, machine: Machine, control: VirtualControl, takes: Takes, *, among_others: bool) -> None:
        self._control, self._takes, self._among_others = control, takes, among_others
        words = known_words(machine)
        self._codes = {word.code: word for word in words if word.code is not None}
        blocks = [word for word in words if word.code is None]
        beside = [word for word in blocks if among_others and _is_beside_others(word)]
        self._blocks = sorted((word for word in blocks if word not in beside), key=lambda word: -len(word.word))
        begins = "|".join(f"({_pattern(word.word)})" for word in self._blocks)
        self._begin = re.compile(rf"(?:{begins})(?![A-Z0-9_])", re.IGNORECASE) if self._blocks else None
        codes = "|".join(str(code) for code in self._codes)
        self._code = re.compile(rf"(?<![A-Z0-9_.$])M0*({codes})(?![0-9=])(?:\([^)]*\))?", re.I) if codes else None
        self._beside = sorted(beside, key=lambda word: -len(word.word))
        either = "|".join(f"({_pattern_beside(word.word)})" for word in self._beside)
        self._beside_others = re.compile(either, re.IGNORECASE) if beside else None
        self._continues = False
        self.any = bool(words)
        #: Those that the program has met.
        self.met: dict[KnownWord, None] = {}

    def take(self, raw: str) -> tuple[str | None, tuple[KnownWord, ...]]:
        """Return what is left of a line, None if declared words have the whole block, and the declared words in it.

        ``WordsBesideError`` if nobody knows what of the block belongs to them.
        """
        if self._continues:
            self._continues = raw.rstrip().endswith("~")
            return None, ()
        if self._begin is not None:
            start = _BLOCK_BEGIN.match(raw)
            match = self._begin.match(raw, start.end() if start else 0)
            if match is not None and match.lastindex is not None:
                self._take_block(self._blocks[match.lastindex - 1], raw, match)
                return None, ()
        found: list[KnownWord] = []

        def remove(match: re.Match[str]) -> str:
            if is_other(match.string, match.start(), match.end()):
                return match[0]
            found.append(word := self._codes[int(match[1])])
            self.met[word] = None
            return " " * len(match[0])

        text = self._code.sub(remove, raw) if self._code is not None else raw
        places = [] if self._beside_others is None else list(self._beside_others.finditer(text))
        places = [match for match in places if not is_other(text, match.start(), match.end())]
        if not places:
            return text, tuple(found)
        words = [self._beside[(match.lastindex or 1) - 1] for match in places]
        block = without_words(text, places, self._takes)
        if block.letters:
            raise WordsBesideError(Wording("NC213", "letters_beside", word=words[0].word, letters=block.letters))
        if not block.rest and len(words) == 1 and not found:
            self._execute_block(words[0], raw[places[0].start() :].split(";")[0].strip())
            return None, ()
        self.met.update(dict.fromkeys(words))
        return block.rest or None, (*found, *words)

    def _take_block(self, word: KnownWord, raw: str, match: re.Match[str]) -> None:
        """Execute a word that has the whole block, in which no other G code may stand."""
        self.met[word] = None
        is_alone = not self._among_others and _is_beside_others(word)
        is_code = _HAS_CODE.match(word.word) is not None
        if (is_alone or is_code) and has_other_codes(raw[match.end() :], of_klartext=is_alone):
            raise WordsBesideError(Wording("NC213", "codes_beside", word=word.word))
        self._continues = raw.rstrip().endswith("~")
        self._execute_block(word, raw[match.start() :].split(";")[0].strip())

    def execute(self, words: tuple[KnownWord, ...], *, before_motion: bool) -> None:
        """Execute the effects of codes that act before the motion of their block, or those that act after it."""
        for word in words:
            for effect in word.effects:
                if (effect in _BEFORE_MOTION) is before_motion:
                    self._execute(effect, word)
            if word.is_silent and before_motion:
                event = ("known", word.word) if word.code is None else ("m", float(word.code))
                self._control.add_event(*event)

    def _execute_block(self, word: KnownWord, text: str) -> None:
        self.met[word] = None
        tool = _TOOL.search(text.upper())
        if tool is not None and "tool change" in word.effects:
            self._control.select_tool(f"{int(tool[1])}")
        for effect in word.effects:
            self._execute(effect, word)
        if word.is_silent:
            self._control.add_event("known", text)

    def _execute(self, effect: str, word: KnownWord) -> None:
        control = self._control
        kind, _, value = effect.partition(" ")
        match effect:
            case "stop" | "optional stop":
                control.add_event(effect.replace(" ", "_"))
            case "tool change":
                control.change_tool()
            case "tcp on" | "tcp off":
                control.set_tcp(value == "on")
            case _ if effect == WAITS:
                control.note_wait(
                    Wording("NC226", "waits_as_declared", word=word.word, means=word.means)
                    if word.means
                    else Wording("NC226", "waits", word=word.word),
                    word.word,
                )
            case _ if effect == HOME:
                control.go_home()
            case "door opens" | "clamp opens":
                what = "door_opens" if kind == "door" else "clamp_opens"
                control.note_wait(Wording("NC226", what, word=word.word), word.word)
            case _ if effect in _ALTERING:
                control.add_event("unasked", word.word)
            case _ if kind == "spindle":
                control.add_event("spindle", value)
            case _ if kind == "coolant":
                control.add_event("coolant", value)


def _is_beside_others(word: KnownWord) -> bool:
    """Whether a word is without any effect, and no call: then it may stand among the other words of a block."""
    is_without = set(word.effects) == {"no effect"} and _CALL.match(word.word) is None
    return is_without and _BESIDE.fullmatch(word.word) is not None


def _pattern_beside(word: str) -> str:
    """Return the regular expression of a word among others; a G code may follow a number without a blank."""
    if _HAS_CODE.match(word) is not None:
        return rf"(?<![A-Z_$<]){_pattern(word)}(?![0-9=])"
    return rf"(?<![A-Z0-9_.$<]){_pattern(word)}(?![A-Z0-9_]){_OWN_ARGUMENTS}"


def _pattern(word: str) -> str:
    """Return the regular expression of a word; blanks between its parts, and zeros of its code, may be more."""
    parts = r"[ \t]*".join(_CODE.sub(r"\g<0>0*", re.escape(part)) for part in word.split())
    return parts + (r"(?!\.[0-9])" if _G_CODE.fullmatch(word) else "")
