"""A study: a model, the questions about it, and their results."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

from ._command import ANOTHER_ROUND, WITH_RESULTS, invoke
from .result import Result

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from matplotlib.figure import Figure

#: A parameter's value: a number in SI units, two for an interval, or a text with unit and tolerance.
Value = str | float | Sequence[float]

#: A model: the path of a YAML or URDF file, or the content of a YAML file as a dictionary.
Model = str | Path | Mapping[str, Any]


class Study:
    """A model, and the questions about it.

    Args:
        model: path of a model file, or its content as a dictionary (formulas and values with units as strings).
        set: parameters that differ from the file's, as ``{"l1": "0.16 m ± 2%", "tau": 0.4, "k": (90, 110)}``; numbers are in SI
            units, and two of them are an interval.
        methods: methods to run; by default the model's.
        scenes: scenes to run; by default all.
        certify: whether to add certified bounds.
        threads: number of threads; results do not depend on it.
        skip_infeasible: whether to omit parameter values with which the mechanism cannot be assembled.
        costly: whether to run if it takes more than about a minute.
        folder: where the results are written; by default a temporary folder, which is removed with the study.
    """

    def __init__(
        self,
        model: Model,
        *,
        set: Mapping[str, Value] | None = None,  # the name of the command's option
        methods: Sequence[str] | None = None,
        scenes: Sequence[str] | None = None,
        certify: bool = False,
        threads: int | None = None,
        skip_infeasible: bool = False,
        costly: bool = False,
        folder: str | Path | None = None,
    ) -> None:
        self._temporary = tempfile.TemporaryDirectory(prefix="mbint-")
        self.folder = Path(folder) if folder is not None else Path(self._temporary.name) / "results"
        self.model = self._file(model)
        self.options: list[str] = []
        if set is not None and not isinstance(set, Mapping):
            raise TypeError(f'parameters are set by a dictionary, as {{"l1": "0.16 m"}}, not by a {type(set).__name__}')
        for name, value in (set or {}).items():
            self.options += ["--set", f"{name}={_value(name, value)}"]
        for method in _names(methods):
            self.options += ["--method", method]
        for scene in _names(scenes):
            self.options += ["--scene", scene]
        if threads is not None:
            self.options += ["--threads", str(threads)]
        flags = {"--certify": certify, "--skip-infeasible": skip_infeasible, "--yes": costly}
        self.options += [flag for flag, wanted in flags.items() if wanted]
        self.messages = ""

    def _file(self, model: Model) -> Path:
        """The model's file; a dictionary is written to one. JSON is YAML."""
        if isinstance(model, (str, Path)):
            return Path(model)
        if not isinstance(model, Mapping):
            raise TypeError(f"a model is the path of a file or a dictionary, not a {type(model).__name__}")
        path = Path(self._temporary.name) / "model.yaml"
        path.write_text(json.dumps(_spelled(model), ensure_ascii=False, indent=1, default=_plain), encoding="utf-8")
        return path

    def run(self, executor: Executor | None = None, *, store: str | Path | None = None, at_once: float = 10.0) -> Study:
        """Runs the study, and returns it.

        Warnings of the command are in ``messages``.

        Args:
            executor: any executor of :mod:`concurrent.futures` runs the shards, such as Dask's ``client.get_executor()``,
                ``mpi4py.futures`` or submitit's; without one, the command runs here. Results are the same to the bit. The
                workers need this package, and see the same files.
            store: folder for the simulations, from which an interrupted run continues; by default temporary.
            at_once: with an executor, simulations that take less than this on one core, in s, run here.

        Raises:
            MbintError: the model has errors, or a run failed.
        """
        self._forget()
        output = ["--output", str(self.folder), "--quiet", "--color", "never"]
        if executor is None:
            kept = ["--store", str(store)] if store is not None else []
            self.messages = invoke(
                ["run", str(self.model), *output, *kept, *self.options], accepted=WITH_RESULTS
            ).stderr.strip()
            return self
        study = str(Path(store) if store is not None else Path(self._temporary.name) / "study")
        planned = [option for option in self.options if option != "--yes"]
        invoke(["plan", str(self.model), "--output", study, "--at-once", repr(at_once), "--color", "never", *planned])
        while True:
            shard_all(executor, study)
            merged = invoke(["merge", study, *output], accepted=WITH_RESULTS | {ANOTHER_ROUND})
            if merged.returncode != ANOTHER_ROUND:
                self.messages = merged.stderr.strip()
                return self

    def _forget(self) -> None:
        for name in ("results", "result"):
            self.__dict__.pop(name, None)

    @cached_property
    def results(self) -> dict[str, Result]:
        """Results by scene; a model without scenes has one, under its name.

        Raises:
            FileNotFoundError: the study was not run.
        """
        if (self.folder / "summary.json").is_file():
            alone = Result(self.folder, self._temporary)
            return {alone.summary["model"]: alone}
        if not (self.folder / "scenes.json").is_file():
            raise FileNotFoundError(f"there are no results in {self.folder}; call run() first")
        scenes = json.loads((self.folder / "scenes.json").read_text(encoding="utf-8"))
        return {scene: Result(self.folder / scene, self._temporary) for scene in scenes["scenes"]}

    @cached_property
    def result(self) -> Result:
        """The only result.

        Raises:
            ValueError: there are several scenes; take ``study[name]``.
        """
        if len(self.results) != 1:
            raise ValueError(f"the model has scenes: {', '.join(self.results)}; take study[name]")
        return next(iter(self.results.values()))

    def __getitem__(self, scene: str) -> Result:
        return self.results[scene]

    def __iter__(self) -> Iterator[str]:
        return iter(self.results)

    def __len__(self) -> int:
        return len(self.results)

    def __repr__(self) -> str:
        return f"Study({str(self.model)!r}, {self.options})"

    @property
    def summary(self) -> dict[str, Any]:
        """``summary.json`` of the only result."""
        return self.result.summary

    @property
    def units(self) -> dict[str, str]:
        """Unit of each output."""
        return self.result.units

    @property
    def nominal(self) -> xr.DataArray:
        """Nominal outputs over (time, output)."""
        return self.result.nominal

    @property
    def bounds(self) -> xr.Dataset:
        """Bounds: a variable for each method over (time, output, bound)."""
        return self.result.bounds

    @property
    def unreliable(self) -> xr.Dataset:
        """Whether the stated error is unreliable: a variable for each method over (time, output)."""
        return self.result.unreliable

    @property
    def frame(self) -> pd.DataFrame:
        """``bounds.csv`` with the time as index."""
        return self.result.frame

    def plot(self, output: str | None = None, methods: list[str] | None = None) -> Figure:
        """Bounds over time; needs matplotlib."""
        return self.result.plot(output, methods)


