"""A second checker of the proofs of ``mbint run --certify``, in Python's whole numbers.

It reads ``certificate.jsonl`` and computes the proof again: nothing of the file but its equations is trusted, and nothing of the
command's arithmetic is used. ``docs/reference/certificate.md`` describes the file, ``docs/theory/certified.md`` says why the
proof holds; symbols here are those of that page.

    >>> from mbint import certificate
    >>> certificate.check("results/pendulum/certificate.jsonl", model="models/pendulum.yaml")
    Checked(pieces=1, cells=318, bounds=593)
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise, product
from os import PathLike
from pathlib import Path
from typing import Any

from ._taylor import ONE, SCALE, Model, Space, Unknown, fixed, up

#: A matrix of models, and one of bounds.
Matrix = list[list[Model]]
Bounds = list[list[int]]

#: Factor by which a frame may enlarge a distance before it is turned.
SKEW = 100


class Refused(ValueError):
    """A certificate proves nothing; the message says where."""


@dataclass(frozen=True)
class Checked:
    """What was checked."""

    #: Pieces of boxes of parameters.
    pieces: int
    #: Cells of time of all pieces.
    cells: int
    #: Bounds of an output at an instant.
    bounds: int


@dataclass
class _Piece:
    lower: list[float]
    upper: list[float]
    start: list[list[list[float]]]
    cells: list[dict[str, Any]] = field(default_factory=list)


@dataclass
class _System:
    parameters: list[str]
    lower: list[float]
    upper: list[float]
    order: int
    n: int
    m: int
    nodes: list[list[str]]
    motion: list[int]
    start: list[list[int]]
    outputs: list[tuple[str, int]]
    rows: list[tuple[float, list[tuple[float, float] | None]]] = field(default_factory=list)
    pieces: list[_Piece] = field(default_factory=list)


def _number(text: str) -> float:
    value = float.fromhex(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is no finite number")
    return value


def _numbers(text: str) -> list[float]:
    return [_number(word) for word in text.split()]


def _read(lines: Iterable[str]) -> tuple[list[list[str]], list[_System]]:
    """Files of the model with their hashes, and systems of equations."""
    files: list[list[str]] = []
    systems: list[_System] = []
    for number, line in enumerate(lines, 1):
        try:
            ((kind, own),) = json.loads(line).items()
            if kind == "certificate":
                if own["version"] != 1:
                    raise ValueError(f"version {own['version']} is not known")
                files = own["files"]
            elif kind == "system":
                systems.append(
                    _System(
                        own["parameters"],
                        _numbers(own["lower"]),
                        _numbers(own["upper"]),
                        own["order"],
                        own["coordinates"],
                        own["multipliers"],
                        [node.split() for node in own["nodes"]],
                        own["motion"],
                        own["start"],
                        [(name, node) for name, node in own["outputs"]],
                    )
                )
            elif kind == "row":
                ends = [None if text is None else _numbers(text) for text in own["bounds"]]
                bounds = [None if both is None else (both[0], both[1]) for both in ends]
                systems[-1].rows.append((_number(own["t"]), bounds))
            elif kind == "piece":
                start = [[_numbers(text) for text in own[name]] for name in ("q", "v")]
                systems[-1].pieces.append(_Piece(_numbers(own["lower"]), _numbers(own["upper"]), start))
            elif kind == "cell":
                systems[-1].pieces[-1].cells.append(own)
            else:
                raise ValueError(f"`{kind}` is unknown")
        except (ValueError, KeyError, IndexError, TypeError, AttributeError) as error:
            raise Refused(f"line {number} is not of a certificate: {error}") from error
    return files, systems


def check(path: str | PathLike[str], *, model: str | PathLike[str] | None = None) -> Checked:
    """Checks a certificate and, if a model's file is named, that it is of this file.

    Only ``mbint verify-certificate FILE MODEL`` checks that the equations are those of the model.

    Raises:
        Refused: something does not follow.
    """
    with open(path, encoding="utf-8") as lines:
        files, systems = _read(lines)
    if model is not None:
        digest = hashlib.sha256(Path(model).read_bytes()).hexdigest()
        if [Path(model).name, digest] not in files:
            raise Refused(f"{Path(model).name} is not the file that was certified")
    if not systems:
        raise Refused("there are no equations")
    for number, system in enumerate(systems, 1):
        try:
            _check_system(system)
        except Refused as error:
            raise Refused(f"system {number}, {error}") from error
    cells = sum(len(piece.cells) for system in systems for piece in system.pieces)
    bounds = sum(ends is not None for system in systems for _, row in system.rows for ends in row)
    return Checked(sum(len(system.pieces) for system in systems), cells, bounds)


def _check_system(system: _System) -> None:
    k, n, m = len(system.parameters), system.n, system.m
    lengths = [len(system.lower), len(system.upper), len(system.motion), len(system.start[0]), len(system.start[1])]
    if lengths != [k, k, n + m, n, n]:
        raise Refused("its equations are not as many as its unknowns")
    times = [time for time, _ in system.rows]
    if times != sorted(times) or any(time < 0 for time in times):
        raise Refused("its instants do not ascend from 0 s")
    if any(len(bounds) != len(system.outputs) for _, bounds in system.rows):
        raise Refused("a row does not have a bound of each output")
    if not _covered(system):
        raise Refused("its pieces do not cover the box of the parameters")
    if missing := _without_enclosure(system):
        names = ", ".join(f"`{name}`" for name in missing)
        raise Refused(f"its equations have {names}, which only `mbint verify-certificate` encloses")
    for number, piece in enumerate(system.pieces, 1):
        try:
            _Checker(system, piece).check()
        except Refused as error:
            raise Refused(f"piece {number}: {error}") from error


def _covered(system: _System) -> bool:
    """Whether each part of the grid through all ends of pieces is in a piece."""
    axes = []
    for axis, (lower, upper) in enumerate(zip(system.lower, system.upper)):
        ends = {end for piece in system.pieces for end in (piece.lower[axis], piece.upper[axis])}
        ends = {end for end in ends if lower < end < upper} | {lower, upper}
        axes.append([(lower, upper)] if lower == upper else list(pairwise(sorted(ends))))

    def holds(piece: _Piece, part: tuple[tuple[float, float], ...]) -> bool:
        ends = zip(piece.lower, piece.upper, part)
        return all(lower <= own[0] and own[1] <= upper for lower, upper, own in ends)

    return all(any(holds(piece, part) for piece in system.pieces) for part in product(*axes))


# Matrices.


def _times(a: Matrix, b: Matrix) -> Matrix:
    def entry(row: list[Model], column: int) -> Model:
        total = row[0].space.zero()
        for left, right in zip(row, b):
            if not left.is_zero() and not right[column].is_zero():
                total = total + left * right[column]
        return total

    return [[entry(row, column) for column in range(len(b[0]))] for row in a]


def _roughly(a: Matrix, b: Matrix) -> Matrix:
    """The product's polynomials."""

    def entry(row: list[Model], column: int) -> Model:
        total = row[0].space.zero()
        for left, right in zip(row, b):
            total = total + left.approximately(right[column])
        return total

    return [[entry(row, column) for column in range(len(b[0]))] for row in a]


