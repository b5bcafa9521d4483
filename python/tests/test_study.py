"""The package against the command, and against closed forms. The variable MBINT names the command."""

import json
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import mbint

#: A falling ball: y = -g t^2 / 2.
FALL = {
    "model": "fall",
    "parameters": {"g": {"value": 9.81, "unit": "m/s^2", "tolerance": "1%"}},
    "bodies": {"ball": {"mass": np.float64(1.0), "coordinates": ["y"]}},
    "effects": {"weight": {"gravity": {"acceleration": [0, "-g"]}}},
    "initial": {"ball.y": 0, "ball.vy": 0},
    "outputs": {"y": "ball.y", "speed": "ball.vy"},
    "simulation": {"duration": "0.5 s", "step": 1e-3, "output_step": 0.05},
    "bounds": {"chebyshev": {"order": 3}, "scan": {"points": 5}},
}


def test_bounds_are_those_of_free_fall() -> None:
    study = mbint.run(FALL)
    assert study.units == {"y": "m", "speed": "m/s"}
    bounds = study.bounds.chebyshev.sel(output="y")
    time = bounds.time.to_numpy()
    error = bounds.sel(bound="error").to_numpy() + 1e-12
    for bound, g in (("lower", 9.81 * 1.01), ("upper", 9.81 * 0.99)):
        assert np.all(np.abs(bounds.sel(bound=bound).to_numpy() + g * time**2 / 2) <= error)
    np.testing.assert_allclose(study.nominal.sel(output="speed"), -9.81 * time, atol=1e-12)
    assert study.nominal.time.attrs["units"] == "s"
    assert not study.unreliable.to_array().any()
    assert list(study.frame.columns[:2]) == ["y.nominal", "y.chebyshev.lower"]
    assert study.frame.attrs["units"]["y.chebyshev.error"] == "m"


def test_parameters_are_set() -> None:
    study = mbint.run(FALL, set={"g": "9 m/s^2 ± 2%"}, methods=["chebyshev"])
    assert list(study.bounds) == ["chebyshev"]
    (parameter,) = study.summary["parameters"]
    assert (parameter["lower"], parameter["upper"]) == pytest.approx((8.82, 9.18))
    assert mbint.run(FALL, set={"g": 9.0}).nominal[-1, 0] == pytest.approx(-9.0 / 8)


def test_scenes_are_results_of_their_own() -> None:
    study = mbint.run(FALL | {"scenes": {"earth": {}, "moon": {"parameters": {"g": "1.62 m/s^2"}}}})
    assert list(study) == ["earth", "moon"] and len(study) == 2
    assert study["moon"].nominal[-1, 0] == pytest.approx(-1.62 / 8)
    with pytest.raises(ValueError, match="earth, moon"):
        _ = study.result


def test_errors_are_those_of_the_command() -> None:
    with pytest.raises(mbint.MbintError, match="no key `mas`|has no `mas`") as caught:
        mbint.run(FALL | {"bodies": {"ball": {"mas": 1, "coordinates": ["y"]}}})
    assert caught.value.status == 2 and caught.value.code == "E0201"


