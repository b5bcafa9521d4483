"""The results folder of one model or scene, as arrays."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Curves of a band, in the order of the dimension ``bound``.
BOUNDS = ("lower", "upper", "error")


class Result:
    """Bounds over time of one model or scene.

    Args:
        folder: folder into which ``mbint run`` wrote them.
        owner: object that removes the folder at its own end: it lives as long as the result does.
    """

    def __init__(self, folder: str | Path, owner: object = None) -> None:
        self.folder = Path(folder)
        self._owner = owner

    def __repr__(self) -> str:
        return f"Result({self.summary['model']!r}, outputs={list(self.units)}, folder={str(self.folder)!r})"

    @cached_property
    def summary(self) -> dict[str, Any]:
        """``summary.json``: the run and its reliability. SI units."""
        with open(self.folder / "summary.json", encoding="utf-8") as file:
            summary: dict[str, Any] = json.load(file)
        return summary

    @cached_property
    def columns(self) -> list[dict[str, Any]]:
        """``columns.json``: quantity, unit, output and method of each column of ``bounds.csv``."""
        with open(self.folder / "columns.json", encoding="utf-8") as file:
            columns: list[dict[str, Any]] = json.load(file)
        return columns

    @cached_property
    def units(self) -> dict[str, str]:
        """Unit of each output; empty if it has none."""
        return {column["output"]: column["unit"] for column in self.columns if column["quantity"] == "nominal"}

    @cached_property
    def shown(self) -> dict[str, tuple[str, float]]:
        """Unit in which people see each output, and its size in SI: the model's ``unit:``, or SI. Numbers stay in SI."""
        nominal = [column for column in self.columns if column["quantity"] == "nominal"]
        displays = {column["output"]: column.get("display") for column in nominal}
        return {
            output: (display["unit"], display["si"]) if (display := displays[output]) else (unit, 1.0)
            for output, unit in self.units.items()
        }

    @cached_property
    def frame(self) -> pd.DataFrame:
        """``bounds.csv`` with the time as index; ``attrs["units"]`` has the unit of every column."""
        # As text first: numbers then are those that were written, to the last bit.
        frame = pd.read_csv(self.folder / "bounds.csv", dtype=str, keep_default_na=False)
        numbers = [column["column"] for column in self.columns if column["quantity"] != "unresolved"]
        frame = frame.astype(dict.fromkeys(numbers, float)).set_index("t")
        frame.attrs["units"] = {column["column"]: column["unit"] for column in self.columns}
        return frame

    @cached_property
    def verdicts(self) -> pd.DataFrame:
        """Requirements: verdict, margin and its error, SI; empty without requirements."""
        return pd.DataFrame(self.summary.get("requirements", []))

    @cached_property
    def reduced(self) -> pd.DataFrame:
        """``reduced.csv``: reduced outputs with their bounds, SI; empty without reduced outputs."""
        return self._table("reduced.csv")

    @cached_property
    def statistics(self) -> pd.DataFrame:
        """``statistics.csv``: mean, deviation and quantiles of each output over time; empty if the model asks for none."""
        return self._table("statistics.csv")

    def _table(self, name: str) -> pd.DataFrame:
        path = self.folder / name
        return pd.read_csv(path) if path.is_file() else pd.DataFrame()

    @cached_property
    def nominal(self) -> xr.DataArray:
        """Nominal outputs over (time, output)."""
        names = list(self.units)
        values = np.stack([self.frame[f"{name}.nominal"].to_numpy(float) for name in names], axis=1)
        return self._array(values, ("time", "output"), "nominal")

    @cached_property
    def bounds(self) -> xr.Dataset:
        """Bounds: a variable for each method over (time, output, bound), where bound is ``lower``, ``upper`` or ``error``."""
        outputs = {name: number for number, name in enumerate(self.units)}
        values: dict[str, np.ndarray[Any, Any]] = {}
        for column in self.columns:
            if column["quantity"] in BOUNDS:
                band = values.setdefault(
                    column["method"], np.full((len(self.frame), len(outputs), len(BOUNDS)), np.nan)
                )
                curve = self.frame[column["column"]].to_numpy(float)
                band[:, outputs[column["output"]], BOUNDS.index(column["quantity"])] = curve
        arrays = {method: self._array(band, ("time", "output", "bound"), method) for method, band in values.items()}
        bounds = {method: array.assign_coords(bound=list(BOUNDS)) for method, array in arrays.items()}
        return xr.Dataset(bounds, attrs=self._attributes())

    @cached_property
    def unreliable(self) -> xr.Dataset:
        """Whether the stated error of a band is unreliable: a variable for each method over (time, output)."""
        named = [set(cell.split()) for cell in self.frame["unresolved"]] if "unresolved" in self.frame else []
        flags = {}
        for method in self.bounds:
            flagged = np.array([[f"{output}.{method}" in row for output in self.units] for row in named])
            flags[method] = self._array(flagged, ("time", "output"), str(method))
        return xr.Dataset(flags, attrs=self._attributes())

    def _array(self, values: np.ndarray[Any, Any], dims: tuple[str, ...], name: str) -> xr.DataArray:
        coords: dict[str, Any] = {
            "time": ("time", self.frame.index.to_numpy(float), {"units": "s"}),
            "output": list(self.units),
            "units": ("output", list(self.units.values())),
        }
        return xr.DataArray(values, coords=coords, dims=dims, name=name, attrs=self._attributes())

    def _attributes(self) -> dict[str, Any]:
        """Origin of the numbers; the unit if all outputs have the same."""
        attributes = {"model": self.summary["model"], "mbint": self.summary["mbint"]}
        units = set(self.units.values())
        return attributes | ({"units": units.pop()} if len(units) == 1 else {})

    def plot(self, output: str | None = None, methods: list[str] | None = None) -> Figure:
        """Bounds of an output over time; by default of all outputs, one below the other. Needs matplotlib."""
        try:
            from .plot import figure
        except ModuleNotFoundError as missing:
            raise ModuleNotFoundError("plots need matplotlib: pip install 'mbint[plot]'") from missing

        return figure(self, [output] if output else list(self.units), methods)
