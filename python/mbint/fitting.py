"""Fits: parameters that agree with measured values."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from ._command import NOT_MET, UNRESOLVED, invoke
from .study import Study

if TYPE_CHECKING:
    from .study import Model, Value


@dataclass(frozen=True)
class Fit:
    """Parameters that agree with measured values.

    Attributes:
        parameters: a row for each parameter: ``estimate`` and ``deviation`` by least squares, ``lower`` and ``upper`` of the consistent set, in SI.
        rows: a row for each measured value: ``measured``, ``noise``, ``fitted``, ``residual``, ``error``, in SI.
        consistent: whether parameters may agree with all rows.
        overlay: consistent intervals, for the argument ``set`` of other functions; empty if ``consistent`` is false.
        result: ``fit.json``: correlations, principal axes, projections, and the rows that nothing explains.
    """

    parameters: pd.DataFrame
    rows: pd.DataFrame
    consistent: bool
    overlay: dict[str, tuple[float, float]]
    result: dict[str, Any]


def fit(
    model: Model,
    data: str | Path | pd.DataFrame,
    *,
    noise: Mapping[str, str | float] | None = None,
    set: Mapping[str, Value] | None = None,  # the name of the command's option
    scene: str | None = None,
    threads: int | None = None,
    costly: bool = False,
) -> Fit:
    """Finds the parameters, within the model's intervals, that agree with measured values.

    Args:
        model: path of a model file, or its content as a dictionary.
        data: a table, or the path of a CSV file: columns ``time``, outputs by their names, perhaps ``NAME_noise``.
        noise: bounds of the noise of outputs that have no such column, as ``{"x3": "1 mm"}``.
        set: parameters that differ from the file's.
        scene: scene of the model.
        threads: number of threads; results do not depend on it.
        costly: whether to run if it takes more than about a minute.

    Raises:
        MbintError: the model or the data have errors.
    """
    study = Study(model, set=set, scenes=[scene] if scene is not None else None, threads=threads, costly=costly)
    with tempfile.TemporaryDirectory(prefix="mbint-") as folder:
        path = Path(folder) / "data.csv"
        if isinstance(data, pd.DataFrame):
            data.to_csv(path, index=False)
        else:
            path = Path(data).absolute()
        arguments = ["fit", str(study.model), str(path), "--output", str(Path(folder) / "out"), "--quiet"]
        arguments += [part for name, bound in (noise or {}).items() for part in ("--noise", f"{name}={bound}")]
        invoke([*arguments, "--color", "never", *study.options], accepted=frozenset({0, UNRESOLVED, NOT_MET}))
        found = json.loads((Path(folder) / "out" / "fit.json").read_text(encoding="utf-8"))
        rows = pd.read_csv(Path(folder) / "out" / "fit.csv")
    parameters = pd.DataFrame(
        [
            {
                "parameter": own["name"],
                "unit": own["unit"],
                "estimate": own["estimate"],
                # JSON has no infinity.
                "deviation": float("inf") if own["deviation"] is None else own["deviation"],
                "lower": own["hull"][0] if own["hull"] else float("nan"),
                "upper": own["hull"][1] if own["hull"] else float("nan"),
            }
            for own in found["parameters"]
        ]
    ).set_index("parameter")
    overlay = {own["name"]: (own["hull"][0], own["hull"][1]) for own in found["parameters"] if own["hull"]}
    return Fit(parameters, rows, consistent=found["set"] is not None, overlay=overlay, result=found)
