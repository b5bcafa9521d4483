"""A study on a cluster of two processes, one of which is killed."""

import os
import signal
from pathlib import Path

import pytest

import mbint

MODEL = {
    "model": "pendulum",
    "parameters": {
        "length": {"value": 1, "unit": "m", "tolerance": "1%"},
        "mass": {"value": 1, "unit": "kg", "tolerance": "2%"},
    },
    "bodies": {"bob": {"mass": "mass", "coordinates": ["x", "y"]}},
    "joints": {"rod": {"distance": {"between": ["ground", "bob"], "length": "length"}}},
    "effects": {"weight": {"gravity": {"acceleration": [0, -9.81]}}},
    "initial": {"bob.y": 0, "bob.vy": 0},
    "guess": {"bob.x": -1},
    "outputs": {"x": "bob.x"},
    "simulation": {"duration": "2 s", "step": 1e-3, "output_step": 0.02},
    "bounds": {"chebyshev": {"order": 5}, "scan": {"points": 60}},
}


def test_a_worker_may_be_killed(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    direct = mbint.Study(MODEL, folder=tmp_path / "direct").run()
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        executor = client.get_executor(pure=False)
        victim = next(iter(client.run(os.getpid).values()))
        merged = mbint.Study(MODEL, folder=tmp_path / "merged")
        killing = executor.submit(os.kill, victim, signal.SIGKILL)
        merged.run(executor, at_once=0)
        del killing
    for name in direct.summary["files"]:
        assert (direct.folder / name).read_bytes() == (merged.folder / name).read_bytes(), name
