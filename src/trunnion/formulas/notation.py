"""Expressions as text that can be computed with, and as LaTeX."""

import re
from collections.abc import Sequence
from typing import Final, Protocol

from trunnion.formulas.symbols import Expression, sympy

_GREEK: Final = {"phi": r"\varphi", "kappa": r"\kappa", "nu": r"\nu", "delta": r"\delta", "Delta": r"\Delta"}

_FUNCTIONS: Final = {"acos": r"\arccos", "asin": r"\arcsin", "atan2": r"\operatorname{atan2}"}


#: Symbols of offsets and lengths, which stand behind variables.
_OFFSET: Final = re.compile(r"([aeg]_[xyz]|L|kappa|delta)\Z")


class _Notation(Protocol):
    times: str

    def name(self, name: str) -> str: ...
    def ratio(self, above: str, below: str, *, is_sum: bool) -> str: ...
    def root(self, of: str) -> str: ...
    def power(self, base: str, exponent: str) -> str: ...
    def call(self, name: str, arguments: Sequence[str], *, is_atom: bool) -> str: ...
    def brackets(self, text: str) -> str: ...


class _Text:
    times = "*"

    def name(self, name: str) -> str:
        return name

    def ratio(self, above: str, below: str, *, is_sum: bool) -> str:
        return f"({above})/{below}" if is_sum else f"{above}/{below}"

    def root(self, of: str) -> str:
        return f"sqrt({of})"

    def power(self, base: str, exponent: str) -> str:
        return f"{base}**{exponent}"

    def call(self, name: str, arguments: Sequence[str], *, is_atom: bool) -> str:
        return f"{name}({', '.join(arguments)})"

    def brackets(self, text: str) -> str:
        return f"({text})"


class _Latex:
    times = r"\,"

    def name(self, name: str) -> str:
        base, _, index = name.partition("_")
        base = _GREEK.get(base, base if len(base) == 1 else rf"\mathrm{{{base}}}")
        parts = (rf"\mathrm{{{part}}}" if len(part) > 1 else part for part in index.split("_"))
        return rf"{base}_{{{','.join(parts)}}}" if index else base

    def ratio(self, above: str, below: str, *, is_sum: bool) -> str:
        return rf"\frac{{{above}}}{{{below}}}"

    def root(self, of: str) -> str:
        return rf"\sqrt{{{of}}}"

    def power(self, base: str, exponent: str) -> str:
        return f"{base}^{{{exponent}}}"

    def call(self, name: str, arguments: Sequence[str], *, is_atom: bool) -> str:
        word = _FUNCTIONS.get(name, rf"\{name}")
        return f"{word} {arguments[0]}" if is_atom and len(arguments) == 1 else f"{word}({', '.join(arguments)})"

    def brackets(self, text: str) -> str:
        return rf"\left({text}\right)"


_TEXT: Final = _Text()
_LATEX: Final = _Latex()


def as_text(expression: Expression) -> str:
    """Return an expression as text, which Python understands as well."""
    return _written(expression, _TEXT)


def as_latex(expression: Expression) -> str:
    """Return an expression as LaTeX, without the signs of mathematics around it."""
    return _written(expression, _LATEX)


def name_as_latex(name: str) -> str:
    """Return the name of a symbol as LaTeX."""
    return _LATEX.name(name)


def _written(expression: Expression, notation: _Notation) -> str:
    expression = sympy().sympify(expression)
    if expression.is_Add:
        text = ""
        for term in _in_order(expression.args):
            sign, rest = _without_sign(term)
            joint = ("-" if sign else "") if not text else (" - " if sign else " + ")
            text += joint + _product(rest, notation)
        return text
    sign, rest = _without_sign(expression)
    return ("-" if sign else "") + _product(rest, notation)


def _in_order(terms: Sequence[Expression]) -> list[Expression]:
    """Terms with functions, then variables, then offsets, then numbers; one without a minus before all others."""
    ranked = sorted(terms, key=_rank)
    first = next((k for k, term in enumerate(ranked) if not _without_sign(term)[0]), 0)
    return [ranked[first], *ranked[:first], *ranked[first + 1 :]]


def _rank(term: Expression) -> tuple[int, bool, bool, str]:
    names = [str(each) for each in term.free_symbols]
    is_negative, rest = _without_sign(term)
    text = str(rest)
    kind = 0 if term.atoms(sympy().Function) else 3 if not names else 2 if all(map(_OFFSET.match, names)) else 1
    return kind, is_negative, "cos" not in text, text


def _without_sign(term: Expression) -> tuple[bool, Expression]:
    """Whether a term begins with a minus, and the term without it."""
    factor, _ = term.as_coeff_Mul()
    return (True, -term) if factor.is_negative else (False, term)


def _product(term: Expression, notation: _Notation) -> str:
    """Write a term without a sign before it."""
    if term.is_Add:  # what had a minus before a sum
        return notation.brackets(_written(term, notation))
    above, below = term.as_numer_denom()
    if below != 1:
        upper = _factors(above, notation)
        return notation.ratio(upper, _divisor(below, notation), is_sum=above.is_Add)
    return _factors(term, notation)


def _divisor(below: Expression, notation: _Notation) -> str:
    """Write what is below a line; text wants brackets around a product or a sum."""
    text = _written(below, notation)
    return f"({text})" if notation is _TEXT and (below.is_Mul or below.is_Add) else text


def _factors(term: Expression, notation: _Notation) -> str:
    factors = sorted(term.args, key=_factor_rank) if term.is_Mul else [term]
    alone = len(factors) == 1
    return notation.times.join(_factor(each, notation, alone=alone) for each in factors)


def _factor_rank(factor: Expression) -> tuple[int, str]:
    """Numbers first, then functions, symbols and sums."""
    kind = 0 if not factor.free_symbols else 1 if factor.is_Function else 3 if factor.is_Add else 2
    return kind, str(factor)


def _factor(factor: Expression, notation: _Notation, *, alone: bool) -> str:
    if factor.is_Add:
        text = _written(factor, notation)
        return text if alone else notation.brackets(text)
    if factor.is_Pow:
        base, exponent = factor.args
        inner = _written(base, notation)
        if exponent == sympy().Rational(1, 2):
            return notation.root(inner)
        return notation.power(notation.brackets(inner) if base.is_Add or base.is_Mul else inner, str(exponent))
    if factor.is_Function:
        texts = [_written(each, notation) for each in factor.args]
        return notation.call(factor.func.__name__, texts, is_atom=factor.args[0].is_Symbol)
    if factor.is_Symbol:
        return notation.name(factor.name)
    return str(factor) if factor.is_Integer else _written(factor, notation)
