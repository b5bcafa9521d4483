"""The second checker: its arithmetic against exact numbers, and certificates of the command. The variable MBINT names that."""

import json
import math
import random
from fractions import Fraction
from pathlib import Path

import pytest

from mbint import certificate, command
from mbint._command import invoke
from mbint._taylor import ONE, SCALE, Model, Space

#: The pendulum of the library of benchmarks over a short time.
PENDULUM = """
model: pendulum
parameters: { length: 1 m ± 5 mm, g: 9.81 }
bodies: { bob: { mass: 1, coordinates: [x, y] } }
joints: { rod: { distance: { between: [ground, bob], length: length } } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { bob.y: 0, bob.vy: 0 }
guess: { bob.x: -1 }
outputs: { x: bob.x, y: bob.y, tension: rod.force }
simulation: { duration: 0.4, step: 0.01, output_step: 0.1 }
"""


def at(model: Model, point: tuple[Fraction, ...]) -> Fraction:
    """A polynomial's exact value."""
    terms = zip(model.c, model.space.powers)
    return sum((Fraction(c, ONE) * math.prod(x**p for x, p in zip(point, powers)) for c, powers in terms), Fraction(0))


def off(model: Model, point: tuple[Fraction, ...], exact: Fraction) -> Fraction:
    """Distance of a number beyond a model's radius."""
    return abs(at(model, point) - exact) - Fraction(model.radius, ONE)


