"""sunfleck: a process for each measurement; seconds are those of the sensor alone."""

import json
import subprocess
from pathlib import Path

import numpy as np

from scenes.scene import (
    BANDS_NM, IMAGE_BAND, IMAGE_EXTENT_M, PIXELS, SUN_AZIMUTH_DEG, VIEW_ZENITHS_DEG, Optics, Scene, write_obj,
)

from .measurement import Measurement

STEP_DEG = VIEW_ZENITHS_DEG[1] - VIEW_ZENITHS_DEG[0]
# COUNT stands for the number of samples.
SENSORS = {
    "image": f"""Orthographic(
            size_px: ({PIXELS}, {PIXELS}), extent_m: ({IMAGE_EXTENT_M}, {IMAGE_EXTENT_M}), samples_per_px: COUNT,
        )""",
    "directions": f"""Directions(
            views: PrincipalPlane(max_deg: {VIEW_ZENITHS_DEG[-1]}, step_deg: {STEP_DEG}), until: Samples(COUNT),
        )""",
}


def material(optics: Optics, bands: list[int]) -> str:
    reflectance = [optics.reflectance[band] for band in bands]
    transmittance = [optics.transmittance[band] for band in bands]
    if not any(optics.transmittance):
        return f"Lambertian(reflectance: Bands({reflectance}))"
    return f"Leaf(reflectance: Bands({reflectance}), transmittance: Bands({transmittance}))"


def write_scene(scene: Scene, folder: Path, product: str, is_native: bool) -> Path:
    """Writes the scene file of a product, with `count` and `seed` as parameters."""
    names = list(BANDS_NM)
    bands = [names.index(IMAGE_BAND)] if product == "image" else list(range(len(names)))
    shown = ", ".join(f'(name: "{names[band]}", center_nm: {BANDS_NM[names[band]]}, width_nm: 20.0)' for band in bands)
    materials = {"soil": scene.soil, **scene.optics}
    mesh = scene.native
    if not is_native:
        parts = ", ".join(f'"{name}": "{name}"' for name in scene.parts)
        mesh = f'meshes: {{ "plant": Obj(file: "plant.obj", up: Z, unit_m: 1.0, parts: {{ {parts} }}) }},'
    assert mesh is not None, "native meshes are asked of scenes that have one"
    sensor = SENSORS[product].replace("COUNT", '"=count"')
    fields = ['"count": 16.0', '"seed": 1.0']
    # A file has one set of parameters: those of the mesh join them.
    if mesh.startswith("params: {"):
        own, mesh = mesh.removeprefix("params: {").split("}", 1)
        fields.append(own.strip())
        mesh = mesh.lstrip(",")
    text = f"""Scene(
    format: 1,
    title: "{scene.title}",
    params: {{ {", ".join(fields)} }},
    bands: [{shown}],
    materials: {{ {", ".join(f'"{name}": {material(optics, bands)}' for name, optics in materials.items())} }},
    {mesh}
    terrain: Plane(size_m: ({scene.size_m}, {scene.size_m}), material: "soil"),
    instances: [Table(file: "places.txt", of: "plant", columns: ["x_m", "y_m", "z_m", "yaw_rad"])],
    sun: (zenith_deg: {scene.sun_zenith_deg}, azimuth_deg: {SUN_AZIMUTH_DEG}, irradiance: Constant(1.0)),
    boundary: {"Isolated" if product == "image" else "Periodic"},
    transport: (seed: "=seed"),
    sensors: {{ "sensor": {sensor} }},
)
"""
    path = folder / f"{product}{'_native' if is_native else ''}.ron"
    path.write_text(text)
    return path


class Sunfleck:
    def __init__(self, name: str, program: Path, folder: Path, is_native: bool = False):
        self.name, self.program, self.folder = name, program, folder
        scene = Scene.read(folder)
        np.savetxt(folder / "places.txt", scene.places, fmt="%.9f")
        if not is_native:
            write_obj(folder / "plant.obj", scene.parts)
        self.files = {product: write_scene(scene, folder, product, is_native) for product in SENSORS}

    def measure(self, product: str, count: int, seed: int) -> Measurement:
        out = self.folder / "out"
        command = [str(self.program), "run", str(self.files[product]), "--out", str(out), "--force"]
        command += ["--set", f"count={count}", "--set", f"seed={seed}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        summary = json.loads((out / "summary.json").read_text())
        run = summary["runs"]["sensor"]
        if product == "image":
            values = np.fromfile(out / "sensor_brf.img", "<f4").astype(float).reshape(PIXELS, PIXELS)
        else:
            values = np.array(summary["sensors"]["sensor"]["brf"]["values"]).reshape(-1, len(BANDS_NM))
        return Measurement(run["seconds"], values, run["rays"])

    def close(self) -> None:
        pass
