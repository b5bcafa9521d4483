"""Bounds of any Python function: it runs in this Python, and answers the questions of mbint."""

from __future__ import annotations

import json
import os
import secrets
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection, Listener
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .study import Study

if TYPE_CHECKING:
    from collections.abc import Iterator
    from concurrent.futures import Executor

    from .study import Value

#: Points that an executor, or a vectorised function, gets at once.
AT_ONCE = 256

#: Times that differ by less than this share of their distance are the same.
SAME_TIME = 1e-6


def bounds(
    function: Callable[..., Any],
    parameters: Mapping[str, Value],
    *,
    outputs: Sequence[str] | Mapping[str, str] = ("value",),
    times: Any = None,
    vectorised: bool = False,
    executor: Executor | None = None,
    tolerance: float | None = None,
    more: Mapping[str, Any] | None = None,
    **options: Any,
) -> Study:
    """Bounds the values of a function over intervals of its arguments.

    Args:
        function: gets the parameters by name, as numbers. It returns a number or, with ``times``, one for each time; for several outputs a
            dictionary, a table of pandas, a dataset of xarray, or a sequence in their order.
        parameters: each argument's interval ``(0.14, 0.16)``, or a text with unit and tolerance: ``"150 mm ± 1%"``; a single number is
            constant. The function gets values in SI units.
        outputs: names of the returned values; a dictionary gives units, ``{"x": "mm"}``.
        times: times of the rows, s, from 0 on with equal distances; without them the function returns one number an output.
        vectorised: whether the function takes arrays, one value a point, and returns arrays with the points as their first axis.
        executor: runs the function, point by point, such as a ``ProcessPoolExecutor``; without one it runs here.
        tolerance: allowed error of the bounds, relative to the range of an output; without it, Chebyshev of order 5.
        more: further sections of the model: ``requirements``, ``statistics``, reduced outputs under ``outputs``, …
        **options: those of :class:`Study`.

    Returns:
        A study as :func:`run` returns.

    Raises:
        MbintError: the function failed at every point, or the question has errors.
        ValueError: ``times`` do not begin at 0, or have different distances.
    """
    units = (
        dict(outputs)
        if isinstance(outputs, Mapping)
        else dict.fromkeys([outputs] if isinstance(outputs, str) else outputs, "1")
    )
    together = vectorised or executor is not None
    with _served(_Answers(function, list(units), vectorised, executor)) as (address, key):
        model = {
            "model": getattr(function, "__name__", "function").strip("<>") or "function",
            "parameters": {name: _parameter(value) for name, value in parameters.items()},
            "black_box": {
                "command": [sys.executable, str(Path(__file__).with_name("_answering.py")), address],
                "outputs": units,
                "processes": 1,
                "points": AT_ONCE if together else 1,
                "retries": 0,
            },
        }
        if times is not None:
            model["simulation"] = _simulation(np.asarray(times, float))
        if tolerance is not None:
            model["bounds"] = {"tolerance": tolerance}
        model.update(more or {})
        study = Study(model, **options)
        os.environ["MBINT_ANSWERING_KEY"] = key
        try:
            return study.run()
        finally:
            del os.environ["MBINT_ANSWERING_KEY"]


def _parameter(value: Value) -> Any:
    """A parameter as a model has it."""
    if isinstance(value, (str, int, float, np.number)):
        return value
    lower, upper = map(float, value)
    return {"interval": [lower, upper]}


def _simulation(times: np.ndarray[Any, Any]) -> dict[str, float]:
    """Duration and distance of rows."""
    steps = np.diff(times)
    if times.ndim != 1 or len(times) < 2 or times[0] != 0 or np.ptp(steps) > SAME_TIME * steps.mean():
        raise ValueError("times begin at 0 and have equal distances, as np.linspace(0, 2, 101) does")
    return {"duration": float(times[-1]), "output_step": float(times[-1]) / (len(times) - 1)}


class _Answers:
    """Answers of a function to mbint's questions."""

    def __init__(
        self, function: Callable[..., Any], outputs: list[str], vectorised: bool, executor: Executor | None
    ) -> None:
        self.function, self.outputs, self.vectorised, self.executor = function, outputs, vectorised, executor

    def __call__(self, asked: list[dict[str, Any]]) -> list[dict[str, Any]]:
        points = [question["parameters"] for question in asked]
        count = len(asked[0]["times"])
        if self.vectorised:
            found = self._together(points, count)
        elif self.executor is not None:
            found = [self._answer(future.result, count) for future in self._submitted(points)]
        else:
            found = [self._answer(partial(self.function, **point), count) for point in points]
        return [{"point": question["point"]} | answer for question, answer in zip(asked, found, strict=True)]

    def _submitted(self, points: list[dict[str, float]]) -> list[Any]:
        assert self.executor is not None
        return [self.executor.submit(self.function, **point) for point in points]

    def _together(self, points: list[dict[str, float]], count: int) -> list[dict[str, Any]]:
        arrays = {name: np.array([point[name] for point in points]) for name in points[0]}
        try:
            columns = self._columns(self.function(**arrays))
            shaped = {name: np.asarray(values, float).reshape(len(points), count) for name, values in columns.items()}
        except Exception as error:  # noqa: BLE001 - the function is the user's: its exception is its answer
            return [_failed(error)] * len(points)
        return [
            {"outputs": {name: values[place].tolist() for name, values in shaped.items()}}
            for place in range(len(points))
        ]

    def _answer(self, call: Callable[[], Any], count: int) -> dict[str, Any]:
        try:
            columns = self._columns(call())
            return {
                "outputs": {name: np.asarray(values, float).reshape(-1).tolist() for name, values in columns.items()}
            }
        except Exception as error:  # noqa: BLE001 - as above
            return _failed(error)

    def _columns(self, found: Any) -> dict[str, Any]:
        """Values that a function returned, by output."""
        if hasattr(found, "keys"):  # a dictionary, a table or a dataset
            missing = [name for name in self.outputs if name not in found]
            if missing:
                returned = ", ".join(f"`{name}`" for name in found) or "nothing"
                raise ValueError(f"the function returned {returned}, and no `{missing[0]}`")
            return {name: found[name] for name in self.outputs}
        if len(self.outputs) == 1:
            return {self.outputs[0]: found}
        return dict(zip(self.outputs, found, strict=True))


def _failed(error: Exception) -> dict[str, Any]:
    return {"error": f"{type(error).__name__}: {error}"}


@contextmanager
def _served(answers: _Answers) -> Iterator[tuple[str, str]]:
    """Answers questions that come to an address, with a key, as long as the context lasts."""
    key = secrets.token_bytes(32)
    with Listener(None, authkey=key) as listener:
        thread = threading.Thread(target=_serve, args=(listener, answers), daemon=True)
        thread.start()
        yield str(listener.address), key.hex()


def _serve(listener: Listener, answers: _Answers) -> None:
    """Answers one process after the other, until the listener is closed."""
    while True:
        try:
            connection = listener.accept()
        except (OSError, EOFError):
            return
        threading.Thread(target=_converse, args=(connection, answers), daemon=True).start()


def _converse(connection: Connection, answers: _Answers) -> None:
    """Answers one process."""
    asked: list[dict[str, Any]] = []
    with connection:
        while True:
            try:
                asked.append(json.loads(connection.recv_bytes()))
                if asked[-1]["left"] == 0:
                    lines = "".join(json.dumps(answer) + "\n" for answer in answers(asked))
                    connection.send_bytes(lines.encode())
                    asked = []
                connection.send_bytes(b"")
            except (OSError, EOFError):
                return
