"""A stand of 500 generated spruces of 12 m with needle shoots, 789 124 triangles each, on one hectare.

The crown is that of `scenes/species/spruce.ron` with constant optical properties. sunfleck writes its triangles
beside the energy that they absorb; all other programs read those.
"""

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from .scene import Optics, Scene, Tools
from .stand import BARK, SOIL

TREES = 500
SIZE_M = 100.0
HEIGHT_M = 12.0
NEEDLE = Optics((0.07, 0.40), (0.03, 0.30))
# Length times half the width of the needles in the species file; branches and trunk have other triangles.
NEEDLE_TRIANGLE_M2 = 0.05 * 0.006 / 2


def crown(tools: Tools) -> str:
    """The species' crown as fields of a scene file."""
    species = (tools.repository / "scenes" / "species" / "spruce.ron").read_text()
    start, end = species.index("meshes:"), species.rindex(")")
    text = species[start:end].replace('"tree"', '"plant"', 1).replace('"bark"', '"wood"')
    return f'params: {{ "height": {HEIGHT_M}, "lai": 8.0 }},\n{text}'


def triangles(tools: Tools, mesh: str) -> dict[str, np.ndarray]:
    """Triangles of the crown by part."""
    scene = f"""Scene(
    format: 1,
    title: "One spruce",
    bands: [(name: "nir", center_nm: 850.0)],
    materials: {{
        "leaf": Leaf(reflectance: Constant(0.4), transmittance: Constant(0.3)),
        "wood": Lambertian(reflectance: Constant(0.24)),
        "soil": Lambertian(reflectance: Constant(0.159)),
    }},
    {mesh}
    terrain: Plane(size_m: (20.0, 20.0), material: "soil"),
    instances: [List(of: "plant", at_m: [(10.0, 10.0, 0.0)])],
    sun: (zenith_deg: 30.0, azimuth_deg: 270.0, irradiance: Constant(1.0)),
    boundary: Isolated,
    sensors: {{ "photons": Photons(per_m2: 1.0, measure: [Absorbed(per: Triangle)]) }},
)"""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "spruce.ron").write_text(scene)
        command = [str(tools.sunfleck), "run", str(folder / "spruce.ron"), "--out", str(folder / "out")]
        # Its warnings concern the light of this little scene, which nobody reads.
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        corners = read_ply(folder / "out" / "photons_absorbed_by_triangle.ply") - [10.0, 10.0, 0.0]
    # The first two are the ground.
    corners = corners[2:]
    edges = corners[:, 1:] - corners[:, :1]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
    is_needle = np.abs(area / NEEDLE_TRIANGLE_M2 - 1.0) < 0.01
    return {"leaf": corners[is_needle], "wood": corners[~is_needle]}


def read_ply(path: Path) -> np.ndarray:
    """Corners of the triangles of sunfleck's binary PLY, shape [n, 3, 3]: every triangle has vertices of its own."""
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    header = re.search(rb"element vertex (\d+)", content[:end])
    assert header, "sunfleck writes the number of vertices"
    vertex = np.dtype([("position", "<f4", 3), ("colour", "u1", 3)])
    return np.frombuffer(content, vertex, int(header[1]), end)["position"].reshape(-1, 3, 3).astype(float)


def make(tools: Tools) -> Scene:
    mesh = crown(tools)
    generator = np.random.default_rng(7)
    x, y = generator.uniform(0.0, SIZE_M, (2, TREES))
    yaw = generator.uniform(0.0, 2 * np.pi, TREES)
    return Scene(
        title="500 spruces",
        size_m=SIZE_M,
        sun_zenith_deg=30.0,
        soil=SOIL,
        optics={"leaf": NEEDLE, "wood": BARK},
        parts=triangles(tools, mesh),
        places=np.c_[x, y, np.zeros(TREES), yaw],
        native=mesh,
    )
