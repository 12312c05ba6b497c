"""Runs of scenes, and their results as data sets."""

from __future__ import annotations

import os
import warnings as python_warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _native
from ._language import StopCriterion
from ._scene import Scene, read

if TYPE_CHECKING:
    import xarray as xr

Progress = Callable[[str, float | None, float | None], None]


class Results(Mapping[str, "xr.Dataset"]):
    """Data sets of the sensors of a run, by their names.

    `results["nadir"].brf` is a data array; the only sensor of a scene needs no name: `results.brf`.
    """

    def __init__(self, sensors: dict[str, xr.Dataset], warnings: list[str]) -> None:
        self._sensors = sensors
        self.warnings = warnings
        """Warnings of the run, a text each."""

    def __getitem__(self, name: str) -> xr.Dataset:
        if name not in self._sensors:
            raise KeyError(f"there is no sensor `{name}`; there are {', '.join(f'`{one}`' for one in self._sensors)}")
        return self._sensors[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._sensors)

    def __len__(self) -> int:
        return len(self._sensors)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if len(self._sensors) == 1:
            return getattr(next(iter(self._sensors.values())), name)
        first = next(iter(self._sensors), "")
        raise AttributeError(f"results of several sensors have no `{name}`: name one, such as results[{first!r}]")

    def __repr__(self) -> str:
        return "\n\n".join(f"{name}: {dataset!r}" for name, dataset in self._sensors.items())


def check(scene: Scene | str | os.PathLike[str]) -> list[str]:
    """Errors and warnings of a scene's text, each with its place."""
    scene = scene if isinstance(scene, Scene) else read(scene)
    return [one["text"] for one in _native.check(scene.to_ron(), str(scene.path))]


def run(
    scene: Scene | str | os.PathLike[str],
    *,
    until: Mapping[str, float] | None = None,
    sensors: Sequence[str] = (),
    variant: str | None = None,
    params: Mapping[str, float | str] | None = None,
    threads: int | None = None,
    quality: float = 1.0,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: bool | Progress = False,
) -> Results:
    """Runs a scene; returns a data set for each sensor.

    until: largest median relative standard error of products, such as `{"brf": 0.005}`, in place of what sensors say.
    sensors: names of those that measure; all by default.
    variant, params: as `--variant` and `--set` of the command.
    threads: number of threads; all processors by default. No result depends on it.
    quality: factor on all numbers of samples.
    checkpoint: file to which an interrupted run saves what it has done, and from which the next one goes on.
    progress: True for bars of tqdm, or a function of (stage or sensor, fraction done, relative error so far).
    """
    scene = scene if isinstance(scene, Scene) else read(scene)
    text = scene.to_ron()
    if until is not None:
        text = _with_criterion(scene, until, sensors)
    settings = {
        "set": list((params or {}).items()),
        "variant": variant,
        "threads": threads,
        "quality": float(quality),
        "sensors": list(sensors),
        "checkpoint": None if checkpoint is None else os.fspath(checkpoint),
    }
    shown = _Bars() if progress is True else progress or None
    try:
        result = _native.run(text, os.fspath(scene.path), settings, shown)
    finally:
        if isinstance(shown, _Bars):
            shown.close()
    for warning in result["warnings"]:
        python_warnings.warn(warning, stacklevel=2)
    return Results({one["name"]: _dataset(one) for one in result["sensors"]}, result["warnings"])


def _with_criterion(scene: Scene, until: Mapping[str, float], sensors: Sequence[str]) -> str:
    changed = scene.copy()
    criterion = {str(name): float(error) for name, error in until.items()}
    for name, sensor in changed.sensors.items():
        if (not sensors or name in sensors) and "until" in sensor._keys:
            sensor.until = StopCriterion.RelErrors(criterion)
    return changed.to_ron()


class _Bars:
    """Bars of tqdm, one for each sensor."""

    def __init__(self) -> None:
        from tqdm.auto import tqdm  # type: ignore[import-untyped]

        self._tqdm = tqdm
        self._bars: dict[str, Any] = {}

    def __call__(self, name: str, done: float | None, error: float | None) -> None:
        if done is None:
            return
        if name not in self._bars:
            form = "{desc}: {percentage:3.0f}% |{bar}| {remaining} {postfix}"
            self._bars[name] = self._tqdm(total=1.0, desc=name, bar_format=form)
        bar = self._bars[name]
        bar.update(done - bar.n)
        if error is not None:
            bar.set_postfix_str(f"error {error:.2%}")

    def close(self) -> None:
        for bar in self._bars.values():
            bar.close()


def _dataset(sensor: dict[str, Any]) -> xr.Dataset:
    import xarray as xr

    variables = {name: (dims, values, attributes) for name, dims, attributes, values in sensor["arrays"]}
    dataset = xr.Dataset(variables, attrs=sensor["attributes"])
    named = {name for variable in variables.values() for name in str(variable[2].get("coordinates", "")).split()}
    for variable in dataset.variables.values():
        variable.attrs.pop("coordinates", None)
    named |= {name for name, (_, _, attributes) in variables.items() if "grid_mapping_name" in attributes}
    return dataset.set_coords([name for name in variables if name in named])
