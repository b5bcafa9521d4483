"""Bounds of a mechanism's motion under parameter tolerances.

    >>> import mbint
    >>> study = mbint.run("models/slider_crank.yaml", set={"l1": "0.15 m ± 2%"})
    >>> study.bounds.chebyshev.sel(output="x3", bound="upper").max()

The command ``mbint`` does the work; this package writes its input and reads its results.
"""

from . import certificate
from ._command import MbintError, command, version
from .designing import Design, design
from .fitting import Fit, fit
from .functions import bounds
from .gradients import gradient
from .questions import Allocation, allocate, check, cost, snapshot, sweep
from .result import Result
from .samples import sample
from .study import Study, run
from .verifying import Verification, verify

__all__ = [
    "Allocation",
    "Design",
    "Fit",
    "MbintError",
    "Result",
    "Study",
    "Verification",
    "allocate",
    "bounds",
    "certificate",
    "check",
    "command",
    "cost",
    "design",
    "fit",
    "gradient",
    "run",
    "sample",
    "snapshot",
    "sweep",
    "verify",
    "version",
]
