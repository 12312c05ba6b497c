"""A scene as all programs get it: one mesh of triangles, its placements, constant optical properties and a sun.

Coordinates are metres: x east, y north, z up, from the scene's south-western corner. The sun is in the west.
"""

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

BANDS_NM = {"red": 650.0, "nir": 850.0}
IMAGE_BAND = "nir"
SUN_AZIMUTH_DEG = 270.0
PIXELS = 256
IMAGE_EXTENT_M = 50.0
# View zenith angles of the principal plane; positive ones are on the sun's side.
VIEW_ZENITHS_DEG = list(range(-75, 76, 5))


@dataclass(frozen=True)
class Tools:
    """What the making of a scene needs."""

    sunfleck: Path
    repository: Path

    @property
    def data(self) -> Path:
        """Data that stand beside the repository and are no part of it."""
        return self.repository.parent / "shared" / "data"


@dataclass(frozen=True)
class Optics:
    """Diffuse reflectance and transmittance of both sides, shape [red, nir] each."""

    reflectance: tuple[float, float]
    transmittance: tuple[float, float] = (0.0, 0.0)


@dataclass
class Scene:
    title: str
    size_m: float
    sun_zenith_deg: float
    soil: Optics
    # By part of the mesh.
    optics: dict[str, Optics]
    # Triangles of each part, shape [n, 3, 3].
    parts: dict[str, np.ndarray]
    # Rows of x, y, z and rotation (counter-clockwise from above, radians), shape [n, 4].
    places: np.ndarray
    # sunfleck's own description of the mesh "plant" where it has one: further fields of its scene file.
    native: str | None = None

    def reach_m(self) -> float:
        """Largest horizontal distance of the mesh from its origin."""
        return max(float(np.hypot(part[..., 0], part[..., 1]).max()) for part in self.parts.values())

    def places_with_border_copies(self) -> np.ndarray:
        """Placements and those copies of them, one period away, whose crowns reach into the scene.

        For programs that repeat what lies within the borders and lose what reaches across them.
        """
        reach, rows = self.reach_m(), [self.places]
        shifts = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
        for i, j in shifts:
            copies = self.places + [i * self.size_m, j * self.size_m, 0.0, 0.0]
            inside = (copies[:, :2] > -reach) & (copies[:, :2] < self.size_m + reach)
            rows.append(copies[inside.all(axis=1)])
        return np.concatenate(rows)

    def moved(self, x_m: float, y_m: float) -> "Scene":
        """The periodic scene moved by a vector: the same scene without end."""
        places = self.places.copy()
        places[:, :2] = (places[:, :2] + [x_m, y_m]) % self.size_m
        return replace(self, places=places)

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        header = {name: value for name, value in asdict(self).items() if name not in ("parts", "places")}
        (folder / "scene.json").write_text(json.dumps(header, indent=1))
        arrays = {f"part:{name}": triangles.astype(np.float32) for name, triangles in self.parts.items()}
        arrays["places"] = self.places
        np.savez(folder / "scene.npz", allow_pickle=False, **arrays)

    @staticmethod
    def read(folder: Path) -> "Scene":
        header = json.loads((folder / "scene.json").read_text())
        arrays = np.load(folder / "scene.npz")
        header["soil"] = Optics(**header["soil"])
        header["optics"] = {name: Optics(**optics) for name, optics in header["optics"].items()}
        parts = {name.removeprefix("part:"): arrays[name] for name in arrays.files if name != "places"}
        return Scene(**header, parts=parts, places=arrays["places"])


def read_obj(path: Path) -> dict[str, np.ndarray]:
    """Triangles of each group of an OBJ file, shape [n, 3, 3]."""
    vertices: list[list[float]] = []
    groups: dict[str, list[list[int]]] = {}
    group = "default"
    for line in path.read_text().splitlines():
        tag, *values = line.split() or [""]
        if tag == "v":
            vertices.append([float(value) for value in values[:3]])
        elif tag == "g":
            group = values[0]
        elif tag == "f":
            corners = [int(value.split("/")[0]) - 1 for value in values]
            fan = ([corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1))
            groups.setdefault(group, []).extend(fan)
    return {name: np.array(vertices)[np.array(faces)] for name, faces in groups.items()}


def write_obj(path: Path, parts: dict[str, np.ndarray]) -> None:
    """Writes the parts as groups, every triangle with vertices and a normal of its own."""
    first = 1
    with path.open("w") as file:
        for number, (name, triangles) in enumerate(parts.items()):
            normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]).astype(float)
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
            file.write(f"g {name}\nusemtl {name}\n")
            np.savetxt(file, triangles.reshape(-1, 3), fmt="v %.6f %.6f %.6f")
            np.savetxt(file, normals, fmt="vn %.5f %.5f %.5f")
            corner = first + 3 * np.arange(len(triangles))
            normal = sum(len(part) for part in list(parts.values())[:number]) + 1 + np.arange(len(triangles))
            columns = np.c_[corner, normal, corner + 1, normal, corner + 2, normal]
            np.savetxt(file, columns, fmt="f %d//%d %d//%d %d//%d")
            first += 3 * len(triangles)
