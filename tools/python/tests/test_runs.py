"""Runs: what they return is what the command writes."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sunfleck as sf
import xarray as xr
from conftest import REPOSITORY, STAND

COMMAND = Path(os.environ.get("SUNFLECK", REPOSITORY / "target/release/sunfleck"))


@pytest.mark.skipif(not COMMAND.exists(), reason="the command is not built")
def test_results_are_those_of_the_command_bit_for_bit(tmp_path: Path, stand: sf.Scene) -> None:
    file = tmp_path / "stand.ron"
    file.write_text(STAND)
    out = tmp_path / "out"
    subprocess.run([COMMAND, "run", file, "--format", "NetCdf", "--out", out, "--quiet"], check=True)
    results = sf.run(sf.read(file), threads=1)
    assert list(results) == ["map", "plane", "balance"]
    for name, dataset in results.items():
        written = xr.open_dataset(out / f"{name}.nc", decode_coords="all")
        assert set(dataset.variables) == set(written.variables)
        for variable in dataset.variables:
            one, other = dataset[variable], written[variable]
            assert one.dims == other.dims, variable
            if one.dtype.kind == "f":
                assert np.array_equal(one.values, other.values, equal_nan=True), (name, variable)
        for key in ("hash", "seed", "version", "Conventions"):
            assert str(dataset.attrs[key]) == str(written.attrs[key])


def test_units_names_and_errors_are_those_of_cf(stand: sf.Scene) -> None:
    results = sf.run(stand, sensors=["plane"], quality=0.1)
    brf = results.brf
    assert brf.attrs["units"] == "1"
    assert brf.attrs["standard_name"] == "surface_bidirectional_reflectance"
    assert brf.attrs["ancillary_variables"] == "brf_standard_error"
    assert brf.dims == ("view", "band")
    assert list(brf.band.values) == ["red", "nir"]
    assert (results.brf_standard_error.values > 0).all()


def test_an_error_that_is_asked_for_is_reached(stand: sf.Scene) -> None:
    error = 0.004
    results = sf.run(stand, sensors=["plane"], until={"brf": error})
    relative = results.brf_standard_error / results.brf
    assert float(relative.median()) <= error


def test_progress_is_told_and_its_errors_end_the_run(stand: sf.Scene) -> None:
    seen: list[tuple[str, float | None, float | None]] = []
    sf.run(stand, quality=0.1, progress=lambda *state: seen.append(state))
    names = {name for name, _, _ in seen}
    assert {"map", "plane", "balance", "loading"} <= names
    assert all(done is None or 0.0 <= done <= 1.0 for _, done, _ in seen)

    def fails(*_: object) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        sf.run(stand, progress=fails)


def test_a_signal_ends_a_run_within_a_second() -> None:
    script = (
        "import _thread, threading, time, sunfleck as sf\n"
        f"scene = sf.parse({STAND!r})\n"
        "scene.sensors['plane'].until = sf.StopCriterion.Samples(100_000_000)\n"
        "def stop():\n"
        "    time.sleep(1.0); global at; at = time.time(); _thread.interrupt_main()\n"
        "threading.Thread(target=stop).start()\n"
        "try:\n    sf.run(scene)\n    print('ended')\n"
        "except KeyboardInterrupt:\n    print('stopped', time.time() - at)\n"
    )
    import sys

    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    word, seconds = done.stdout.split()
    assert word == "stopped" and float(seconds) < 1.0, (done.stdout, done.stderr)


def test_missing_files_are_told(tmp_path: Path) -> None:
    with pytest.raises(sf.SceneError, match="there is no file"):
        sf.read(tmp_path / "stnd.ron")
    scene = sf.parse(STAND, tmp_path / "stand.ron")
    scene.meshes["crown"] = sf.Prototype.Obj(file="none.obj", up=sf.Axis.Z(), unit_m=1.0, parts={"leaf": "leaf"})
    with pytest.raises(sf.SceneError, match=r"none\.obj"):
        sf.run(scene)
