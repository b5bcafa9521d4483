"""Verification of a model's equations and of the schemes on them, by motions that are known exactly."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pandas as pd

from ._command import NOT_MET, invoke
from .study import Study

if TYPE_CHECKING:
    from .study import Model, Value


@dataclass(frozen=True)
class Verification:
    """Orders at which a model's motions converge to an exact one, and the balance of its powers.

    Attributes:
        verified: whether all orders are those of theory and all powers are balanced.
        orders: a row for each ``formulation``, ``scheme`` and ``quantity``: the observed ``order`` (NaN where steps of any length are exact),
            that of ``theory``, the last ``step`` in s, its ``error`` as a share of the quantity's size, and ``verified``.
        powers: a row for each ``formulation`` and ``effect``: its ``kind``, and the largest ``power``, ``put_in`` and ``taken`` in W.
        failures: why a formulation, or a scheme in it, has no orders.
        result: all errors, as ``--format json`` has them.
    """

    verified: bool
    orders: pd.DataFrame
    powers: pd.DataFrame
    failures: dict[str, str]
    result: dict[str, Any]


def verify(
    model: Model,
    *,
    set: Mapping[str, Value] | None = None,  # the name of the command's option
    scene: str | None = None,
) -> Verification:
    """Verifies a model's equations, and the schemes on them, by manufactured solutions.

    Args:
        model: path of a model file, or its content as a dictionary.
        set: parameters that differ from the file's.
        scene: scene of the model.

    Raises:
        MbintError: the model has errors, or no motion.
    """
    study = Study(model, set=set, scenes=[scene] if scene is not None else None)
    arguments = ["verify", str(study.model), "--format", "json", "--quiet", "--color", "never", *study.options]
    ran = invoke(arguments, accepted=frozenset({0, NOT_MET}))
    found = json.loads(ran.stdout)
    orders, powers = [], []
    failures: dict[str, str] = {}
    for own in found["formulations"]:
        formulation = own["formulation"]
        if own["failure"] is not None:
            failures[formulation] = own["failure"]
        if own["balance"] is not None:
            powers += [{"formulation": formulation} | effect for effect in own["balance"]["effects"]]
        for scheme in own["schemes"]:
            if scheme["failure"] is not None:
                failures[f"{formulation}, {scheme['scheme']}"] = scheme["failure"]
            orders += [
                {
                    "formulation": formulation,
                    "scheme": scheme["scheme"],
                    "quantity": of["quantity"],
                    "order": of["order"],
                    "theory": of["theory"],
                    "step": of["errors"][-1][0],
                    "error": of["errors"][-1][1],
                    "verified": of["is_verified"],
                }
                for of in scheme["convergence"]
            ]
    table = pd.DataFrame(
        orders, columns=["formulation", "scheme", "quantity", "order", "theory", "step", "error", "verified"]
    )
    table["order"] = table["order"].astype(float)
    return Verification(ran.returncode == 0, table, pd.DataFrame(powers), failures, found)
