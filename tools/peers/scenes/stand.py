"""The benchmark stand: 700 trees of 50 024 triangles each on one hectare."""

import numpy as np

from .scene import Optics, Scene, Tools, read_obj

LEAF = Optics((0.0546, 0.4957), (0.0149, 0.4409))
BARK = Optics((0.14, 0.24))
SOIL = Optics((0.127, 0.159))


def make(tools: Tools) -> Scene:
    x, y, yaw = np.loadtxt(tools.data / "stand" / "instances.txt").T
    return Scene(
        title="Benchmark stand",
        size_m=100.0,
        sun_zenith_deg=30.0,
        soil=SOIL,
        optics={"leaf": LEAF, "trunk": BARK},
        parts=read_obj(tools.data / "stand" / "tree.obj"),
        places=np.c_[x, y, np.zeros_like(x), yaw],
    )
