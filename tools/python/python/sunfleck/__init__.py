"""Light in forest scenes: write scenes, run them, and get their results as data sets of xarray.

>>> import sunfleck as sf
>>> scene = sf.read("birch_stand.ron")
>>> scene.sun.zenith_deg = 40
>>> results = sf.run(scene)
"""

from . import _language
from ._language import *  # noqa: F403
from ._native import RunError, SceneError, __version__
from ._run import Results, check, run
from ._scene import Scene, parse, read

__all__ = ["Results", "RunError", "Scene", "SceneError", "__version__", "check", "parse", "read", "run"]
__all__ += _language.__all__
