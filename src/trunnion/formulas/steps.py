"""Formulas in their order, and intermediate vectors where they keep the next ones short."""

from dataclasses import field
from typing import Final

from trunnion.formulas.chain import TIP
from trunnion.formulas.notation import as_latex, as_text, name_as_latex
from trunnion.formulas.symbols import Expression, Rows, Triple, size_of, symbol, sympy, transposed, turned
from trunnion.records import dataclass

#: The longest part of a vector that is turned further as it stands.
_LONGEST: Final = 14


@dataclass(frozen=True, slots=True)
class Formula:
    """One formula.

    name   of what it gives
    text   what it is, as text that Python understands as well; angles in degrees
    latex  the whole formula as LaTeX
    """

    name: str
    text: str
    latex: str


@dataclass(slots=True, eq=False)
class Steps:
    """Formulas that follow each other: each may use those before it.

    definitions  names that any of them may use
    found        names and formulas
    """

    definitions: tuple[tuple[str, Expression], ...] = ()
    found: list[tuple[str, Expression]] = field(default_factory=list)

    def say(self, name: str, expression: Expression) -> Expression:
        """Note a formula, and return its name as a symbol."""
        self.found.append((name, expression))
        return symbol(name)

    def turn(self, rows: Rows, vector: Triple, name: str) -> Triple:
        """Turn a vector; one that would make that long gets a name first."""
        result = turned(rows, vector)
        if max(map(size_of, result)) <= _LONGEST:
            return result
        parts = [
            part if size_of(part) <= 1 else self.say(f"{name}_{letter}", part)
            for letter, part in zip(TIP, vector, strict=True)
        ]
        return turned(rows, (parts[0], parts[1], parts[2]))

    def turn_back(self, rows: Rows, vector: Triple, name: str) -> Triple:
        """Turn a vector the other way."""
        return self.turn(transposed(rows), vector, name)

    def formulas(self) -> tuple[Formula, ...]:
        """Return them as texts."""
        return tuple(as_formula(name, expression) for name, expression in self.found)

    def substituted(self) -> dict[str, Expression]:
        """Return them without intermediate names."""
        sp = sympy()
        named = {symbol(name): sp.sympify(expression) for name, expression in self.definitions}
        known = dict[Expression, Expression]()
        for name, expression in self.found:
            known[symbol(name)] = sp.sympify(expression).xreplace(named).xreplace(known)
        return {str(name): expression for name, expression in known.items()}


def as_formula(name: str, expression: Expression) -> Formula:
    """Return a formula as texts."""
    return Formula(name, as_text(expression), f"{name_as_latex(name)} = {as_latex(expression)}")