def _off_identity(a: Matrix) -> Matrix:
    one = a[0][0].space.one()
    return [[one - own if i == j else -own for j, own in enumerate(row)] for i, row in enumerate(a)]


def _sizes(a: Matrix) -> Bounds:
    return [[own.size() for own in row] for row in a]


def _bare(a: Matrix) -> Matrix:
    return [[own.bare() for own in row] for row in a]


def _apply(a: Bounds, x: Sequence[int]) -> list[int]:
    return [up(sum(own * value for own, value in zip(row, x))) for row in a]


def _constant(space: Space, numbers: list[list[float]]) -> Matrix:
    return [[space.constant(fixed(number)[0]) for number in row] for row in numbers]


def _numeric_inverse(a: list[list[float]]) -> list[list[float]]:
    """Gauss' and Jordan's; any matrix would do."""
    size = len(a)
    rows = [[*row, *(float(i == j) for j in range(size))] for i, row in enumerate(a)]
    for place in range(size):
        pivot = max(range(place, size), key=lambda row: abs(rows[row][place]))
        if rows[pivot][place] == 0:
            raise Unknown
        rows[place], rows[pivot] = rows[pivot], rows[place]
        rows[place] = [value / rows[place][place] for value in rows[place]]
        for row in range(size):
            if row != place:
                factor = rows[row][place]
                rows[row] = [value - factor * other for value, other in zip(rows[row], rows[place])]
    return [row[size:] for row in rows]


