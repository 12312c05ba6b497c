"""Scenes: read from files, built from nothing, changed key by key, and written with their comments."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from ._model import _CLASSES, _TYPES, Node, Record, _read
from ._native import SceneError

if TYPE_CHECKING:
    from ._language import (
        Band,
        BandSet,
        Frame,
        Instances,
        Material,
        Prototype,
        Sensor,
        Sky,
        Spectrum,
        Sun,
        Terrain,
        Transport,
    )

HEAD = "Scene"


class Scene(Record):
    """A scene: what stands where, what lights it, and what measures it.

    Keys are attributes: `scene.sun.zenith_deg = 40`, `scene.sensors["nadir"].samples_per_px = 64`. A wrong name or
    value raises `SceneError` at once, with the message of the command `sunfleck check`.
    """

    __slots__ = ("_known", "_path", "_source")

    _ron = "Scene"

    _source: str | None
    _path: Path
    _known: set[tuple[str, str]]

    bands: list[Band] | BandSet
    spectra: dict[str, Spectrum]
    materials: dict[str, Material]
    meshes: dict[str, Prototype]
    terrain: Terrain
    instances: list[Instances]
    sun: Sun
    sky: Sky
    frame: Frame
    transport: Transport
    sensors: dict[str, Sensor]

    def __init__(self, **keys: Any) -> None:
        object.__setattr__(self, "_source", None)
        object.__setattr__(self, "_path", Path("scene.ron"))
        object.__setattr__(self, "_known", set())
        super().__init__(**{"format": 1, **keys})
        self._known.update(self._problems())
        wrong = list(self._problems().values())
        if wrong:
            raise SceneError("\n".join(wrong))

    @property
    def path(self) -> Path:
        """File of the scene; paths in it are relative to its folder."""
        return self._path

    def to_ron(self) -> str:
        """Text of the scene; comments and order of its file are kept."""
        new = HEAD + self._text()
        if self._source is None:
            return _native.formatted(new, str(self._path))
        return _native.edited(self._source, new, str(self._path))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the text of the scene to a file."""
        Path(path).write_text(self.to_ron(), encoding="utf-8")

    def copy(self) -> Scene:
        """A scene with the same values, whose changes leave this one as it is."""
        return _scene_of(self.to_ron(), self._path)

    def _problems(self) -> dict[tuple[str, str], str]:
        found = _native.check(HEAD + self._text(), str(self._path))
        return {(one["path"], one["message"]): _message(one) for one in found if one["severity"] == "error"}

    def _changed(self, undo: Callable[[], None]) -> None:
        try:
            problems = self._problems()
        except SceneError:
            undo()
            raise
        new = [text for key, text in problems.items() if key not in self._known]
        if new:
            undo()
            raise SceneError("\n".join(new).rstrip())
        self._known.clear()
        self._known.update(problems)


Scene._keys = {key["name"]: key for key in _TYPES["Scene"]["x-keys"]}
_CLASSES["Scene"] = Scene


def _message(problem: dict[str, Any]) -> str:
    """Text of a problem of a scene that stands in no file: its key in place of a line."""
    place = f"{problem['path']}: " if problem["path"] else ""
    advice = f" ({problem['help']})" if problem["help"] else ""
    return f"{place}{problem['message']}{advice}"


def read(path: str | os.PathLike[str]) -> Scene:
    """Scene of a file.

    Raises `SceneError` with all that is wrong with it, and where.
    """
    path = Path(path)
    return _scene_of(_native.text_of_file(str(path)), path)


def parse(text: str, path: str | os.PathLike[str] = "scene.ron") -> Scene:
    """Scene of a text; `path` stands for its file: paths in it are relative to the folder of that."""
    return _scene_of(text, Path(path))


def _scene_of(text: str, path: Path) -> Scene:
    wrong = [one["text"] for one in _native.check(text, str(path)) if one["severity"] == "error"]
    if wrong:
        raise SceneError("\n".join(wrong).rstrip())
    kind, holds = _native.tree(text, str(path))
    fields = holds[1][1] if kind == "named" else holds
    scene = Scene.__new__(Scene)
    Node.__init__(scene)
    object.__setattr__(scene, "_source", text)
    object.__setattr__(scene, "_path", path)
    object.__setattr__(scene, "_known", set())
    for key, tree in fields:
        scene._set[key] = scene._owned(key, _read(Scene._keys[key]["schema"], tree))
    return scene
