"""The functions of ``import trunnion`` and their arguments."""

import inspect
from collections.abc import Iterator
from typing import Final, get_args

import trunnion

FUNCTIONS: Final = [name for name in trunnion.__all__ if inspect.isfunction(getattr(trunnion, name))]


def arguments_of(signature: inspect.Signature) -> Iterator[inspect.Parameter]:
    """The arguments of a function, those of its ``TypedDict`` among them."""
    for each in signature.parameters.values():
        if each.kind is not inspect.Parameter.VAR_KEYWORD:
            yield each
            continue
        for name, kind in get_args(each.annotation)[0].__annotations__.items():
            yield inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=kind)