def test_values_are_numbers_intervals_or_texts() -> None:
    bounds = [mbint.run(FALL, set={"g": g}, methods="chebyshev").summary["parameters"][0] for g in ((9, 10), "[9, 10]")]
    assert bounds[0] == bounds[1] and (bounds[0]["lower"], bounds[0]["upper"]) == (9, 10)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: mbint.run(5), TypeError, "the path of a file or a dictionary, not a int"),
        (lambda: mbint.run(FALL | {"x": {1}}), TypeError, "a model cannot have a set"),
        (lambda: mbint.run(FALL, set="g=9"), TypeError, "set by a dictionary"),
        (lambda: mbint.run(FALL, set={"g": (1, 2, 3)}), TypeError, "`g` is set to a number, an interval of two"),
        (lambda: mbint.run(FALL, set={"g": None}), TypeError, "`g` is set to a number, an interval of two"),
        (lambda: mbint.run(FALL, set={"h": 1}), mbint.MbintError, "unknown parameter `h`"),
        (lambda: mbint.run(FALL, set={"g": "9 kg"}), mbint.MbintError, "where an acceleration"),
        (lambda: mbint.run("nowhere.yaml"), mbint.MbintError, "there is no such file"),
        (lambda: mbint.Study(FALL).bounds, FileNotFoundError, "call run\\(\\) first"),
        (lambda: mbint.sample(FALL), mbint.MbintError, "give points"),
    ],
)
def test_errors_say_what_is_wrong(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call()


def test_a_missing_command_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MBINT", "/nowhere/mbint")
    with pytest.raises(FileNotFoundError, match="MBINT names /nowhere/mbint"):
        mbint.run(FALL)


def test_an_executor_gives_the_same_bytes(tmp_path: Path) -> None:
    direct = mbint.Study(FALL, folder=tmp_path / "direct").run()
    with ThreadPoolExecutor(2) as pool:
        merged = mbint.Study(FALL, folder=tmp_path / "merged").run(pool, at_once=0)
    for name in direct.summary["files"]:
        assert (direct.folder / name).read_bytes() == (merged.folder / name).read_bytes(), name


def test_plots_have_a_panel_for_each_output() -> None:
    pytest.importorskip("matplotlib").use("agg")
    figure = mbint.run(FALL).plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["y in m", "speed in m/s"]


def test_a_summary_is_json() -> None:
    study = mbint.run(FALL)
    assert json.loads((study.folder / "summary.json").read_text())["model"] == "fall"


def test_samples_are_those_of_free_fall() -> None:
    samples = mbint.sample(FALL, {"g": [9.7, 10.0]})
    assert samples["values"].dims == ("sample", "time", "output")
    np.testing.assert_allclose(
        samples["values"].sel(output="y"), -0.5 * np.outer([9.7, 10.0], samples.time.to_numpy() ** 2), atol=1e-12
    )
    assert samples.units.sel(output="speed") == "m/s"
    with ThreadPoolExecutor(2) as pool:
        cut = mbint.sample(FALL, design="sobol:64", executor=pool)
    whole = mbint.sample(FALL, design="sobol:64")
    assert cut.identical(whole)
    assert float(whole.parameters.min()) == pytest.approx(9.81 * 0.99)


def test_gradients_are_those_of_free_fall() -> None:
    found = mbint.gradient(FALL)
    assert found["derivatives"].dims == ("time", "output", "parameter")
    by_g = found["derivatives"].sel(output="y", parameter="g")
    np.testing.assert_allclose(by_g, -0.5 * found.time.to_numpy() ** 2, atol=1e-9)
    assert found.units.sel(output="y") == "m" and found.parameter_units.sel(parameter="g") == "m/s^2"
    assert float(found.half_width.sel(parameter="g")) == pytest.approx(0.0981)
    assert found.reduced.size == 0
    # y = -0.4 at t = sqrt(0.8 / g), and the speed is never more than g / 2.
    lands = FALL["outputs"] | {"lands": {"when": "ball.y <= -0.4"}}
    found = mbint.gradient(FALL | {"outputs": lands, "requirements": {"slow": "abs(ball.vy) <= 6 m/s"}})
    by_g = found["reduced_derivatives"].sel(parameter="g")
    assert float(by_g.sel(reduced="lands")) == pytest.approx(-0.5 * np.sqrt(0.8) * 9.81**-1.5, rel=1e-6)
    assert float(by_g.sel(reduced="slow")) == pytest.approx(-0.5)
    assert float(found["reduced_values"].sel(reduced="slow")) == pytest.approx(6 - 9.81 / 2)


def test_declared_units_are_shown_and_numbers_stay_in_si() -> None:
    inches = mbint.run(FALL | {"outputs": {"y": {"formula": "ball.y", "unit": "in"}, "speed": "ball.vy"}})
    assert inches.result.shown == {"y": ("in", pytest.approx(0.0254)), "speed": ("m/s", 1.0)}
    assert inches.units["y"] == "m" and inches.nominal[-1, 0] == pytest.approx(-9.81 / 8)
    panel = inches.plot("y").axes[0]
    assert panel.get_ylabel() == "y in in"
    assert panel.lines[0].get_ydata()[-1] == pytest.approx(-9.81 / 8 / 0.0254)


def test_yaml_of_version_1_1_is_understood() -> None:
    # PyYAML reads the key `on` as True.
    model = FALL | {"effects": {"weight": {"force": {True: "ball", "value": [0, "-g*(1 kg)"]}}}}
    assert mbint.run(model).nominal[-1, 0] == pytest.approx(-9.81 / 8)
    with pytest.raises(TypeError, match="quote it"):
        mbint.run(FALL | {"bodies": {False: {"mass": 1}}})
