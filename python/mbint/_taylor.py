"""Taylor models in fixed point: polynomials of whole multiples of 2**-SCALE, with a radius for all else.

Products of Python's whole numbers are exact, so that the only errors are the ones that are rounded away on purpose. Nothing of
the command's arithmetic is used.
"""

from __future__ import annotations

from functools import cached_property
from itertools import product
from math import comb, isqrt

#: Binary digits after the point.
SCALE = 112
ONE = 1 << SCALE

#: Further binary digits of series.
GUARD = 64


class Unknown(ArithmeticError):
    """Nothing is known of a number."""


def up(value: int) -> int:
    """A product of two numbers, back in fixed point, rounded up."""
    return -(-value >> SCALE)


def fixed(value: float) -> tuple[int, int]:
    """A float in fixed point, rounded down, and a bound of the rounding error."""
    numerator, denominator = value.as_integer_ratio()
    exact = numerator << SCALE
    return exact // denominator, int(exact % denominator != 0)


def quotient_up(a: int, b: int) -> int:
    """a/b of two numbers in fixed point, rounded up; b > 0."""
    return -((-a << SCALE) // b)


def sine_and_cosine(x: int) -> tuple[int, int, int]:
    """(sin x, cos x, error of both), by their series."""
    x <<= GUARD
    scale = SCALE + GUARD
    sums, term, error, lost, k = [0, 0], 1 << scale, 0, 0, 0
    size = abs(x)
    while True:
        sums[k % 2] += term if k % 4 < 2 else -term
        lost += error
        k += 1
        # |term| is that of the series within `error`.
        term, error = (term * size) // (k << scale), (error * size) // (k << scale) + 2
        if k << scale > 2 * size and term == 0:
            break
    # The rest is less than twice its first term.
    lost += 2 * error
    sine = sums[1] if x >= 0 else -sums[1]
    return sine >> GUARD, sums[0] >> GUARD, (lost >> GUARD) + 2


class Space:
    """Polynomials of so many variables up to a total degree; all variables are between -1 and 1."""

    def __init__(self, variables: int, order: int) -> None:
        self.variables, self.order = variables, order

        def of_degree(degree: int, places: int) -> list[tuple[int, ...]]:
            if places == 0:
                return [()] if degree == 0 else []
            if places == 1:
                return [(degree,)]
            falling = range(degree, -1, -1)
            return [(first, *rest) for first in falling for rest in of_degree(degree - first, places - 1)]

        #: Powers of each monomial: ascending degrees, falling powers of the first variable within one.
        self.powers = [powers for degree in range(order + 1) for powers in of_degree(degree, variables)]
        self.index = {powers: place for place, powers in enumerate(self.powers)}
        self.degrees = [sum(powers) for powers in self.powers]
        self.count = len(self.powers)

    @cached_property
    def targets(self) -> list[list[int]]:
        """Products of each monomial with the first ones."""
        rows = []
        for i, powers in enumerate(self.powers):
            others = (other for j, other in enumerate(self.powers) if self.degrees[i] + self.degrees[j] <= self.order)
            rows.append([self.index[tuple(a + b for a, b in zip(powers, other))] for other in others])
        return rows

    def constant(self, value: int, radius: int = 0) -> Model:
        return Model(self, [value] + [0] * (self.count - 1), radius)

    def zero(self) -> Model:
        return self.constant(0)

    def one(self) -> Model:
        return self.constant(ONE)

    def variable(self, place: int, middle: int, half: int, radius: int) -> Model:
        """middle + half times a variable."""
        model = self.constant(middle, radius)
        if self.order == 0:
            return Model(self, model.c, radius + abs(half))
        model.c[1 + place] = half
        return model

    def polynomial(self, coefficients: list[float]) -> Model:
        """Polynomial with these coefficients; missing ones are zero."""
        both = [fixed(c) for c in coefficients]
        values = [value for value, _ in both]
        return Model(self, values + [0] * (self.count - len(values)), sum(error for _, error in both))


class Model:
    """A polynomial and a radius, the largest distance of the represented function from the polynomial."""

    __slots__ = ("c", "radius", "space")

    def __init__(self, space: Space, c: list[int], radius: int) -> None:
        self.space, self.c, self.radius = space, c, radius

    def with_radius(self, radius: int) -> Model:
        return Model(self.space, self.c, radius)

    def bare(self) -> Model:
        return Model(self.space, self.c, 0)

    def is_zero(self) -> bool:
        return self.radius == 0 and not any(self.c)

    def size(self) -> int:
        """Bound of the absolute value."""
        return sum(map(abs, self.c)) + self.radius

    def __add__(self, other: Model) -> Model:
        return Model(self.space, [a + b for a, b in zip(self.c, other.c)], self.radius + other.radius)

    def __sub__(self, other: Model) -> Model:
        return Model(self.space, [a - b for a, b in zip(self.c, other.c)], self.radius + other.radius)

    def __neg__(self) -> Model:
        return Model(self.space, [-a for a in self.c], self.radius)

    def _norms(self) -> list[int]:
        norms = [0] * (self.space.order + 1)
        for c, degree in zip(self.c, self.space.degrees):
            norms[degree] += abs(c)
        return norms

    def _products(self, other: Model) -> list[int]:
        out = [0] * self.space.count
        nonzero = [(j, b) for j, b in enumerate(other.c) if b]
        for a, row in zip(self.c, self.space.targets):
            if a:
                length = len(row)
                for j, b in nonzero:
                    if j >= length:
                        break
                    out[row[j]] += a * b
        return [value >> SCALE for value in out]

    def approximately(self, other: Model) -> Model:
        """The product's polynomial."""
        return Model(self.space, self._products(other), 0)

    def __mul__(self, other: Model) -> Model:
        space = self.space
        if self.is_zero() or other.is_zero():
            return space.zero()
        mine, others = self._norms(), other._norms()
        tails = [sum(others[degree:]) for degree in range(space.order + 2)]
        cut = sum(norm * tails[space.order + 1 - degree] for degree, norm in enumerate(mine) if degree)
        spread = sum(mine) * other.radius + sum(others) * self.radius + self.radius * other.radius
        return Model(space, self._products(other), up(cut + spread) + space.count)

    def least(self) -> int:
        """Least absolute value; not positive where zero is possible."""
        return abs(self.c[0]) - sum(map(abs, self.c[1:])) - self.radius

    def sign(self) -> int:
        """Sign of all values, where zero counts as negative."""
        rest = sum(map(abs, self.c[1:])) + self.radius
        if self.c[0] - rest > 0:
            return 1
        if self.c[0] + rest <= 0:
            return -1
        raise Unknown

    def absolute(self) -> Model:
        """The absolute value; where the sign changes over the box, the radius covers the reflected values of the other sign."""
        beyond = sum(map(abs, self.c[1:])) + self.radius - abs(self.c[0])
        own = self if self.c[0] >= 0 else -self
        return own if beyond <= 0 else own.with_radius(own.radius + 2 * beyond)

    def _solved(self, divisor: int, known: list[int], other: Model | None) -> list[int]:
        """Coefficients h with h b = a (`other` is b), or h h = a, one after the other."""
        space, h = self.space, known + [0] * (self.space.count - 1)
        for place in range(1, space.count):
            total = self.c[place] << SCALE
            for i, j in _pairs(space)[place]:
                b = h if other is None else other.c
                total -= b[i] * h[j]
            h[place] = total // divisor
        return h

    def __truediv__(self, other: Model) -> Model:
        least = other.least()
        if least <= 0:
            raise Unknown
        h = self._solved(other.c[0], [(self.c[0] << SCALE) // other.c[0]], other)
        found = Model(self.space, h, 0)
        # |a/b - h| = |a - h b| / |b|.
        return found.with_radius(quotient_up((self - found * other).size(), least))

    def sqrt(self) -> Model:
        if self.c[0] <= 0:
            raise Unknown
        root = isqrt(self.c[0] << SCALE)
        found = Model(self.space, self._solved(2 * root, [root], None), 0)
        # |sqrt a - h| = |a - h h| / (sqrt a + h).
        missed, least = (self - found * found).size(), found.least()
        if found.c[0] <= 0 or least <= 0 or 2 * missed >= up(least * least) - 1:
            raise Unknown
        return found.with_radius(quotient_up(missed, least))

    def sin_cos(self) -> tuple[Model, Model]:
        space = self.space
        sine, cosine, error = sine_and_cosine(self.c[0])
        at = [space.constant(value, error) for value in (sine, cosine)]
        rest = Model(space, [0, *self.c[1:]], self.radius)
        if rest.is_zero():
            return at[0], at[1]
        size = rest.size()
        sums, term, k, bound = [space.one(), space.zero()], space.one(), 0, ONE
        while bound > 1:
            k += 1
            if k > 200:
                raise Unknown
            term = term * rest
            term = Model(space, [c // k for c in term.c], term.radius // k + 1 + space.count)
            bound = up(bound * size) // k + 1
            sums[k % 2] = sums[k % 2] + (term if k % 4 < 2 else -term)
        # k < 200 terms of such a size have a ratio below 0.7 from here on.
        tail = 4 * (bound + 1)
        of_cosine, of_sine = (own.with_radius(own.radius + tail) for own in sums)
        return at[0] * of_cosine + at[1] * of_sine, at[1] * of_cosine - at[0] * of_sine

    def half(self, axis: int, side: int) -> Model:
        """Over one half of the box: the variable becomes (variable + side)/2."""
        space = self.space
        out = [0] * space.count
        for c, powers in zip(self.c, space.powers):
            if c:
                power = powers[axis]
                for left in range(power + 1):
                    to = space.index[(*powers[:axis], left, *powers[axis + 1 :])]
                    out[to] += (c * comb(power, left) * side ** (power - left)) << (64 - power)
        return Model(space, [value >> 64 for value in out], self.radius + space.count)

    def is_within(self, lower: int, upper: int) -> bool:
        """Whether all values are proven to be between two ends."""
        opened = [self]
        for _ in range(20_000):
            if not opened:
                return True
            model = opened.pop()
            middle, spread = model.c[0], model.size() - abs(model.c[0])
            if lower <= middle - spread and middle + spread <= upper:
                continue
            if not lower <= middle - model.radius <= middle + model.radius <= upper:
                return False
            axes = range(self.space.variables)
            changes = [sum(abs(c) * p[axis] for c, p in zip(model.c, self.space.powers)) for axis in axes]
            if not any(changes):
                return False
            axis = max(axes, key=changes.__getitem__)
            opened += [model.half(axis, side) for side in (-1, 1)]
        return False


_PAIRS: dict[tuple[int, int], list[list[tuple[int, int]]]] = {}


def _pairs(space: Space) -> list[list[tuple[int, int]]]:
    """Pairs of monomials by their product, but for those with the constant first."""
    key = (space.variables, space.order)
    if key not in _PAIRS:
        pairs: list[list[tuple[int, int]]] = [[] for _ in range(space.count)]
        for i, j in product(range(1, space.count), range(space.count)):
            if space.degrees[i] + space.degrees[j] <= space.order:
                pairs[space.targets[i][j]].append((i, j))
        _PAIRS[key] = pairs
    return _PAIRS[key]
