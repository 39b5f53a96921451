"""Symbols, exact numbers and small vectors of SymPy, which is imported when a formula is made."""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, TypeAlias

from trunnion.extras import import_extra

#: An expression of SymPy, which has no types.
Expression: TypeAlias = Any
Triple: TypeAlias = tuple[Expression, Expression, Expression]
Rows: TypeAlias = tuple[Triple, Triple, Triple]

#: Squares of direction cosines are taken for fractions with denominators up to this.
_DENOMINATORS: Final = 64
_ROUNDING: Final = 4e-16


def sympy() -> Any:
    """Return the package; raises ``MissingExtraError`` if it is not installed."""
    return import_extra("sympy", "kinematics")


def symbol(name: str) -> Expression:
    """Return a real quantity by its name."""
    return sympy().Symbol(name)


def number(value: int) -> Expression:
    """Return a whole number."""
    return sympy().Integer(value)


def function(name: str, *arguments: Expression) -> Expression:
    """Return a function that SymPy knows nothing about: it is printed as it stands. Angles are in degrees."""
    return sympy().Function(name)(*arguments)


def cos_sin(angle: Expression) -> tuple[Expression, Expression]:
    """Return cosine and sine of an axis."""
    return function("cos", angle), function("sin", angle)


def exact_cosine(value: float) -> Expression | None:
    """Return a direction cosine as root of a fraction; None if it is none."""
    square = value * value
    fraction = Fraction(square).limit_denominator(_DENOMINATORS)
    if abs(float(fraction) - square) > _ROUNDING * max(1.0, square):
        return None
    sp = sympy()
    return math.copysign(1.0, value).__trunc__() * sp.sqrt(sp.Rational(fraction.numerator, fraction.denominator))


def exact_direction(direction: Sequence[float]) -> Triple | None:
    """Return a unit vector in roots of fractions; None if it is none of these."""
    parts = [part for part in map(exact_cosine, direction) if part is not None]
    if len(parts) < 3 or sum(part**2 for part in parts) != 1:
        return None
    return parts[0], parts[1], parts[2]


def plus(a: Triple, b: Triple) -> Triple:
    """Return the sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Triple, b: Triple) -> Triple:
    """Return the difference of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(a: Triple, factor: Expression) -> Triple:
    """Return a vector times a number."""
    return a[0] * factor, a[1] * factor, a[2] * factor


def dot(a: Triple, b: Triple) -> Expression:
    """Return the product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Triple, b: Triple) -> Triple:
    """Return the vector square to two vectors."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def turned(rows: Sequence[Triple], vector: Triple) -> Triple:
    """Return a matrix times a vector."""
    return dot(rows[0], vector), dot(rows[1], vector), dot(rows[2], vector)


def transposed(rows: Sequence[Triple]) -> Rows:
    """Return a matrix whose rows are the columns."""
    first, second, third = ((rows[0][k], rows[1][k], rows[2][k]) for k in range(3))
    return first, second, third


def product(a: Sequence[Triple], b: Sequence[Triple]) -> Rows:
    """Return the product of two matrices."""
    columns = transposed(b)
    first, second, third = (turned(columns, row) for row in a)
    return first, second, third


def rotation(direction: Triple, angle: Expression) -> Rows:
    """Return the matrix (3, 3) that turns about a unit vector (Rodrigues), each part in its shortest form."""
    cos, sin = cos_sin(angle)
    a, b, c = direction
    rest = 1 - cos
    across = ((0, -c, b), (c, 0, -a), (-b, a, 0))
    first, second, third = (
        tuple(
            _short((cos if i == j else 0) + direction[i] * direction[j] * rest + across[i][j] * sin, cos)
            for j in range(3)
        )
        for i in range(3)
    )
    return first, second, third


def _short(part: Expression, cos: Expression) -> Expression:
    """Return a part of a matrix with its cosines put together."""
    return sympy().collect(sympy().expand(part), cos)


def size_of(expression: Expression) -> int:
    """How many symbols and functions an expression has: how long it is on paper."""
    return sum(1 for each in sympy().preorder_traversal(expression) if each.is_Symbol)


def float_of(expression: Expression, values: Mapping[str, float]) -> float:
    """Return the value of an expression; angles are in degrees."""
    found = sympy().sympify(expression).xreplace({symbol(name): value for name, value in values.items()})
    return float(found)


def cardinal(direction: Triple) -> tuple[int, int] | None:
    """Return the place of a direction along X, Y or Z, and its sign; None if it is along none of them."""
    places = [k for k in range(3) if direction[k] != 0]
    if len(places) == 1 and direction[places[0]] in (1, -1):
        return places[0], int(direction[places[0]])
    return None
