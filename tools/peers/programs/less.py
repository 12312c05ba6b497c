"""LESS 3.0.1 on a scene: `python -m programs.less SCENE WRAPS`.

A wrap is a border of the scene that a ray may cross (`scene.repetitive`), 100 by default. Conventions of LESS:
- y of placements points south, from the northern border; rotations are counter-clockwise from above;
- OBJ files have y up and z north, so that x points west;
- parts of crowns beyond the scene's borders are lost when it repeats the scene, so it gets copies of those trees.

Its random numbers are fixed. Images of other seeds are moved by whole pixels, so that each point of the ground
gets other random numbers; periodic scenes of other seeds are moved by a vector. Both leave the expectation as it is.
"""

import sys
import time
from pathlib import Path

import less
import numpy as np

from scenes.scene import (
    BANDS_NM, IMAGE_BAND, IMAGE_EXTENT_M, PIXELS, SUN_AZIMUTH_DEG, VIEW_ZENITHS_DEG, Optics, Scene, write_obj,
)

from .measurement import Measurement, serve

WAVELENGTHS = list(BANDS_NM.values())


def surface(optics: Optics) -> less.Lambertian:
    """Both sides of a surface alike."""
    return less.Lambertian(
        reflectance=list(optics.reflectance),
        transmittance=list(optics.transmittance),
        back_reflectance=list(optics.reflectance),
        wavelengths=WAVELENGTHS,
    )


class Less:
    def __init__(self, scene: Scene, folder: Path, wraps: int):
        self.scene, self.wraps = scene, wraps
        self.mesh = folder / "less.obj"
        if not self.mesh.exists():
            turned = {name: part[..., [0, 2, 1]] * [-1.0, 1.0, 1.0] for name, part in scene.parts.items()}
            write_obj(self.mesh, turned)
        self.image_scene: less.Scene | None = None

    def build(self, places: np.ndarray, wraps: int) -> less.Scene:
        scene = less.Scene(backend="embree")
        scene.size = self.scene.size_m
        soil = less.Lambertian(reflectance=list(self.scene.soil.reflectance), wavelengths=WAVELENGTHS)
        scene.terrain = less.Terrain(property=soil)
        wavelengths = np.arange(400.0, 2501.0, 10.0)
        sun = less.Sun(
            zenith=self.scene.sun_zenith_deg,
            azimuth=SUN_AZIMUTH_DEG,
            wavelengths=wavelengths,
            irradiance=np.ones_like(wavelengths),
        )
        scene.illumination = less.Illumination(source=sun, atmosphere=less.NoAtmosphere())
        plant = less.Object("plant", mesh=str(self.mesh))
        for name, optics in self.scene.optics.items():
            plant.set_property(name, surface(optics))
        scene.repetitive = wraps
        positions = np.c_[places[:, 0], self.scene.size_m - places[:, 1], places[:, 2]]
        scene.add(plant, positions=positions, rotations=np.degrees(places[:, 3]))
        scene.build()
        return scene

    def image(self, samples: int, seed: int) -> Measurement:
        if self.image_scene is None:
            self.image_scene = self.build(self.scene.places, 0)
            self.render(self.image_scene, 1, 0)
        return self.render(self.image_scene, samples, seed - 1)

    def render(self, scene: less.Scene, samples: int, shift: int) -> Measurement:
        """An image that is moved to the east by `shift` pixels, put back into place."""
        middle = self.scene.size_m / 2
        centre = (middle + shift * IMAGE_EXTENT_M / PIXELS, middle)
        projection = less.Orthographic(image_size=PIXELS, extent=IMAGE_EXTENT_M, center=centre)
        imager = less.OpticalImager(projection, bands=[BANDS_NM[IMAGE_BAND]], quality=samples)
        seconds, product = timed(scene, "simulate_backward", imager)
        pixels = np.full((PIXELS, PIXELS), np.nan)
        radiance = np.asarray(product.data, dtype=float).reshape(PIXELS, PIXELS)
        pixels[:, shift:] = radiance[:, : PIXELS - shift]
        return Measurement(seconds, pixels * np.pi / np.cos(np.radians(self.scene.sun_zenith_deg)))

    def directions(self, photons: int, seed: int) -> Measurement:
        shift = np.random.default_rng(seed).uniform(0.0, self.scene.size_m, 2)
        scene = self.build(self.scene.moved(*shift).places_with_border_copies(), self.wraps)
        azimuths = [SUN_AZIMUTH_DEG if zenith >= 0 else SUN_AZIMUTH_DEG - 180.0 for zenith in VIEW_ZENITHS_DEG]
        views = list(zip(map(abs, VIEW_ZENITHS_DEG), azimuths))
        sensor = less.BRFSensor(bands=WAVELENGTHS, directions=views, num_photons=photons)
        seconds, product = timed(scene, "simulate_brf", sensor)
        return Measurement(seconds, np.asarray(product.brf, dtype=float))


def timed(scene: less.Scene, kernel: str, sensor: object) -> tuple[float, object]:
    """Simulates, and measures the seconds of the ray tracing kernel alone, without the building of its tree."""
    runtime = scene._ensure_backend()
    run = getattr(type(runtime), kernel).__get__(runtime)
    seconds = []

    def measured(*arguments, **settings):
        start = time.perf_counter()
        result = run(*arguments, **settings)
        seconds.append(time.perf_counter() - start)
        return result

    setattr(runtime, kernel, measured)
    product = scene.simulate(sensor)
    return sum(seconds), product


def main() -> None:
    folder, wraps = Path(sys.argv[1]), int(sys.argv[2])
    program = Less(Scene.read(folder), folder, wraps)
    products = {"image": program.image, "directions": program.directions}
    serve(lambda product, count, seed: products[product](count, seed))


if __name__ == "__main__":
    main()
