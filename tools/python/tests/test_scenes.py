"""Scenes as objects: reading, changing, writing."""

from __future__ import annotations

import difflib
from pathlib import Path

import numpy as np
import pytest
import sunfleck as sf
from conftest import REPOSITORY, STAND

EXAMPLES = sorted((REPOSITORY / "scenes").glob("**/*.ron"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: str(path.relative_to(REPOSITORY)))
def test_examples_keep_their_text(path: Path) -> None:
    try:
        scene = sf.read(path)
    except sf.SceneError:
        assert "Library(" in path.read_text()
        pytest.skip("a library of definitions")
    assert scene.to_ron() == path.read_text()
    assert sf.parse("Scene" + scene._text(), path) == scene


def test_a_change_changes_one_line(stand: sf.Scene) -> None:
    assert stand.sun is not None
    stand.sun.zenith_deg = 40
    changed = [line for line in difflib.ndiff(STAND.splitlines(), stand.to_ron().splitlines()) if line[0] in "+-"]
    assert changed == [
        "-     sun: (zenith_deg: 30.0, azimuth_deg: 135.0, irradiance: Constant(1.5)),",
        "+     sun: (zenith_deg: 40, azimuth_deg: 135.0, irradiance: Constant(1.5)),",
    ]


def test_defaults_become_values_when_they_change(stand: sf.Scene) -> None:
    assert stand.transport.seed == 1
    assert "transport" not in stand.to_ron()
    stand.transport.seed = 7
    assert "transport: (seed: 7)" in stand.to_ron()


def test_scenes_are_built_from_nothing() -> None:
    scene = sf.Scene(
        bands=[sf.Band(name="red", center_nm=660.0)],
        materials={"soil": sf.Lambertian(reflectance=sf.Spectrum.Constant(0.2))},
        terrain=sf.Terrain.Plane(size_m=np.array([10.0, 20.0]), material="soil"),
        sun=sf.Sun(zenith_deg=30.0),
        sensors={"view": sf.Directions(views=sf.Views.List(np.array([[0.0, 0.0], [30.0, 90.0]])))},
    )
    assert scene.to_ron() == (
        "Scene(\n    format: 1,\n"
        '    bands: [(name: "red", center_nm: 660.0)],\n'
        '    materials: { "soil": Lambertian(reflectance: Constant(0.2)) },\n'
        '    terrain: Plane(size_m: (10.0, 20.0), material: "soil"),\n'
        "    sun: (zenith_deg: 30.0),\n"
        '    sensors: { "view": Directions(views: List([(0.0, 0.0), (30.0, 90.0)])) },\n)\n'
    )
    assert sf.parse(scene.to_ron()) == scene


def wrong_key(scene: sf.Scene) -> None:
    scene.sun.zenit_deg = 4


def wrong_value(scene: sf.Scene) -> None:
    scene.sun.zenith_deg = 95


def wrong_type(scene: sf.Scene) -> None:
    scene.sensors["map"].samples_per_px = "many"


def wrong_sensor(scene: sf.Scene) -> None:
    _ = scene.sensors["mop"]


def wrong_name(scene: sf.Scene) -> None:
    _ = scene.terrian


def wrong_material(scene: sf.Scene) -> None:
    scene.terrain.material = "sol"


def wrong_argument(scene: sf.Scene) -> None:
    sf.Sun(zenith=3)  # type: ignore[call-arg]


def not_a_number(scene: sf.Scene) -> None:
    scene.sun.zenith_deg = float("nan")


def no_scene_value(scene: sf.Scene) -> None:
    scene.title = object()


def too_few(scene: sf.Scene) -> None:
    scene.terrain.size_m = (1.0,)


MESSAGES = {
    wrong_key: "`Sun` has no key `zenit_deg`: did you mean `zenith_deg`?",
    wrong_value: "sun.zenith_deg: expected an angle from the vertical, 0 up to below 90°, found 95 "
    "(0 is overhead, 90 would be the horizon)",
    wrong_type: "sensors.map.samples_per_px: expected a whole number, found a string (write, for example, `1`)",
    wrong_sensor: "there is no `mop`: did you mean `map`?",
    wrong_name: "`Scene` has no key `terrian`: did you mean `terrain`?",
    wrong_material: "terrain.material: no material `sol` (did you mean `soil`? this scene defines: leaf, soil)",
    wrong_argument: "`Sun` has no key `zenith`: did you mean `zenith_deg`?",
    not_a_number: "nan is no number that a scene can hold",
    no_scene_value: "a scene holds no object",
    too_few: "terrain.size_m: expected 2 values, found 1 (write, for example, `(1.0, 1.0)`)",
}


@pytest.mark.parametrize("script", MESSAGES, ids=lambda script: script.__name__)
def test_what_is_wrong_raises_at_once_and_changes_nothing(script: object, stand: sf.Scene) -> None:
    assert callable(script)
    with pytest.raises((sf.SceneError, AttributeError, KeyError)) as found:
        script(stand)
    assert found.value.args[0] == MESSAGES[script]
    assert stand.to_ron() == STAND
