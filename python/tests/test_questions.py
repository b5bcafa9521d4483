"""Questions other than bounds over time, against sums of tolerances. The variable MBINT names the command."""

from pathlib import Path

import pandas as pd
import pytest

import mbint

#: A gap c - a - 2b of 1 mm, known to 0.6 mm.
STACK = {
    "model": "stack",
    "parameters": {
        "a": {"value": "30 mm", "tolerance": "0.1 mm"},
        "b": {"value": "10 mm", "tolerance": "0.2 mm"},
        "c": {"value": "51 mm", "tolerance": "0.1 mm"},
    },
    "bodies": {"block": {"mass": 1, "coordinates": ["x"]}},
    "initial": {"block.x": "c - a - 2*b", "block.vx": 0},
    "outputs": {"gap": "block.x", "widest": {"max": "gap"}},
    "requirements": {"fits": {"output": "gap", "min": "0.5 mm", "max": "1.5 mm"}},
    "simulation": {"duration": 0.02, "step": 0.01},
    "bounds": {"chebyshev": {"order": 1}},
}


def test_a_model_is_checked() -> None:
    found = mbint.check(STACK)
    assert (found["coordinates"], found["uncertain_parameters"]) == (1, ["a", "b", "c"])
    with pytest.raises(mbint.MbintError, match="unknown body or joint `blok`"):
        mbint.check(STACK | {"outputs": {"gap": "blok.x"}})


def test_verdicts_and_reduced_outputs_are_tables() -> None:
    study = mbint.run(STACK | {"statistics": {"quantiles": [0.5]}}).result
    (fits,) = study.verdicts.itertuples()
    assert fits.verdict == "violated"
    assert fits.margin == pytest.approx(-1e-4)
    assert study.reduced.loc[0, "upper"] == pytest.approx(1.6e-3)
    assert study.statistics["gap.mean"][0] == pytest.approx(1e-3)
    assert mbint.run(STACK | {"outputs": {"gap": "block.x"}, "requirements": {}}).result.reduced.empty


def test_values_are_swept() -> None:
    table = mbint.sweep(STACK, {"a": (29.9, 30.1, 2, "mm"), "b": (9.9, 10.0, 3, "mm ± 0.1 mm")})
    assert list(table["b"][:3]) == pytest.approx([9.9, 9.95, 10.0])
    margins = [0.5 - abs(51 - a - 2 * b - 1) - 0.3 for a in (29.9, 30.1) for b in (9.9, 9.95, 10.0)]
    assert list(table["fits.margin"]) == pytest.approx([1e-3 * margin for margin in margins], abs=1e-12)


def test_tolerances_are_allocated() -> None:
    found = mbint.allocate(STACK)
    assert found.met
    assert found.confirmed
    # One factor for all: 0.5 mm of 0.6.
    assert found.tolerances.loc["b", "after.above"] == pytest.approx(0.2e-3 * 5 / 6, rel=1e-3)
    assert mbint.run(STACK, set=found.overlay).result.verdicts["verdict"][0] == "holds"
    tight = {"fits": {"output": "gap", "max": "0.9 mm"}}
    assert not mbint.allocate(STACK | {"requirements": tight}).met


def test_parameters_are_fitted() -> None:
    line = {
        "model": "line",
        "parameters": {"x0": {"interval": [-1, 1], "unit": "m"}, "v": {"interval": [-1, 1], "unit": "m/s"}},
        "bodies": {"block": {"mass": 1, "coordinates": ["x"]}},
        "initial": {"block.x": "x0", "block.vx": "v"},
        "outputs": {"x": "block.x"},
        "simulation": {"duration": 1, "step": 0.1, "output_step": 0.1},
        "bounds": {"chebyshev": {"order": 1}},
    }
    # x0 within 0.29 and 0.31, x0 + v within 0.69 and 0.71.
    table = pd.DataFrame({"time": [0, 1], "x": [0.3, 0.7]})
    found = mbint.fit(line, table, noise={"x": "10 mm"})
    assert found.consistent
    # The hull covers the set, and is wider by parts of a box of the paving.
    assert 0.288 < found.parameters.loc["x0", "lower"] <= 0.29
    assert 0.31 <= found.parameters.loc["x0", "upper"] < 0.312
    assert found.parameters.loc["v", "estimate"] == pytest.approx(0.4)
    lower, upper = found.overlay["v"]
    assert 0.376 < lower <= 0.38
    assert 0.42 <= upper < 0.424
    assert len(found.rows) == 2
    wrong = mbint.fit(line, pd.DataFrame({"time": [0, 1], "x": [0.3, 5]}), noise={"x": 0.01})
    assert not wrong.consistent
    assert wrong.result["unexplained"]["worst"][0] in (0, 1)


