"""Further questions about a model: is it right, other values, tolerances that suffice, what accuracy costs, have bounds moved?"""

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

#: Values of a swept parameter: from, to, and their number, perhaps with a text behind each, as ``"mm ± 1%"``.
Values = tuple[float, float, int] | tuple[float, float, int, str]


@dataclass(frozen=True)
class Allocation:
    """Tolerances that were found.

    Attributes:
        tolerances: a row for each parameter: the tolerance, its cost and its share before and after.
        overlay: parameters with these tolerances, for the argument ``set`` of other functions; empty if ``met`` is false.
        met: whether all requirements can be met.
        confirmed: whether a study with these tolerances confirms it.
    """

    tolerances: pd.DataFrame
    overlay: dict[str, str]
    met: bool
    confirmed: bool


def check(model: Model, *, set: Mapping[str, Value] | None = None) -> dict[str, Any]:
    """Coordinates, constraints, degrees of freedom and warnings of a model, without a run.

    Raises:
        MbintError: the model has errors; all of them, each with its line.
    """
    study = Study(model, set=set)
    arguments = ["check", str(study.model), "--color", "never", *study.options]
    # Errors for people first.
    invoke(arguments)
    (found,) = json.loads(invoke([*arguments, "--format", "json"]).stdout)
    answer: dict[str, Any] = found
    return answer


def sweep(
    model: Model,
    values: Mapping[str, Values],
    *,
    set: Mapping[str, Value] | None = None,
    scene: str | None = None,
    threads: int | None = None,
    costly: bool = False,
) -> pd.DataFrame:
    """Bounds of reduced outputs and verdicts of requirements for values of one or two parameters.

    Args:
        model: path of a model file, or its content as a dictionary.
        values: for each parameter its first and last value and the number of values, as ``{"l1": (100, 200, 11, "mm ± 1%")}``; without a
            text behind them, numbers are in SI units and have no tolerance.
        set: parameters that differ from the file's.
        scene: scene of the model.
        threads: number of threads.
        costly: whether to run if one value takes more than about a minute.

    Returns:
        ``sweep.csv``: a row for each combination of values.

    Raises:
        MbintError: the model or the values have errors.
    """
    swept = []
    for name, (first, last, count, *behind) in values.items():
        swept += ["--set", f"{name}={float(first)!r}..{float(last)!r}:{count} {' '.join(map(str, behind))}".rstrip()]
    study = Study(model, set=set, scenes=_one(scene), threads=threads, costly=costly)
    with tempfile.TemporaryDirectory(prefix="mbint-") as folder:
        arguments = [
            "sweep",
            str(study.model),
            "--output",
            folder,
            "--quiet",
            "--color",
            "never",
            *swept,
            *study.options,
        ]
        invoke(arguments, accepted=frozenset({0, UNRESOLVED, NOT_MET}))
        return pd.read_csv(Path(folder) / "sweep.csv")


def allocate(
    model: Model,
    share: float | None = None,
    *,
    widest: float | None = None,
    set: Mapping[str, Value] | None = None,
    scene: str | None = None,
    threads: int | None = None,
    costly: bool = False,
) -> Allocation:
    """The cheapest, or loosest, tolerances with which all requirements hold.

    Args:
        model: path of a model file, or its content as a dictionary.
        share: share of the production that meets all requirements; in every case if absent.
        widest: widest tolerances of the search, as multiples of the model's.
        set: parameters that differ from the file's.
        scene: scene of the model.
        threads: number of threads.
        costly: whether to run if it takes more than about a minute.

    Raises:
        MbintError: the model has errors, no requirement, or no tolerance that may change.
    """
    study = Study(model, set=set, scenes=_one(scene), threads=threads, costly=costly)
    with tempfile.TemporaryDirectory(prefix="mbint-") as folder:
        arguments = ["allocate", str(study.model), "--output", folder, "--quiet", "--color", "never", *study.options]
        arguments += ["--yield", f"{100 * share!r}%"] if share is not None else []
        arguments += ["--widest", repr(float(widest))] if widest is not None else []
        status = invoke(arguments, accepted=frozenset({0, UNRESOLVED, NOT_MET})).returncode
        overlay: dict[str, str] = {}
        if (file := Path(folder) / "allocation.yaml").is_file():
            # Lines of the form `  NAME: VALUE`, below `parameters:`.
            lines = file.read_text(encoding="utf-8").split("parameters:\n", 1)[1].splitlines()
            overlay = {name.strip(): value.strip() for name, value in (line.split(":", 1) for line in lines)}
        table = pd.read_csv(Path(folder) / "allocation.csv", index_col="parameter")
        return Allocation(table, overlay, met=status != NOT_MET, confirmed=status == 0)


def cost(
    model: Model,
    tolerance: float = 1e-3,
    budget: float = 60.0,
    *,
    set: Mapping[str, Value] | None = None,
    scene: str | None = None,
    threads: int | None = None,
) -> pd.DataFrame:
    """Cost of accuracy in time: every method with many settings, each with its error against a reference.

    Args:
        model: path of a model file, or its content as a dictionary.
        tolerance: wanted error, relative to the range of each output.
        budget: approximate limit of the duration, s.
        set: parameters that differ from the file's.
        scene: scene of the model.
        threads: number of threads.

    Returns:
        ``cost.csv``: a row for each setting.

    Raises:
        MbintError: the model has errors, or a reference takes longer than the budget.
    """
    study = Study(model, set=set, scenes=_one(scene), threads=threads)
    with tempfile.TemporaryDirectory(prefix="mbint-") as folder:
        asked = ["--tolerance", repr(float(tolerance)), "--budget", repr(float(budget))]
        invoke(["cost", str(study.model), "--output", folder, "--quiet", "--color", "never", *asked, *study.options])
        return pd.read_csv(Path(folder) / "cost.csv")


def snapshot(model: Model, folder: str | Path, *, check: bool = False, scene: str | None = None) -> bool:
    """Records bounds as small text files in a folder, or compares with the record.

    Args:
        model: path of a model file, or its content as a dictionary.
        folder: folder of the snapshots.
        check: whether to compare with the record, and write nothing.
        scene: scene of the model; by default all.

    Returns:
        Whether there is a record from which no bound has moved.

    Raises:
        MbintError: the model has errors.
    """
    study = Study(model, scenes=_one(scene))
    arguments = ["snapshot", str(study.model), "--output", str(folder), "--quiet", "--color", "never", *study.options]
    done = invoke(arguments + (["--check"] if check else []), accepted=frozenset({0, NOT_MET}))
    return done.returncode == 0


def _one(scene: str | None) -> list[str] | None:
    return [scene] if scene is not None else None