def shard_all(executor: Executor, study: str) -> None:
    """Simulates all shards of a round.

    Raises:
        MbintError: one of them failed.
    """
    plan = json.loads((Path(study) / "plan.json").read_text(encoding="utf-8"))
    for done in [executor.submit(shard, study, index) for index in range(len(plan["shards"]))]:
        done.result()


def shard(study: str, index: int) -> None:
    """Simulates one shard of a planned study, on one thread, if it is not stored yet.

    Raises:
        MbintError: it failed.
    """
    invoke(["shard", study, "--index", str(index), "--threads", "1", "--color", "never"])


def run(model: Model, **options: Any) -> Study:
    """Runs a study; arguments are those of :class:`Study`.

    Raises:
        MbintError: the model has errors, or a run failed.
    """
    return Study(model, **options).run()


def _value(name: str, value: Value) -> str:
    """A parameter's value for the command; shortest digits that are read as the same number."""
    if isinstance(value, str):
        return value
    try:
        if isinstance(value, (Sequence, np.ndarray)):
            lower, upper = map(float, value)
            return f"[{lower!r}, {upper!r}]"
        return repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"`{name}` is set to a number, an interval of two, or a text, not to {value!r}") from None


def _names(names: Sequence[str] | None) -> Sequence[str]:
    """Names; one may stand alone."""
    return [names] if isinstance(names, str) else names or ()


def _spelled(value: object) -> object:
    """The content with its keys as they are spelled in the file.

    YAML 1.1, which PyYAML reads, takes ``on`` for the truth value ``True``: of the two words that may have stood there, only ``on`` is a key
    of models.

    Raises:
        TypeError: a key is a truth value that no key of models is.
    """
    if isinstance(value, Mapping):
        if any(key is False for key in value):
            raise TypeError("a name is False: YAML 1.1 reads `no` and `off` so; quote it in the file")
        return {"on" if key is True else key: _spelled(own) for key, own in value.items()}
    if isinstance(value, (list, tuple)):
        return [_spelled(own) for own in value]
    return value


def _plain(value: object) -> object:
    """JSON values for numbers of numpy."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"a model cannot have a {type(value).__name__}")
