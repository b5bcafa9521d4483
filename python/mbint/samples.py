"""Samples: outputs over time at chosen parameters."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

from ._command import ANOTHER_ROUND, invoke
from .study import Study, shard_all

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from .study import Model, Value

#: Points: a table with a column for each parameter, or the same as a dictionary, or a file of it.
Points = pd.DataFrame | Mapping[str, Any] | str | Path


def sample(
    model: Model,
    points: Points | None = None,
    *,
    design: str | None = None,
    seed: int = 0,
    set: Mapping[str, Value] | None = None,  # the name of the command's option
    scene: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    store: str | Path | None = None,
) -> xr.Dataset:
    """Simulates a model at points.

    Args:
        model: path of a model file, or its content as a dictionary.
        points: parameters of each sample in SI units: a table of pandas, a dictionary of columns, or the path of a CSV file.
        design: in place of points, ``"sobol:1000"`` or ``"lhs:1000"``: spread evenly over the tolerances.
        seed: another number makes another Latin hypercube.
        set: parameters that differ from the file's.
        scene: scene of the model to sample.
        threads: number of threads; results do not depend on it.
        executor: any executor of :mod:`concurrent.futures` runs the shards.
        store: folder for the simulations, from which an interrupted call continues.

    Returns:
        ``values`` over (sample, time, output), NaN where a sample cannot be assembled or from where it stopped, and ``parameters`` over
        (sample, parameter); units are coordinates.

    Raises:
        MbintError: the model or the points have errors, or a simulation failed.
    """
    study = Study(model, set=set, scenes=[scene] if scene is not None else None)
    with tempfile.TemporaryDirectory(prefix="mbint-") as temporary:
        asked = _points(points, Path(temporary)) if points is not None else []
        if design is not None:
            asked += ["--design", design, "--seed", str(seed)]
        file = Path(temporary) / "samples.npz"
        if executor is None:
            arguments = ["sample", str(study.model), "--output", str(file), "--quiet", *asked, *study.options]
            arguments += ["--threads", str(threads)] if threads is not None else []
            invoke([*arguments, *(["--store", str(store)] if store is not None else []), "--color", "never"])
        else:
            folder = str(store) if store is not None else str(Path(temporary) / "study")
            invoke(["plan", str(study.model), "--output", folder, *asked, *study.options, "--color", "never"])
            merged = ANOTHER_ROUND
            while merged == ANOTHER_ROUND:
                shard_all(executor, folder)
                merge = ["merge", folder, "--output", str(file), "--quiet", "--color", "never"]
                merged = invoke(merge, accepted=frozenset({0, ANOTHER_ROUND})).returncode
        return _dataset(file)


def _points(points: Points, folder: Path) -> list[str]:
    """The command's arguments; a table is written to a file."""
    if isinstance(points, (str, Path)):
        return ["--points", str(points)]
    path = folder / "points.csv"
    # As many digits as it takes to read the same numbers.
    pd.DataFrame(points).to_csv(path, index=False)
    return ["--points", str(path)]


def _dataset(file: Path) -> xr.Dataset:
    with np.load(file) as arrays:
        coords: dict[str, Any] = {
            "time": ("time", arrays["times"], {"units": "s"}),
            "output": list(map(str, arrays["output_names"])),
            "units": ("output", list(map(str, arrays["output_units"]))),
            "parameter": list(map(str, arrays["parameter_names"])),
            "parameter_units": ("parameter", list(map(str, arrays["parameter_units"]))),
        }
        values = (("sample", "time", "output"), arrays["values"])
        return xr.Dataset(
            {"values": values, "parameters": (("sample", "parameter"), arrays["parameters"])}, coords=coords
        )
