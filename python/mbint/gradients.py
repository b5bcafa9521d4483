"""Gradients: derivatives of outputs over time by all uncertain parameters."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from ._command import invoke
from .study import Study

if TYPE_CHECKING:
    from .study import Model, Value


def gradient(
    model: Model,
    *,
    set: Mapping[str, Value] | None = None,  # the name of the command's option
    scene: str | None = None,
    threads: int | None = None,
) -> xr.Dataset:
    """Differentiates a model's outputs by its uncertain parameters, at their nominal values.

    Args:
        model: path of a model file, or its content as a dictionary.
        set: parameters that differ from the file's.
        scene: scene of the model to differentiate.
        threads: number of threads; results do not depend on it.

    Returns:
        ``derivatives`` over (time, output, parameter), ``values`` over (time, output), ``reduced_derivatives`` over (reduced,
        parameter) and ``reduced_values`` of reduced outputs and of requirements' margins, and ``nominal`` and ``half_width`` of
        each parameter's interval, all in SI; units are coordinates.

    Raises:
        MbintError: the model has errors, or its motion has no derivatives.
    """
    study = Study(model, set=set, scenes=[scene] if scene is not None else None)
    with tempfile.TemporaryDirectory(prefix="mbint-") as temporary:
        arguments = ["gradient", str(study.model), "--output", temporary, "--format", "json", "--quiet", *study.options]
        arguments += ["--threads", str(threads)] if threads is not None else []
        found = json.loads(invoke([*arguments, "--color", "never"]).stdout)
    parameters, outputs, reduced = found["parameters"], found["outputs"], found["reduced"]
    coords = {
        "time": ("time", found["times"], {"units": "s"}),
        "output": [own["name"] for own in outputs],
        "units": ("output", [own["unit"] for own in outputs]),
        "parameter": [own["name"] for own in parameters],
        "parameter_units": ("parameter", [own["unit"] for own in parameters]),
        "reduced": [own["name"] for own in reduced],
        "reduced_units": ("reduced", [own["unit"] for own in reduced]),
    }
    return xr.Dataset(
        {
            "derivatives": (("output", "time", "parameter"), [own["by_parameters"] for own in outputs]),
            "values": (("output", "time"), [own["values"] for own in outputs]),
            "reduced_derivatives": (
                ("reduced", "parameter"),
                np.array([own["by_parameters"] for own in reduced], float).reshape(len(reduced), len(parameters)),
            ),
            "reduced_values": ("reduced", [own["value"] for own in reduced]),
            "nominal": ("parameter", [own["value"] for own in parameters]),
            "half_width": ("parameter", [own["half_width"] for own in parameters]),
        },
        coords=coords,
    ).transpose("time", "output", "reduced", "parameter")
