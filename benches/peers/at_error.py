"""Time a sample of mbint, and times read off at an error."""

import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

# Errors at which programs are compared.
WANTED = (1e-3, 1e-6, 1e-9)
# Samples of a batch: two tiles of 32 and one more, of which the first is taken away.
BATCH = 65


def time_of_sample(program, model, parameter, value, files=(), batch=BATCH):
    """Seconds of one sample more in a batch on one thread, and all samples; None where the program refuses the model.

    Every sample has the same value of the one parameter. Starting the program and compiling the model are taken away by those of one sample.
    """
    times = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, text in dict(files).items():
            (folder / name).write_text(text)
        (folder / "model.yaml").write_text(model)
        for count in (1, batch):
            (folder / "points.csv").write_text(f"{parameter}\n" + f"{value}\n" * count)
            best = math.inf
            for _ in range(3):
                begun = time.perf_counter()
                done = subprocess.run([program, "sample", "model.yaml", "--points", "points.csv", "-o", "out.npz", "-j", "1", "-q"],
                                      cwd=folder, capture_output=True, text=True)
                best = min(best, time.perf_counter() - begun)
                if done.returncode != 0:
                    print(f"mbint: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
                    return None
            times[count] = best
        return (times[batch] - times[1]) / (batch - 1), dict(np.load(folder / "out.npz"))


def at_error(points, wanted):
    """Least time at an error, between measured points on logarithmic scales; marked where it is beyond them."""
    points = sorted((error, seconds) for error, seconds in points if error > 0 and seconds > 0)
    if not points:
        return None
    for (e0, t0), (e1, t1) in zip(points, points[1:]):
        if e0 <= wanted <= e1:
            share = (math.log(wanted) - math.log(e0)) / max(math.log(e1) - math.log(e0), 1e-300)
            return math.exp(math.log(t0) + share * (math.log(t1) - math.log(t0))), False
    if wanted > points[-1][0]:
        return points[-1][1], False
    # By the slope of the two most exact runs.
    if len(points) < 2:
        return None
    (e0, t0), (e1, t1) = points[:2]
    order = (math.log(t0) - math.log(t1)) / (math.log(e0) - math.log(e1)) if e0 != e1 else 0
    if order >= 0:
        return None
    return t0 * (wanted / e0) ** order, True
