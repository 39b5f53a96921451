"""Words of the machine builder on the way to another machine: only what means the same there goes over.

The same M code may open a clamp here and start an air blast there. ``[control.known]`` of both definitions says what a
word means. What only the source declares to be without effect on the path is left out; the rest is refused.
"""

from collections.abc import Sequence
from dataclasses import replace

from trunnion.errors import Problem, warning
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import Event, Insert, Toolpath
from trunnion.readers import KnownWord, known_words


def carry_machine_words(
    toolpath: Toolpath, source: Machine, target: Machine | None
) -> tuple[Toolpath, tuple[Problem, ...]]:
    """Return the toolpath of a program with the builder's words that mean the same on another machine.

    toolpath        converted from a program: each ``Insert`` in it is a word of the machine's builder
    source, target  the machine of the program, and the one it is for; None for a CL file, which keeps all words

    tuple  the toolpath, and a warning or error for each word
    """
    inserts = [event for operation in toolpath.operations for event in operation.events if isinstance(event, Insert)]
    if not inserts:
        return toolpath, ()
    if target is None:
        return toolpath, (
            warning(
                toolpath.file,
                inserts[0].line,
                Wording(
                    "CNV152",
                    "words_builder_kept",
                    fromkeys=tuple(dict.fromkeys(event.text for event in inserts)),
                    source=source.key,
                ),
            ),
        )
    if source.key == target.key and source.control.to_dict() == target.control.to_dict():
        return toolpath, ()
    words = _Words(toolpath.file, known_words(source), known_words(target), target.key)
    operations = tuple(replace(each, events=words.carried(each.events)) for each in toolpath.operations)
    return replace(toolpath, operations=operations), tuple(words.problems)


class _Words:
    """Carries words over, and names those that stay behind, each once."""

    def __init__(self, file: str, known: Sequence[KnownWord], theirs: Sequence[KnownWord], target: str) -> None:
        self.problems: list[Problem] = []
        self._file, self._known, self._target = file, known, target
        self._by_meaning = {word.means: word for word in theirs if word.means and word.is_silent}
        self._named: set[str] = set()

    def carried(self, events: Sequence[Event]) -> tuple[Event, ...]:
        """Return the events with the words of the other machine."""
        found: list[Event] = []
        for event in events:
            if not isinstance(event, Insert):
                found.append(event)
                continue
            word = self._declared(event.text)
            other = self._by_meaning.get(word.means) if word is not None else None
            if other is not None:
                found.append(replace(event, text=other.word))
            else:
                self._name(event, word)
        return tuple(found)

    def _declared(self, text: str) -> KnownWord | None:
        """Return the declaration of a word; the longest that fits."""
        upper = " ".join(text.upper().split())
        fits = [word for word in self._known if _matches(word, upper)]
        return max(fits, key=lambda word: len(word.word), default=None)

    def _name(self, event: Insert, word: KnownWord | None) -> None:
        if event.text in self._named:
            return
        self._named.add(event.text)
        if word is None:
            self.problems.append(
                Problem(
                    self._file, event.line, Wording("CNV151", "word_machine_s", event=event.text, target=self._target)
                )
            )
            return
        self.problems.append(
            warning(
                self._file,
                event.line,
                Wording("CNV150", "not_carried_over", event=event.text, means=word.means, target=self._target)
                if word.means
                else Wording("CNV150", "not_carried_over_no", event=event.text, target=self._target),
            )
        )


def _matches(word: KnownWord, text: str) -> bool:
    if word.code is not None:
        return text == f"M{word.code}"
    return text.startswith(word.word) and not text[len(word.word) : len(word.word) + 1].isalnum()
