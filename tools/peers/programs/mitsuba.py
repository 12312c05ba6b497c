"""Mitsuba 3.9.1 on a scene: `python -m programs.mitsuba SCENE`.

Variant `llvm_ad_mono`: vectorised, one band. Mitsuba has no surface that reflects and transmits diffusely on both
sides, so one is defined here and compiled with the rest. It has no periodic scene, so it measures the image alone.

Seconds are the execution of its kernels. They leave out what comes before: recording them, which takes as long as
many samples in scenes of hundreds of instances, and compiling them. Both are in the log as the whole time.
"""

import sys
import time
from pathlib import Path

from . import llvm

llvm.choose()
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402

mi.set_variant("llvm_ad_mono")
import drjit as dr  # noqa: E402

from scenes.scene import BANDS_NM, IMAGE_BAND, IMAGE_EXTENT_M, PIXELS, Optics, Scene  # noqa: E402

from .measurement import Measurement, serve  # noqa: E402

BAND = list(BANDS_NM).index(IMAGE_BAND)
MOST_SCATTERINGS = 64
# Height that camera rays start from, m.
CAMERA_HEIGHT_M = 100.0


class BiLambertian(mi.BSDF):
    """Diffuse reflection of both sides and diffuse transmission."""

    def __init__(self, props: mi.Properties):
        mi.BSDF.__init__(self, props)
        self.rho = props["reflectance"]
        self.tau = props["transmittance"]
        sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [mi.BSDFFlags.DiffuseReflection | sides, mi.BSDFFlags.DiffuseTransmission | sides]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def sample(self, ctx, si, sample1, sample2, active):
        reflects = sample1 * (self.rho + self.tau) < self.rho
        wo = mi.warp.square_to_cosine_hemisphere(sample2)
        is_above = (mi.Frame3f.cos_theta(si.wi) > 0) == reflects
        wo.z = dr.select(is_above, wo.z, -wo.z)
        sample = mi.BSDFSample3f(wo)
        share = dr.select(reflects, self.rho, self.tau) / (self.rho + self.tau)
        sample.pdf = share * dr.abs(wo.z) / dr.pi
        sample.eta = 1.0
        sample.sampled_type = dr.select(reflects, +mi.BSDFFlags.DiffuseReflection, +mi.BSDFFlags.DiffuseTransmission)
        sample.sampled_component = dr.select(reflects, mi.UInt32(0), mi.UInt32(1))
        return sample, dr.select(active & (sample.pdf > 0), mi.Color1f(self.rho + self.tau), 0.0)

    def scattering(self, si, wo):
        is_same_side = mi.Frame3f.cos_theta(si.wi) * mi.Frame3f.cos_theta(wo) > 0
        return dr.select(is_same_side, self.rho, self.tau) * dr.abs(mi.Frame3f.cos_theta(wo)) / dr.pi

    def eval(self, ctx, si, wo, active):
        return dr.select(active, mi.Color1f(self.scattering(si, wo)), 0.0)

    def pdf(self, ctx, si, wo, active):
        return dr.select(active, self.scattering(si, wo) / (self.rho + self.tau), 0.0)

    def eval_pdf(self, ctx, si, wo, active):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def to_string(self):
        return "BiLambertian[]"


def surface(optics: Optics) -> dict:
    return {
        "type": "bilambertian",
        "reflectance": optics.reflectance[BAND],
        "transmittance": optics.transmittance[BAND],
    }


def write_part(folder: Path, name: str, triangles: np.ndarray) -> Path:
    """PLY file of one part, as Mitsuba reads it into a group of shapes."""
    mesh = mi.Mesh(name, vertex_count=3 * len(triangles), face_count=len(triangles))
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = triangles.ravel().astype(np.float32)
    parameters["faces"] = np.arange(3 * len(triangles), dtype=np.uint32)
    parameters.update()
    path = folder / f"mitsuba_{name}.ply"
    mesh.write_ply(str(path))
    return path


def load(scene: Scene, folder: Path) -> mi.Scene:
    mi.register_bsdf("bilambertian", BiLambertian)
    plant: dict = {"type": "shapegroup"}
    for name, triangles in scene.parts.items():
        file = str(write_part(folder, name, triangles))
        plant[name] = {"type": "ply", "filename": file, "face_normals": True, "bsdf": surface(scene.optics[name])}
    transform = mi.ScalarTransform4f
    middle, zenith = scene.size_m / 2, np.radians(scene.sun_zenith_deg)
    ground = transform().translate([middle, middle, 0.0]).scale([middle, middle, 1.0])
    # North is up in the image, east on the right.
    look = transform().look_at(
        origin=[middle, middle, CAMERA_HEIGHT_M], target=[middle, middle, 0.0], up=[0.0, 1.0, 0.0]
    )
    film = {
        "type": "hdrfilm", "width": PIXELS, "height": PIXELS, "pixel_format": "luminance",
        "component_format": "float32", "filter": {"type": "box"},
    }
    description = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": MOST_SCATTERINGS, "rr_depth": 5},
        "sensor": {
            "type": "orthographic",
            "to_world": look @ transform().scale([IMAGE_EXTENT_M / 2, IMAGE_EXTENT_M / 2, 1.0]),
            "film": film,
            "sampler": {"type": "multijitter"},
        },
        # An irradiance of 1 on a surface across the beam.
        "sun": {
            "type": "directional",
            "direction": [float(np.sin(zenith)), 0.0, float(-np.cos(zenith))],
            "irradiance": {"type": "uniform", "value": 1.0},
        },
        "ground": {"type": "rectangle", "to_world": ground, "bsdf": surface(scene.soil)},
        "plant": plant,
    }
    for index, (x, y, z, yaw) in enumerate(scene.places):
        place = transform().translate([x, y, z]).rotate([0.0, 0.0, 1.0], float(np.degrees(yaw)))
        description[f"instance_{index}"] = {
            "type": "instance", "to_world": place, "group": {"type": "ref", "id": "plant"}
        }
    return mi.load_dict(description)


class Mitsuba:
    def __init__(self, scene: Scene, folder: Path):
        self.scene = load(scene, folder)
        self.scale = np.pi / np.cos(np.radians(scene.sun_zenith_deg))

    def image(self, samples: int, seed: int) -> Measurement:
        opaque = mi.UInt32(seed)
        dr.make_opaque(opaque)
        dr.kernel_history_clear()
        start = time.perf_counter()
        with dr.scoped_set_flag(dr.JitFlag.KernelHistory):
            pixels = np.array(mi.render(self.scene, spp=samples, seed=opaque)).reshape(PIXELS, PIXELS)
            dr.sync_thread()
        whole = time.perf_counter() - start
        # Milliseconds; entries without it are no kernels.
        seconds = sum(kernel.get("execution_time", 0.0) for kernel in dr.kernel_history()) / 1000.0
        print(f"{samples} samples: kernels {seconds:.2f} s of {whole:.2f} s", file=sys.stderr)
        return Measurement(seconds, pixels.astype(float) * self.scale)


def main() -> None:
    folder = Path(sys.argv[1])
    program = Mitsuba(Scene.read(folder), folder)
    serve(lambda product, count, seed: program.image(count, seed))


if __name__ == "__main__":
    main()
