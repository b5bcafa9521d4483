"""Designs: nominal values that are best with their tolerances."""

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
class Design:
    """Nominal values that are best with the tolerances about them.

    Attributes:
        points: a row for each point (``model``, ``without tolerances``, ``optimum``, …): the values of free parameters, ``nominal``, ``worst``, ``error``, ``feasible``, in SI.
        feasible: whether all requirements hold at the optimum; if not, it is the nearest point.
        front: cost against margin, a row for each margin: ``margin``, ``error``, ``cost``, the values of free parameters, ``NAME.above`` and ``NAME.below`` of each tolerance, in SI; empty if tolerances have no cost.
        overlay: the best values with their tolerances, for the argument ``set`` of other functions; if the cost is the objective, the other tolerances too.
        result: ``design.json``: verdicts, profiles, tolerances by their cost.
    """

    points: pd.DataFrame
    feasible: bool
    overlay: dict[str, tuple[float, float] | float]
    front: pd.DataFrame
    result: dict[str, Any]


def design(
    model: Model,
    share: float | None = None,
    *,
    set: Mapping[str, Value] | None = None,  # the name of the command's option
    scene: str | None = None,
    threads: int | None = None,
    costly: bool = False,
) -> Design:
    """Finds the nominal values, within the ranges of the model's ``design``, that are best in its ``objective``.

    Args:
        model: path of a model file, or its content as a dictionary.
        share: share of the production that counts; every case if absent.
        set: parameters that differ from the file's.
        scene: scene of the model.
        threads: number of threads; results do not depend on it.
        costly: whether to run if it takes more than about a minute.

    Raises:
        MbintError: the model has errors, or no ``design``.
    """
    study = Study(model, set=set, scenes=[scene] if scene is not None else None, threads=threads, costly=costly)
    with tempfile.TemporaryDirectory(prefix="mbint-") as folder:
        out = Path(folder) / "out"
        arguments = ["design", str(study.model), "--output", str(out), "--quiet"]
        if share is not None:
            arguments += ["--yield", str(share)]
        invoke([*arguments, "--color", "never", *study.options], accepted=frozenset({0, UNRESOLVED, NOT_MET}))
        found = json.loads((out / "design.json").read_text(encoding="utf-8"))
        points = pd.read_csv(out / "design.csv").set_index("point")
        path = out / "front.csv"
        front = pd.read_csv(path) if path.exists() else pd.DataFrame()
    best = found["optima"][0]
    overlay: dict[str, tuple[float, float] | float] = {}
    for own, value, (above, below) in zip(found["parameters"], best["values"], best["deviations"], strict=True):
        overlay[own["name"]] = (value - below, value + above) if above + below > 0 else value
    chosen = found.get("allocation", {}).get("tolerances", []) if found["objective"]["text"] == "cost" else []
    for own in chosen:
        nominal, after = own["nominal"], own["after"]
        # A deviation about another parameter has no value of its own.
        if own["is_free"] and own["parameter"] not in overlay and nominal is not None:
            overlay[own["parameter"]] = (nominal - after["below"], nominal + after["above"])
    return Design(points, feasible=best["is_feasible"], overlay=overlay, front=front, result=found)
