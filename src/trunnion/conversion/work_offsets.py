"""The work offset of a converted program: what another control calls it."""

from trunnion.readers.program.work_offsets import WorkOffsetWords

#: Work offsets that have the same names on all controls where they are G words, and more of them that most have.
COMMON_OFFSETS = frozenset({"G54", "G55", "G56", "G57"})
_SAME_NAMES = COMMON_OFFSETS | {"G58", "G59"}


def carry_work_offset(text: str, source: WorkOffsetWords, target: WorkOffsetWords, same_family: bool) -> str | None:
    """Return the setting ``work_offset`` for another control; None if it lacks one of the work offsets.

    text            one offset, or several by operation: ``G54,TOP:G54.1 P3``
    source, target  how both controls select work offsets
    same_family     the same number selects the same offset, whatever the words are
    """
    carried = []
    for entry in text.split(","):
        operation, colon, word = entry.rpartition(":")
        value = source.value_of(word)
        name = target.name(value) if same_family and value is not None else word
        if target.value_of(name) is None or not (same_family or word in _SAME_NAMES):
            return None
        carried.append(f"{operation}{colon}{name}")
    return ",".join(carried)