def test_models_hold_exact_results() -> None:
    draw = random.Random(42)
    space = Space(2, 5)
    for _ in range(20):
        a, b = (
            Model(space, [draw.randrange(-ONE // 8, ONE // 8) for _ in range(space.count)], draw.randrange(ONE >> 40))
            for _ in range(2)
        )
        b.c[0] += 4 * ONE
        for _ in range(5):
            point = tuple(Fraction(draw.randrange(-64, 65), 64) for _ in range(2))
            # Numbers that the models stand for, at the ends of their radii.
            x, y = (at(own, point) + draw.choice([-1, 1]) * Fraction(own.radius, ONE) for own in (a, b))
            assert off(a + b, point, x + y) <= 0
            assert off(a - b, point, x - y) <= 0
            assert off(a * b, point, x * y) <= 0
            assert off(a / b, point, x / y) <= 0
            root = b.sqrt()
            low, high = (at(root, point) + side * Fraction(root.radius, ONE) for side in (-1, 1))
            assert low**2 <= y <= high**2
            # Sine and cosine against those of floats.
            sine, cosine = b.sin_cos()
            assert off(sine, point, Fraction(math.sin(y))) <= 1e-15
            assert off(cosine, point, Fraction(math.cos(y))) <= 1e-15
    # The terms that are cut off are of the sixth degree: 32^-6/6! = 1.3e-12 of the argument.
    small = Model(space, [3 * ONE, ONE // 64, ONE // 64, *[0] * (space.count - 3)], 0)
    assert 0 < small.sin_cos()[0].radius < ONE // 10**11


def test_ends_of_polynomials_are_found() -> None:
    space = Space(2, 3)
    model = space.zero()
    # x^3 - x + y^2 is between -2/(3 sqrt 3) and 1 + 2/(3 sqrt 3).
    for powers, c in (((3, 0), 1), ((1, 0), -1), ((0, 2), 1)):
        model.c[space.index[powers]] = c * ONE
    end, unit = int(ONE * 2 / math.sqrt(27)), ONE >> 30
    assert model.is_within(-end - unit, ONE + end + unit)
    assert not model.is_within(-end + 1000 * unit, ONE + end + unit)
    assert not model.is_within(-end - unit, ONE + end - 1000 * unit)
    assert SCALE > 100


@pytest.fixture(scope="module")
def proven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the pendulum and its certificate."""
    folder = tmp_path_factory.mktemp("certificate")
    (folder / "pendulum.yaml").write_text(PENDULUM, encoding="utf-8")
    arguments = ["run", "pendulum.yaml", "--certify", "--method", "certified", "--no-report", "-q"]
    paths = [str(folder / "pendulum.yaml"), "-o", str(folder / "out")]
    invoke([arguments[0], paths[0], *arguments[2:], *paths[1:]])
    return folder


def test_a_certificate_of_the_command_is_accepted(proven: Path) -> None:
    assert command()
    found = certificate.check(proven / "out/certificate.jsonl", model=proven / "pendulum.yaml")
    assert (found.pieces, found.bounds) == (1, 15)


def test_a_certificate_of_a_closed_mechanism_is_accepted(tmp_path: Path) -> None:
    model = Path(__file__).parents[2] / "models/slider_crank_one.yaml"
    text = model.read_text(encoding="utf-8").replace("duration: 2,", "duration: 0.05,")
    (tmp_path / "crank.yaml").write_text(text, encoding="utf-8")
    paths = [str(tmp_path / "crank.yaml"), "-o", str(tmp_path / "out")]
    invoke(["run", *paths, "--certify", "--method", "certified", "--set", "l1=0.15±0.1%", "--no-report", "-q"])
    found = certificate.check(tmp_path / "out/certificate.jsonl", model=tmp_path / "crank.yaml")
    assert (found.pieces, found.bounds) == (1, 12)


def changed(proven: Path, kind: str, change: dict[str, object]) -> Path:
    """The certificate with the first line of a kind changed."""
    lines = (proven / "out/certificate.jsonl").read_text(encoding="utf-8").splitlines()
    place = next(place for place, line in enumerate(lines) if line.startswith('{"' + kind + '"'))
    own = json.loads(lines[place])
    own[kind] |= change
    lines[place] = json.dumps(own)
    path = proven / "changed.jsonl"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def of(proven: Path, kind: str) -> dict[str, list[str]]:
    lines = (proven / "out/certificate.jsonl").read_text(encoding="utf-8").splitlines()
    own: dict[str, list[str]] = next(json.loads(line)[kind] for line in lines if line.startswith('{"' + kind + '"'))
    return own


def test_changed_certificates_are_refused(proven: Path) -> None:
    w = of(proven, "cell")["w"]
    first, rest = w[1].split(" ", 1)
    wrong = (float.fromhex(first) * (1 + 1e-6)).hex()
    with pytest.raises(certificate.Refused, match=r"cell 1 from 0.0 s: \w+ \d may be .* from its polynomials"):
        certificate.check(changed(proven, "cell", {"w": [w[0], f"{wrong} {rest}"]}))
    with pytest.raises(certificate.Refused, match="and the radius is"):
        certificate.check(changed(proven, "cell", {"tube": " ".join(["0x1p-80"] * 4)}))
    with pytest.raises(certificate.Refused, match="half its length is no power of two"):
        certificate.check(changed(proven, "cell", {"half": "0x1.8p-6"}))
    with pytest.raises(certificate.Refused, match="cover the box"):
        certificate.check(changed(proven, "piece", {"lower": "0x1p0"}))
    with pytest.raises(certificate.Refused, match="positions of the start"):
        certificate.check(changed(proven, "piece", {"q": ["0x1p-4", "0"]}))
    upper = of(proven, "row")["bounds"][0].split()[1]
    with pytest.raises(certificate.Refused, match="output x at 0.0 s is not proven"):
        certificate.check(changed(proven, "row", {"bounds": [f"{upper} {upper}", None, None]}))
    nodes = [node.replace("0x1.39eb851eb851fp3", "0x1.3p3") for node in of(proven, "system")["nodes"]]
    with pytest.raises(certificate.Refused, match="may be"):
        certificate.check(changed(proven, "system", {"nodes": nodes}))
    other = proven / "other" / "pendulum.yaml"
    other.parent.mkdir(exist_ok=True)
    other.write_text(PENDULUM.replace("9.81", "9.8"), encoding="utf-8")
    with pytest.raises(certificate.Refused, match=r"pendulum.yaml is not the file that was certified"):
        certificate.check(proven / "out/certificate.jsonl", model=other)
    with pytest.raises(certificate.Refused, match="line 1 is not of a certificate"):
        certificate.check(changed(proven, "certificate", {"version": 2}))


def test_missing_cells_are_refused(proven: Path) -> None:
    lines = (proven / "out/certificate.jsonl").read_text(encoding="utf-8").splitlines()
    place = next(place for place, line in enumerate(lines) if line.startswith('{"cell"'))
    path = proven / "changed.jsonl"
    path.write_text("\n".join([*lines[: place + 1], *lines[place + 2 :]]), encoding="utf-8")
    with pytest.raises(certificate.Refused, match="cell 2 from .* it begins at"):
        certificate.check(path)
    path.write_text("\n".join(lines[:-1]), encoding="utf-8")
    with pytest.raises(certificate.Refused, match="its cells end at"):
        certificate.check(path)
