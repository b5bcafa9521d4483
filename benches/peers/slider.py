#!/usr/bin/env python3
"""Time a sample of the slider crank over 2 s against the largest error of x3: mbint's schemes and Exudyn, as a table at equal error.

    benches/peers/slider.py MBINT MODEL JSON

JSON has x3 every 0.25 s (`exact`) and Exudyn's runs (`exudyn`: seconds and x3 at those times but the first).
"""

import json
import sys
from pathlib import Path

from at_error import WANTED, at_error, time_of_sample

EVERY = 0.25


def largest(values, exact):
    return max(abs(a - b) for a, b in zip(values, exact))


def ours(program, model, exact):
    """Name, seconds and error of each setting."""
    text = Path(model).read_text()
    plain = "simulation: { duration: 2, step: 1e-3, alpha: -0.1, output_step: 0.01 }"
    assert plain in text
    settings = [("HHT-I3", f"step: {step}, alpha: -0.1, scheme: hht") for step in (1e-3, 5e-4, 2.5e-4)]
    settings += [(f"HHT-I3, {levels} levels", f"step: {step}, alpha: -0.1, scheme: hht, extrapolation: {levels}")
                 for levels in (3, 4) for step in (2e-3, 1e-3, 5e-4)]
    settings += [("explicit", f"tolerance: 1e-{digits}, scheme: explicit") for digits in range(3, 12)]
    for name, setting in settings:
        model = text.replace(plain, f"simulation: {{ duration: 2, output_step: {EVERY}, {setting} }}")
        timed = time_of_sample(program, model, "l1", 0.15, batch=1025)
        if timed:
            seconds, samples = timed
            yield name, seconds, largest(samples["values"][0, :, 0], exact)


def main():
    program, model, given = Path(sys.argv[1]).resolve(), sys.argv[2], json.loads(sys.argv[3])
    lines = {"Exudyn": [(largest(run["values"], given["exact"][1:]), run["seconds"]) for run in given["exudyn"]]}
    for name, seconds, error in ours(program, model, given["exact"]):
        lines.setdefault(f"mbint {name}", []).append((error, seconds))
        print(f"slider crank: mbint {name}: {error:.2e} m, {1e3 * seconds:.4g} ms", file=sys.stderr)
    print("| slider crank, 2 s |" + "".join(f" {wanted:.0e} m | Exudyn : mbint |" for wanted in WANTED) + "\n| --- |" + " --: | --: |" * len(WANTED))
    peer = [at_error(lines["Exudyn"], wanted) for wanted in WANTED]
    for name, points in lines.items():
        cells = []
        for wanted, (other, _) in zip(WANTED, peer):
            found = at_error(points, wanted)
            cells.append("– | –" if found is None else
                         f"{1e3 * found[0]:.3g} ms{' (extrapolated)' if found[1] else ''} | {other / found[0]:.0f}")
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
