"""Scenes of the comparison: the same triangles, optical properties and light for every program."""

from collections.abc import Callable

from . import het01, spruces, stand
from .scene import Scene, Tools

# Functions that make the scenes, by name.
SCENES: dict[str, Callable[[Tools], Scene]] = {
    "stand": stand.make,
    "spruces": spruces.make,
    "het01": het01.make,
}