def test_nominal_values_are_designed() -> None:
    plate = {
        "parameters": {"a": "0.9 m ± 1%", "b": 0.8},
        "outputs": {"edge": "a + b", "area": "a*b"},
        "requirements": {"large": {"output": "area", "min": 1}},
        "design": {"a": "0.5 to 1.5 m", "b": [0.5, 1.5]},
        "objective": {"least": "edge"},
    }
    # 1.01 a + b is least where 0.99 a b = 1.
    found = mbint.design(plate)
    assert found.feasible
    edge = 2 * (1.01 / 0.99) ** 0.5
    assert found.points.loc["optimum", "worst"] == pytest.approx(edge, rel=1e-3)
    assert found.result["parameters"][0]["range"] == [0.5, 1.5]
    assert mbint.run(plate, set=found.overlay).result.verdicts["verdict"][0] == "holds"
    assert not mbint.design(plate | {"requirements": {"large": {"output": "area", "min": 4}}}).feasible


def test_tolerances_are_chosen_with_nominal_values() -> None:
    stack = {
        "parameters": {
            "a": {"value": "30 mm", "tolerance": "0.1 mm", "cost": {"reciprocal": 1}},
            "b": {"value": "20.5 mm", "tolerance": "0.1 mm", "cost": {"reciprocal": 4}},
        },
        "outputs": {"gap": "a - b"},
        "requirements": {"fits": {"output": "gap", "min": "9.7 mm", "max": "10.3 mm"}},
        "design": {"b": "19 to 21 mm"},
        "objective": "cost",
    }
    # 0.3 mm in parts as 1 to 2: (1 + 2)^2 0.1/0.3.
    found = mbint.design(stack)
    assert found.feasible
    assert found.points.loc["optimum", "worst"] == pytest.approx(3, rel=1e-3)
    assert found.front["a.above"][0] == pytest.approx(1e-4, rel=1e-2)
    assert found.front["cost"].is_monotonic_increasing
    assert mbint.run(stack, set=found.overlay).result.verdicts["verdict"][0] == "holds"


def test_bounds_are_recorded_and_compared(tmp_path: Path) -> None:
    assert not mbint.snapshot(STACK, tmp_path, check=True)
    assert mbint.snapshot(STACK, tmp_path)
    assert mbint.snapshot(STACK, tmp_path, check=True)
    moved = STACK | {"initial": {"block.x": "c - a - 2*b + 1 mm", "block.vx": 0}}
    assert not mbint.snapshot(moved, tmp_path, check=True)


def test_costs_are_measured() -> None:
    spring = {"between": ["ground", "b"], "along": "x", "stiffness": 9, "free_length": 0}
    oscillator = {
        "bodies": {"b": {"mass": 1, "coordinates": ["x"]}},
        "effects": {"s": {"spring_damper": spring}},
        "initial": {"b.x": 1},
        "outputs": {"x": "b.x"},
        "simulation": {"duration": 0.5, "step": 1e-2},
    }
    table = mbint.cost(oscillator, budget=5)
    assert {"method", "seconds", "error"} <= set(table)


def test_a_pendulum_is_verified() -> None:
    pendulum = {
        "model": "pendulum",
        "bodies": {"bob": {"mass": "2 kg", "coordinates": ["x", "y"]}},
        "joints": {"rod": {"distance": {"between": ["ground", "bob"], "length": "1 m"}}},
        "effects": {"weight": {"gravity": {"acceleration": [0, -9.81]}}},
        "initial": {"bob.y": 0, "bob.vy": 0},
        "guess": {"bob.x": -1},
        "outputs": {"x": "bob.x"},
        "simulation": {"duration": 1, "step": 0.01},
    }
    found = mbint.verify(pendulum)
    assert found.verified
    assert not found.failures
    schemes = found.orders[found.orders["quantity"] == "positions"].set_index("scheme")["order"]
    assert schemes["HHT-I3"] == pytest.approx(2, rel=0.05)
    assert list(found.powers["effect"]) == ["weight"]
    # Gravity keeps energy: its power is that of its potential.
    assert found.powers["put_in"].max() == pytest.approx(0, abs=1e-9)
    # A force that jumps has no orders.
    struck = pendulum | {"effects": {"jump": {"force": {"on": "bob", "value": ["1 N*sign(bob.vx/(1 m/s))", 0]}}}}
    assert not mbint.verify(struck).verified
