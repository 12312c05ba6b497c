"""RAMI's HET01_DIS_UNI: fifteen spheres of 49 999 discs over a plane.

Only sunfleck has discs. The comparison is made on regular octagons of the same area in their place, which
sunfleck gets as well; its own discs are measured beside them.
"""

import numpy as np

from .scene import Scene, Tools
from .stand import LEAF, SOIL

SIZE_M = 100.0
CORNERS = 8


def polygons(discs: np.ndarray) -> np.ndarray:
    """Regular polygons in the place of discs (rows of radius, centre and normal) as triangles [n, 3, 3]."""
    radius, centre, normal = discs[:, :1], discs[:, 1:4], discs[:, 4:7]
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    is_steep = np.abs(normal[:, 2:]) > 0.9
    first = np.cross(normal, np.where(is_steep, [[1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]]))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(normal, first)
    # A regular polygon of circumradius r has the area n/2 r² sin(2π/n).
    circumradius = radius * np.sqrt(np.pi / (CORNERS / 2 * np.sin(2 * np.pi / CORNERS)))
    angles = 2 * np.pi * np.arange(CORNERS) / CORNERS
    corners = [centre + circumradius * (np.cos(a) * first + np.sin(a) * second) for a in angles]
    fan = [np.stack([corners[0], corners[i], corners[i + 1]], axis=1) for i in range(1, CORNERS - 1)]
    return np.concatenate(fan)


def make(tools: Tools) -> Scene:
    folder = tools.data / "rami"
    leaves = folder / "het01_sphere_leaves.def"
    centres = np.loadtxt(folder / "het01_sphere_centres.def")
    zeros = np.zeros((len(centres), 1))
    return Scene(
        title="RAMI HET01",
        size_m=SIZE_M,
        sun_zenith_deg=20.0,
        soil=SOIL,
        optics={"leaf": LEAF},
        parts={"leaf": polygons(np.loadtxt(leaves))},
        # RAMI's origin is the middle of the scene.
        places=np.c_[centres + [SIZE_M / 2, SIZE_M / 2, 0.0], zeros],
        native=f'meshes: {{ "plant": Discs(file: "{leaves}", material: "leaf") }},',
    )
