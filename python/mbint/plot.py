"""Bounds over time, drawn by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from .result import Result


def figure(result: Result, outputs: list[str], methods: list[str] | None) -> Figure:
    """One panel an output: the nominal course, a band for each method, hatched where it is unreliable."""
    drawn, panels = plt.subplots(
        len(outputs), 1, sharex=True, squeeze=False, figsize=(8, 1 + 2.5 * len(outputs)), layout="constrained"
    )
    time = result.nominal.coords["time"].to_numpy()
    chosen = [str(method) for method in result.bounds] if methods is None else methods
    for panel, output in zip(panels[:, 0], outputs, strict=True):
        unit, si = result.shown[output]
        for number, method in enumerate(chosen):
            band = result.bounds[method].sel(output=output)
            lower, upper, error = (band.sel(bound=bound).to_numpy() / si for bound in ("lower", "upper", "error"))
            color = f"C{number + 1}"
            panel.fill_between(time, lower - error, upper + error, color=color, alpha=0.15, linewidth=0)
            panel.fill_between(time, lower, upper, color=color, alpha=0.25, linewidth=0, label=method)
            flagged = result.unreliable[method].sel(output=output).to_numpy()
            if np.any(flagged):
                panel.fill_between(
                    time, lower, upper, where=flagged, facecolor="none", edgecolor=color, hatch="///", linewidth=0
                )
        panel.plot(time, result.nominal.sel(output=output) / si, color="black", linewidth=1, label="nominal")
        panel.set_ylabel(f"{output} in {unit}" if unit else output)
        panel.legend(loc="best", fontsize="small")
    panels[-1, 0].set_xlabel("time in s")
    panels[0, 0].set_title(str(result.summary["model"]))
    return drawn