def _centre(a: Matrix) -> list[list[float]]:
    return [[own.c[0] / ONE for own in row] for row in a]


def _refined(inverse: Matrix, of: Matrix) -> Matrix:
    """Schulz' iteration from an inverse of the right size; any matrix would do."""
    last = math.inf
    for _ in range(8):
        rest = _off_identity(_roughly(inverse, of))
        norm = max(sum(row) for row in _sizes(rest)) / ONE
        if norm < 1e-12 or norm >= last:
            break
        last = norm
        inverse = [[a + b for a, b in zip(*rows)] for rows in zip(inverse, _roughly(rest, inverse))]
    return _bare(inverse)


def _inverse(a: Matrix) -> Matrix:
    return _refined(_constant(a[0][0].space, _numeric_inverse(_centre(a))), _bare(a)) if a else []


def _majorant(a: Bounds, start: Sequence[int], time: int, rate: Sequence[int]) -> list[int]:
    """Some s with start + time (a s + rate) <= s: it bounds |e| where |e|' <= a |e| + rate over that time."""
    tried = list(start)
    for _ in range(100):
        moved = [own + of_rate for own, of_rate in zip(_apply(a, tried), rate)]
        found = [own + up(time * change) for own, change in zip(start, moved)]
        if all(own <= other for own, other in zip(found, tried)):
            return found
        if max(found) > ONE << SCALE:
            break
        tried = [own + own // 20 + 1 for own in found]
    raise Unknown


def _resolvent(contraction: Bounds, of: Bounds) -> Bounds:
    """Bound of (I - K)^-1 K S, column by column."""
    none = [0] * len(contraction)
    columns = [_majorant(contraction, _apply(contraction, column), ONE, none) for column in zip(*of)]
    return [list(row) for row in zip(*columns)]


# Equations.


class _Dual:
    """A number and its derivatives, by positions, velocities, accelerations and multipliers."""

    __slots__ = ("by", "value")

    def __init__(self, value: Model, by: dict[tuple[str, int], Model]) -> None:
        self.value, self.by = value, by


def _scaled(by: dict[tuple[str, int], Model], factor: Model) -> dict[tuple[str, int], Model]:
    return {place: own * factor for place, own in by.items()}


def _joined(a: dict[tuple[str, int], Model], b: dict[tuple[str, int], Model]) -> dict[tuple[str, int], Model]:
    joined = dict(a)
    for place, own in b.items():
        joined[place] = joined[place] + own if place in joined else own
    return joined


def _unary(name: str, a: _Dual) -> _Dual:
    value, by = a.value, a.by
    space = value.space
    if name == "neg":
        return _Dual(-value, {place: -own for place, own in by.items()})
    if name in ("sin", "cos", "tan"):
        sine, cosine = value.sin_cos()
        if name == "sin":
            return _Dual(sine, _scaled(by, cosine))
        if name == "cos":
            return _Dual(cosine, _scaled(by, -sine))
        tangent = sine / cosine
        return _Dual(tangent, _scaled(by, space.one() + tangent * tangent))
    if name == "sqrt":
        root = value.sqrt()
        return _Dual(root, _scaled(by, space.one() / (root + root)) if by else {})
    if name == "abs":
        if not by:
            return _Dual(value.absolute(), {})
        return a if value.sign() > 0 else _unary("neg", a)
    if name == "sign":
        if value.is_zero():
            return _Dual(value, {})
        if value.sign() < 0 and value.least() <= 0:
            raise Unknown
        return _Dual(space.constant(ONE * value.sign()), {})
    if name == "floor" and not by:
        spread = value.size() - abs(value.c[0])
        lower, upper = ((value.c[0] + side * spread) >> SCALE for side in (-1, 1))
        return _Dual(space.constant((lower + upper) * ONE // 2, (upper - lower) * ONE // 2 + 1), {})
    raise Unknown


def _binary(name: str, a: _Dual, b: _Dual) -> _Dual:
    if name == "add":
        return _Dual(a.value + b.value, _joined(a.by, b.by))
    if name == "sub":
        return _Dual(a.value - b.value, _joined(a.by, {place: -own for place, own in b.by.items()}))
    if name == "mul":
        return _Dual(a.value * b.value, _joined(_scaled(a.by, b.value), _scaled(b.by, a.value)))
    if name == "div":
        value = a.value / b.value
        by = _joined(a.by, _scaled(b.by, -value))
        return _Dual(value, {place: own / b.value for place, own in by.items()})
    if name in ("select", "select_else"):
        return b if (a.value.sign() > 0) == (name == "select") else _Dual(b.value.space.zero(), {})
    raise Unknown


#: Functions that have an enclosure here.
_ENCLOSED = {
    *("neg", "sin", "cos", "tan", "sqrt", "abs", "sign", "floor"),
    *("add", "sub", "mul", "div", "select", "select_else"),
}

#: Nodes with a number that is no node.
_LEAVES = ("q", "v", "w", "lambda", "p")


def _without_enclosure(system: _System) -> list[str]:
    """Functions in the equations of motion and of the start that have no enclosure here."""
    nodes = (system.nodes[place] for place in _needed(system, [*system.motion, *system.start[0], *system.start[1]]))
    return sorted({name for name, *words in nodes if words and name not in {*_ENCLOSED, *_LEAVES}})


def _needed(system: _System, rows: Sequence[int]) -> list[int]:
    """Nodes that some rows need, ascending."""
    needed, waiting = set[int](), list(rows)
    while waiting:
        place = waiting.pop()
        if place not in needed:
            needed.add(place)
            name, *words = system.nodes[place]
            if name in _ENCLOSED:
                waiting += [int(word) for word in words]
    return sorted(needed)


#: Columns of models: q, v, w and lambda.
State = dict[str, list[Model]]


def _evaluate(
    system: _System, rows: Sequence[int], space: Space, time: Model, parameters: list[Model], state: State, derive: bool
) -> list[_Dual]:
    known: dict[int, _Dual] = {}

    def node(place: int) -> _Dual:
        name, *words = system.nodes[place]
        if words and name not in {*_ENCLOSED, *_LEAVES}:
            raise Unknown
        children = [int(word) for word in words]
        if name in ("q", "v", "w", "lambda"):
            by = {(name, children[0]): space.one()} if derive else {}
            return _Dual(state[name][children[0]], by)
        if name == "p":
            return _Dual(parameters[children[0]], {})
        if any(child >= place for child in children):
            raise Refused("an operation is of later ones")
        if name == "t":
            return _Dual(time, {})
        if len(children) == 1:
            return _unary(name, known[children[0]])
        if len(children) == 2:
            return _binary(name, known[children[0]], known[children[1]])
        if name == "unknown":
            raise Unknown
        return _Dual(space.constant(*fixed(_number(name))), {})

    for place in _needed(system, rows):
        known[place] = node(place)
    return [known[row] for row in rows]


class _Checker:
    """The proof over one piece of the box."""

    def __init__(self, system: _System, piece: _Piece) -> None:
        self.system, self.piece = system, piece
        k, order = len(system.parameters), system.order
        coarse = -(-order // 2) + 1
        self.fine, self.coarse = Space(k + 1, order), Space(k + 1, coarse)
        self.box, self.coarse_box = Space(k, order), Space(k, coarse)

    def _parameters(self, space: Space, first: int) -> list[Model]:
        found = []
        for place, (lower, upper) in enumerate(zip(self.piece.lower, self.piece.upper)):
            if lower > upper:
                raise Refused("an end of the piece is beyond the other")
            (a, e), (b, f) = fixed(lower), fixed(upper)
            found.append(space.variable(first + place, (a + b) // 2, (b - a) // 2, e + f + 2))
        return found

    def check(self) -> None:
        system, piece = self.system, self.piece
        start, errors = self._start()
        frame = _Frame.of_box(self.coarse_box, errors)
        time, row = 0.0, 0
        for number, cell in enumerate(piece.cells, 1):
            try:
                passed = _Cell(self, cell, time, start, frame)
                while row < len(system.rows) and system.rows[row][0] <= passed.end:
                    self._observe(passed, *system.rows[row])
                    row += 1
                start, frame = passed.next()
            except Unknown as error:
                raise Refused(f"cell {number} from {time} s is not proven") from error
            except Refused as error:
                raise Refused(f"cell {number} from {time} s: {error}") from error
            time = passed.end
        for instant, bounds in system.rows[row:]:
            if any(ends is not None for ends in bounds):
                raise Refused(f"its cells end at {time} s, and bounds are stated at {instant} s")

    def _start(self) -> tuple[list[list[Model]], list[int]]:
        """Polynomials of positions and velocities at the start, and the distance of the motion from them."""
        system, space, n = self.system, self.box, self.system.n
        if [len(own) for own in self.piece.start] != [n, n]:
            raise Refused("polynomials of the start are not as many as coordinates")
        q, v = ([_polynomial(space, own) for own in block] for block in self.piece.start)
        state: State = {"q": q, "v": v, "w": [space.zero()] * n, "lambda": [space.zero()] * system.m}
        time, parameters = space.zero(), self._parameters(space, 0)
        for name, rows in zip(("q", "v"), system.start):

            def evaluate(state: State, rows: Sequence[int] = rows) -> list[_Dual]:
                return _evaluate(system, rows, space, time, parameters, state, derive=True)

            try:
                state = _enclosed(evaluate, state, [(name, place) for place in range(n)])[0]
            except Unknown as error:
                what = {"q": "positions", "v": "velocities"}[name]
                raise Refused(f"no {what} of the start are proven near their polynomials") from error
        errors = [own.radius for own in (*state["q"], *state["v"])]
        return [[own.bare() for own in state[name]] for name in ("q", "v")], errors

    def _observe(self, passed: _Cell, time: float, bounds: list[tuple[float, float] | None]) -> None:
        """The outputs at an instant of a cell."""
        system, space = self.system, self.box
        if all(ends is None for ends in bounds):
            return
        parameters, now = self._parameters(space, 0), space.constant(*fixed(time))
        state: State | None = passed.at(time)

        def evaluate(state: State) -> list[_Dual]:
            return _evaluate(system, system.motion, space, now, parameters, state, derive=True)

        try:
            state = _enclosed(evaluate, passed.at(time), passed.unknowns)[0]
        except Unknown:
            state = None
        for (name, node), ends in zip(system.outputs, bounds):
            if ends is None:
                continue
            try:
                if state is None:
                    # Enough for outputs that depend on neither accelerations nor multipliers.
                    missing: State = {**passed.at(time), "w": [], "lambda": []}
                    (output,) = _evaluate(system, [node], space, now, parameters, missing, derive=False)
                else:
                    (output,) = _evaluate(system, [node], space, now, parameters, state, derive=False)
                # Within the ends, rounded inwards.
                proven = output.value.is_within(sum(fixed(ends[0])), fixed(ends[1])[0])
            except (Unknown, IndexError):
                proven = False
            if not proven:
                raise Refused(f"output {name} at {time} s is not proven to be between {ends[0]} and {ends[1]}")


def _polynomial(space: Space, coefficients: list[float]) -> Model:
    if len(coefficients) > space.count:
        raise Refused("a polynomial is too long")
    return space.polynomial(coefficients)


def _enclosed(
    evaluate: Callable[[State], list[_Dual]], about: State, unknowns: list[tuple[str, int]]
) -> tuple[State, Matrix]:
    """The state with radii of the unknowns within which a solution is (Krawczyk), and an approximate inverse."""

    def with_radii(state: State, radii: Sequence[int]) -> State:
        columns = {name: list(own) for name, own in state.items()}
        for (name, place), radius in zip(unknowns, radii):
            columns[name][place] = columns[name][place].with_radius(radius)
        return columns

    def slopes(rows: list[_Dual]) -> Matrix:
        zero = rows[0].value.space.zero()
        return [[row.by.get(unknown, zero) for unknown in unknowns] for row in rows]

    if not unknowns:
        return about, []
    none = [0] * len(unknowns)
    bare = {name: [own.bare() for own in column] for name, column in about.items()}
    inverse = _inverse(slopes(evaluate(bare)))
    missed = _apply(_sizes(inverse), [row.value.size() for row in evaluate(with_radii(about, none))])
    box = missed
    for _ in range(12):
        state = with_radii(about, box)
        contraction = _sizes(_off_identity(_times(inverse, slopes(evaluate(state)))))
        mapped = [a + b for a, b in zip(_apply(contraction, box), missed)]
        if all(sum(row) < ONE for row in contraction) and all(own <= other for own, other in zip(mapped, box)):
            return with_radii(about, mapped), inverse
        if max(mapped) > ONE << 40:
            break
        box = [own + own // 4 + 1 for own in mapped]
    raise Unknown


@dataclass
class _Frame:
    """e = B z with |z_i| <= r_i."""

    directions: Matrix
    inverse: Matrix
    radii: list[int]

    @staticmethod
    def of_box(space: Space, radii: list[int]) -> _Frame:
        size = range(len(radii))
        identity = [[space.one() if i == j else space.zero() for j in size] for i in size]
        return _Frame(identity, identity, radii)

    def error(self) -> list[int]:
        return _apply(_sizes(self.directions), self.radii)

    def turned(self) -> tuple[_Frame, list[int]]:
        """B P R^-1 of B P = Q R at the centre, for columns in the order of their contributions, and its error."""
        space, size = self.directions[0][0].space, len(self.radii)
        centre = list(zip(*_centre(self.directions)))
        order = sorted(range(size), key=lambda column: -self.radii[column] * math.hypot(*centre[column]))
        triangular = [[0.0] * size for _ in range(size)]
        basis: list[list[float]] = []
        for place, column in enumerate(order):
            rest = list(centre[column])
            for row, own in enumerate(basis):
                triangular[row][place] = sum(a * b for a, b in zip(own, rest))
                rest = [a - triangular[row][place] * b for a, b in zip(rest, own)]
            length = math.hypot(*rest)
            if length == 0:
                raise Unknown
            triangular[place][place] = length
            basis.append([value / length for value in rest])
        upper = _numeric_inverse(triangular)
        places = [order.index(column) for column in range(size)]
        factor = _constant(space, [[row[places[column]] for column in range(size)] for row in triangular])
        back = _constant(space, [upper[places[row]] for row in range(size)])
        directions = _bare(_roughly(self.directions, back))
        # B z = B' (R P^T z) + (B - B' R P^T) z, whatever B' is.
        rest_of = _times(directions, factor)
        lost = [[a - b for a, b in zip(*rows)] for rows in zip(self.directions, rest_of)]
        inverse = _refined(_roughly(factor, self.inverse), directions)
        radii = _apply(_sizes(factor), self.radii)
        return _Frame(directions, inverse, radii), _apply(_sizes(lost), self.radii)


class _Cell:
    """The motion over a cell of time."""

    def __init__(
        self, checker: _Checker, own: dict[str, Any], time: float, start: list[list[Model]], frame: _Frame
    ) -> None:
        system = checker.system
        self.checker, self.frame, self.n = checker, frame, system.n
        n, m = system.n, system.m
        try:
            self.middle, self.half = _number(own["middle"]), _number(own["half"])
            blocks = {name: [_numbers(text) for text in own[name]] for name in ("w", "lambda")}
            tube = [fixed(value)[0] for value in _numbers(own["tube"])]
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise Refused(f"it is no cell: {error}") from error
        if [len(blocks["w"]), len(blocks["lambda"]), len(tube)] != [n, m, 2 * n]:
            raise Refused("polynomials and radii are not as many as coordinates")
        if not 0 < self.half <= 1 or math.frexp(self.half)[0] != 0.5 or self.middle / self.half % 1 != 0:
            raise Refused("half its length is no power of two, or its middle no multiple of that")
        if self.middle - self.half != time:
            raise Refused(f"it begins at {self.middle - self.half} s")
        self.end = self.middle + self.half
        #: half = 2**-self.places
        self.places = 1 - math.frexp(self.half)[1]
        self.unknowns = [*(("w", place) for place in range(n)), *(("lambda", place) for place in range(m))]
        w, multipliers = ([_polynomial(checker.fine, c) for c in blocks[name]] for name in ("w", "lambda"))
        v = [self._integral(a, b) for a, b in zip(start[1], w)]
        q = [self._integral(a, b) for a, b in zip(start[0], v)]
        self.state: State = {"q": q, "v": v, "w": w, "lambda": multipliers}
        begun = [self._at(own_model, -ONE, checker.box) for own_model in (*q, *v)]
        jump = [(a - b).size() for a, b in zip(begun, (*start[0], *start[1]))]
        self._prove(tube, jump)

    def _time(self, space: Space) -> Model:
        half = fixed(self.half)[0]
        middle, error = fixed(self.middle)
        return space.variable(0, middle, half, error)

    def _integral(self, start: Model, of: Model) -> Model:
        """start + half times the integral from -1, without powers above the order."""
        space = of.space
        out = [0] * space.count
        for c, powers in zip(start.c, start.space.powers):
            if (0, *powers) in space.index:
                out[space.index[(0, *powers)]] = c
        for c, (power, *rest) in zip(of.c, space.powers):
            raised = space.index.get((power + 1, *rest))
            if c and raised is not None:
                step = (c >> self.places) // (power + 1)
                out[raised] += step
                out[space.index[(0, *rest)]] -= step if (power + 1) % 2 == 0 else -step
        return Model(space, out, 0)

    def _rate(self, of: Model) -> Model:
        """d/dt."""
        space = of.space
        out = [0] * space.count
        for c, (power, *rest) in zip(of.c, space.powers):
            if power:
                out[space.index[(power - 1, *rest)]] = (c * power) << self.places
        return Model(space, out, 0)

    def _at(self, of: Model, tau: int, box: Space) -> Model:
        """At an instant."""
        powers, out, lost = [ONE], [0] * box.count, 0
        for _ in range(of.space.order):
            powers.append(powers[-1] * tau >> SCALE)
        for c, (power, *rest) in zip(of.c, of.space.powers):
            if c:
                out[box.index[tuple(rest)]] += c * powers[power] >> SCALE
                # The error of a power in units is at most its exponent.
                lost += up(abs(c) * power) + 1
        return Model(box, out, of.radius + lost)

    def _prove(self, tube: list[int], jump: list[int]) -> None:
        checker, n = self.checker, self.n
        system, fine, coarse = checker.system, checker.fine, checker.coarse
        entry = [a + b for a, b in zip(self.frame.error(), jump)]
        parameters = checker._parameters(fine, 1)
        rows = _evaluate(system, system.motion, fine, self._time(fine), parameters, self.state, derive=False)
        residual = [row.value.size() for row in rows]
        q, v, w = (self.state[name] for name in ("q", "v", "w"))
        kinematic = [(by - self._rate(of)).size() for of, by in (*zip(q, v), *zip(v, w))]

        def cut(model: Model) -> Model:
            rest = sum(map(abs, model.c[coarse.count :]))
            return Model(coarse, model.c[: coarse.count], model.radius + rest)

        about = {name: [cut(own) for own in column] for name, column in self.state.items()}
        for name, radii in (("q", tube[:n]), ("v", tube[n:])):
            about[name] = [own.with_radius(own.radius + radius) for own, radius in zip(about[name], radii)]
        time, parameters = self._time(coarse), checker._parameters(coarse, 1)

        def evaluate(state: State) -> list[_Dual]:
            return _evaluate(system, system.motion, coarse, time, parameters, state, derive=True)

        state, inverse = _enclosed(evaluate, about, self.unknowns)
        # The approximations themselves are to be in the enclosure, too.
        for name in ("w", "lambda"):
            both = zip(state[name], about[name])
            state[name] = [own.with_radius(max(own.radius, other.radius)) for own, other in both]
        rows = evaluate(state)
        zero = coarse.zero()
        by_unknowns = [[row.by.get(place, zero) for place in self.unknowns] for row in rows]
        places = [(name, place) for name in ("q", "v") for place in range(n)]
        by_state = [[row.by.get(place, zero) for place in places] for row in rows]
        contraction = _sizes(_off_identity(_times(inverse, by_unknowns)))
        sizes = _apply(_sizes(inverse), residual)
        beyond = _resolvent(contraction, [[size] for size in sizes])
        missed = [size + more[0] for size, more in zip(sizes, beyond)][:n]
        defect = [rate + more for rate, more in zip(kinematic, [*[0] * n, *missed])]
        # A = -J^-1 F_y, and J^-1 = (C J)^-1 C.
        slopes = [[-own for own in row] for row in _times(inverse, by_state)]
        beyond = _resolvent(contraction, _sizes(slopes))
        slopes = [[own.with_radius(own.radius + more) for own, more in zip(*both)] for both in zip(slopes[:n], beyond)]
        identity = [[ONE if column == n + row else 0 for column in range(2 * n)] for row in range(n)]
        first_order = [*identity, *_sizes(slopes)]
        duration = fixed(2 * self.half)[0]
        reached = _majorant(first_order, entry, duration, defect)
        for place, (found, radius) in enumerate(zip(reached, tube)):
            if not found < radius:
                kind = f"position {place}" if place < n else f"velocity {place - n}"
                raise Refused(
                    f"{kind} may be {found / ONE:.3e} from its polynomials, and the radius is {radius / ONE:.3e}"
                )
        self.growth = _majorant(first_order, jump, duration, defect)
        self._flow(slopes, first_order, duration)

    def _flow(self, slopes: Matrix, first_order: Bounds, duration: int) -> None:
        """Some polynomials near the transition matrix, and its distance from them."""
        n, space = self.n, self.checker.coarse
        box = self.checker.coarse_box
        unit = [[box.one() if i == j else box.zero() for j in range(2 * n)] for i in range(2 * n)]
        flow = [[space.one() if i == j else space.zero() for j in range(2 * n)] for i in range(2 * n)]
        rough = _bare(slopes)
        for _ in range(space.order + 2):
            rates = _roughly(rough, flow)
            lower = [[self._integral(a, b) for a, b in zip(*both)] for both in zip(unit[n:], rates)]
            upper = [[self._integral(a, b) for a, b in zip(*both)] for both in zip(unit[:n], lower)]
            flow = [*upper, *lower]
        rates = [*flow[n:], *_times(slopes, flow)]
        begun = _sizes(_off_identity([[self._at(own, -ONE, box) for own in row] for row in flow]))
        residual = [[(rate - self._rate(own)).size() for rate, own in zip(*both)] for both in zip(rates, flow)]
        columns = [_majorant(first_order, start, duration, rate) for start, rate in zip(zip(*begun), zip(*residual))]
        self.flow, self.missed = flow, [list(row) for row in zip(*columns)]

    def at(self, time: float) -> State:
        """The motion at an instant; positions and velocities have radii."""
        n, box, coarse_box = self.n, self.checker.box, self.checker.coarse_box
        middle, half = fixed(self.middle)[0], fixed(self.half)[0]
        instant, error = fixed(time)
        tau, rest = divmod(instant - middle << SCALE, half)
        if error or rest:
            raise Unknown
        state = {name: [self._at(own, tau, box) for own in column] for name, column in self.state.items()}
        moved = _times([[self._at(own, tau, coarse_box) for own in row] for row in self.flow], self.frame.directions)
        errors = [
            sum(parts)
            for parts in zip(
                _apply(_sizes(moved), self.frame.radii), _apply(self.missed, self.frame.error()), self.growth
            )
        ]
        for name, radii in (("q", errors[:n]), ("v", errors[n:])):
            state[name] = [own.with_radius(own.radius + radius) for own, radius in zip(state[name], radii)]
        return state

    def next(self) -> tuple[list[list[Model]], _Frame]:
        """Polynomials at the end, and the frame there."""
        box, coarse_box = self.checker.box, self.checker.coarse_box
        ends = [[self._at(own, ONE, box) for own in self.state[name]] for name in ("q", "v")]
        added = [own.radius for column in ends for own in column]
        flow = [[self._at(own, ONE, coarse_box) for own in row] for row in self.flow]
        moved = _times(flow, self.frame.directions)
        lost = _apply([[own.radius for own in row] for row in moved], self.frame.radii)
        directions = _bare(moved)
        inverse = _refined(_roughly(self.frame.inverse, _inverse(flow)), directions)
        frame = _Frame(directions, inverse, self.frame.radii)
        sizes, distance = _sizes(directions), frame.error()
        enlarged = _apply(sizes, _apply(_sizes(inverse), distance))
        if any(large > SKEW * own for large, own in zip(enlarged, distance)):
            frame, rest = frame.turned()
            lost = [a + b for a, b in zip(lost, rest)]
        contraction = _sizes(_off_identity(_times(frame.inverse, frame.directions)))
        missed = _apply(self.missed, self.frame.error())
        seen = _apply(_sizes(frame.inverse), [sum(parts) for parts in zip(lost, missed, self.growth, added)])
        beyond = _resolvent(contraction, [[own] for own in seen])
        radii = [a + b + c[0] for a, b, c in zip(frame.radii, seen, beyond)]
        bare = [[own.bare() for own in column] for column in ends]
        return bare, _Frame(frame.directions, frame.inverse, radii)
