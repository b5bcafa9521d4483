"""Bounds of Python functions against closed forms."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import mbint


def pendulum(l: float, g: float = 9.81) -> float:
    """Period of small swings, s."""
    return 2 * np.pi * np.sqrt(l / g)


def spring(k: Any, m: Any) -> Any:
    """Position and velocity over time, for numbers or arrays of them."""
    w = np.sqrt(np.asarray(k) / m)[..., np.newaxis]
    return {"x": np.cos(w * TIMES), "v": -w * np.sin(w * TIMES)}


TIMES = np.linspace(0, 0.2, 11)
SPRING = {"k": (190, 210), "m": 2.0}


def test_a_newcomer_bounds_a_function_in_five_lines() -> None:
    study = mbint.bounds(pendulum, {"l": (0.14, 0.16)}, outputs={"period": "s"})
    lower, upper, error = study.bounds.chebyshev.sel(output="period").to_numpy()[0]
    assert abs(lower - pendulum(0.14)) <= error + 1e-12 and abs(upper - pendulum(0.16)) <= error + 1e-12
    assert error < 1e-6 and study.units == {"period": "s"}
    assert study.nominal[0, 0] == pytest.approx(pendulum(0.15), abs=1e-14)


@pytest.mark.parametrize("how", ["alone", "vectorised", "threads", "processes"])
def test_rows_are_those_of_the_closed_form(how: str) -> None:
    executors = {"threads": ThreadPoolExecutor, "processes": ProcessPoolExecutor}
    options: dict[str, Any] = (
        {"executor": executors[how](2)} if how in executors else {"vectorised": how == "vectorised"}
    )
    study = mbint.bounds(spring, SPRING, outputs=["x", "v"], times=TIMES, **options)
    band = study.bounds.chebyshev.sel(output="x")
    for bound, k in (("lower", 210), ("upper", 190)):
        off = np.abs(band.sel(bound=bound).to_numpy() - np.cos(np.sqrt(k / 2) * TIMES))
        assert np.all(off <= band.sel(bound="error").to_numpy() + 1e-12)
    np.testing.assert_allclose(study.bounds.time, TIMES, atol=1e-15)


def test_tables_and_datasets_are_answers() -> None:
    def table(k: float) -> pd.DataFrame:
        return pd.DataFrame({"t": TIMES, "x": k * TIMES})

    def dataset(k: float) -> xr.Dataset:
        return xr.Dataset({"x": ("time", k * TIMES)}, coords={"time": TIMES})

    def sequence(k: float) -> list[Any]:
        return [k * TIMES]

    expected = mbint.bounds(table, {"k": (1, 2)}, outputs=["x"], times=TIMES).frame
    for function in (dataset, sequence, lambda k: k * TIMES):
        pd.testing.assert_frame_equal(mbint.bounds(function, {"k": (1, 2)}, outputs=["x"], times=TIMES).frame, expected)


def test_all_that_a_study_has_is_there() -> None:
    more = {
        "outputs": {"x": "x", "farthest": {"max": "x"}},
        "requirements": {"near": "x <= 1.01"},
        "statistics": {"samples": 1024},
    }
    study = mbint.bounds(spring, SPRING, outputs={"x": "1", "v": "1/s"}, times=TIMES, tolerance=1e-3, more=more)
    assert study.result.verdicts.iloc[0]["verdict"] == "holds"
    assert study.summary["reduced"][0]["name"] == "farthest" and len(study.result.reduced) == 1
    assert len(study.result.statistics) == len(TIMES)


def test_an_exception_is_a_failed_sample() -> None:
    def fails(k: float) -> float:
        if k > 1.9:
            raise ValueError(f"no such spring: {k}")
        return k

    with pytest.raises(mbint.MbintError, match="ValueError: no such spring"):
        mbint.bounds(fails, {"k": (1, 2)})


def test_an_output_that_is_not_returned_is_named() -> None:
    with pytest.raises(mbint.MbintError, match="the function returned `y`, and no `x`"):
        mbint.bounds(lambda k: {"y": k}, {"k": (1, 2)}, outputs={"x": "m"})


def test_times_have_equal_distances() -> None:
    with pytest.raises(ValueError, match="equal distances"):
        mbint.bounds(spring, SPRING, times=[0, 1, 3])
