"""G words of one group: a block has one of them at most; which of two counts differs from control to control."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

from trunnion.messages import Wording


def same_group(
    codes: Sequence[int], groups: Iterable[Collection[int]], text_of: Callable[[int], str]
) -> Iterator[Wording]:
    """Yield what is wrong with the G codes of a block: different ones of one group.

    codes    in the order of the block
    groups   the codes that set one mode, for each mode
    text_of  gives the word of a code
    """
    if len(codes) < 2:
        return
    for group in groups:
        found = [text_of(code) for code in dict.fromkeys(codes) if code in group]
        if len(found) > 1:
            yield Wording("NC212", "one_at_most", words=tuple(found[:2]))
