"""Mitsuba 3.9.1 on the benchmark stand: answers lines of orders until its input ends.

    image SAMPLES SEED FILE     nadir image of the middle 50 m at 850 nm; BRF, float64, rows from the north

Each answer is a line of JSON with the seconds of the rendering alone. Mitsuba has no surface that
reflects and transmits diffusely, so one is defined here, vectorised by its own compiler. It knows no
periodic scene, so it draws no principal plane.
"""

import json
import os
import sys
import tempfile
import time

import llvm

llvm.choose()
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_mono")
import drjit as dr

SIZE, EXTENT, SUN_ZENITH = 256, 50.0, 30.0
MOST_SCATTERINGS = 64


class BiLambertian(mi.BSDF):
    """Diffuse reflection of both sides and diffuse transmission."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.rho = props["reflectance"]
        self.tau = props["transmittance"]
        flags = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [mi.BSDFFlags.DiffuseReflection | flags, mi.BSDFFlags.DiffuseTransmission | flags]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def sample(self, ctx, si, sample1, sample2, active):
        cos_i = mi.Frame3f.cos_theta(si.wi)
        reflects = sample1 * (self.rho + self.tau) < self.rho
        wo = mi.warp.square_to_cosine_hemisphere(sample2)
        above = (cos_i > 0) == reflects
        wo.z = dr.select(above, wo.z, -wo.z)
        sample = mi.BSDFSample3f(wo)
        share = dr.select(reflects, self.rho, self.tau) / (self.rho + self.tau)
        sample.pdf = share * dr.abs(wo.z) / dr.pi
        sample.eta = 1.0
        sample.sampled_type = dr.select(reflects, +mi.BSDFFlags.DiffuseReflection, +mi.BSDFFlags.DiffuseTransmission)
        sample.sampled_component = dr.select(reflects, mi.UInt32(0), mi.UInt32(1))
        active = active & (sample.pdf > 0)
        return sample, dr.select(active, mi.Color1f(self.rho + self.tau), 0.0)

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


def parts_of(path):
    """Vertices and triangles of each group of an OBJ file."""
    vertices, groups, current = [], {}, None
    for line in open(path):
        part = line.split()
        if not part:
            continue
        if part[0] == "v":
            vertices.append([float(x) for x in part[1:4]])
        elif part[0] in ("g", "o", "usemtl"):
            current = groups.setdefault(part[1], [])
        elif part[0] == "f":
            corners = [int(corner.split("/")[0]) - 1 for corner in part[1:]]
            current.extend([corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1))
    return np.array(vertices), {name: np.array(faces) for name, faces in groups.items() if faces}


def mesh_file(name, vertices, faces):
    """A PLY of one part, as Mitsuba reads it into a group of shapes."""
    used, indices = np.unique(faces, return_inverse=True)
    mesh = mi.Mesh(name, vertex_count=len(used), face_count=len(faces))
    params = mi.traverse(mesh)
    params["vertex_positions"] = vertices[used].ravel().astype(np.float32)
    params["faces"] = indices.ravel().astype(np.uint32)
    params.update()
    path = os.path.join(tempfile.mkdtemp(), f"{name}.ply")
    mesh.write_ply(path)
    return path


def stand(folder):
    mi.register_bsdf("bilambertian", BiLambertian)
    surfaces = {"leaf": (0.4957, 0.4409), "trunk": (0.24, 0.0)}
    vertices, parts = parts_of(os.path.join(folder, "tree.obj"))
    tree = {"type": "shapegroup"}
    for name, faces in parts.items():
        rho, tau = surfaces[name]
        bsdf = {"type": "bilambertian", "reflectance": rho, "transmittance": tau}
        tree[name] = {"type": "ply", "filename": mesh_file(name, vertices, faces), "face_normals": True, "bsdf": bsdf}
    T = mi.ScalarTransform4f
    sun = np.radians(SUN_ZENITH)
    soil = {"type": "bilambertian", "reflectance": 0.159, "transmittance": 0.0}
    ground = T().translate([50.0, 50.0, 0.0]).scale([50.0, 50.0, 1.0])
    # North is up in the image, east on the right.
    look = T().look_at(origin=[50.0, 50.0, 200.0], target=[50.0, 50.0, 0.0], up=[0.0, 1.0, 0.0])
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "luminance", "component_format": "float32"}
    film["filter"] = {"type": "box"}
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": MOST_SCATTERINGS, "rr_depth": 6},
        "sensor": {
            "type": "orthographic",
            "to_world": look @ T().scale([EXTENT / 2, EXTENT / 2, 1.0]),
            "film": film,
            "sampler": {"type": "multijitter"},
        },
        # The sun in the west, with an irradiance of 1 on a surface across it.
        "sun": {
            "type": "directional",
            "direction": [float(np.sin(sun)), 0.0, float(-np.cos(sun))],
            "irradiance": {"type": "uniform", "value": 1.0},
        },
        "ground": {"type": "rectangle", "to_world": ground, "bsdf": soil},
        "tree": tree,
    }
    for index, (x, y, yaw) in enumerate(np.loadtxt(os.path.join(folder, "instances.txt"))):
        place = T().translate([x, y, 0.0]).rotate([0.0, 0.0, 1.0], float(np.degrees(yaw)))
        scene[f"instance_{index}"] = {"type": "instance", "to_world": place, "group": {"type": "ref", "id": "tree"}}
    return mi.load_dict(scene)


def image(scene, samples, seed):
    start = time.time()
    pixels = np.array(mi.render(scene, spp=samples, seed=seed)).reshape(SIZE, SIZE)
    return time.time() - start, pixels.astype(float) * np.pi / np.cos(np.radians(SUN_ZENITH))


def main():
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    scene = stand(sys.argv[1])
    # The first renderings of each size compile its kernels.
    compiled = set()
    for line in sys.stdin:
        _what, samples, seed, file = line.split()
        if samples not in compiled:
            compiled.add(samples)
            image(scene, int(samples), 999)
        seconds, pixels = image(scene, int(samples), int(seed))
        np.save(file, pixels)
        print(json.dumps({"seconds": seconds}), file=answers, flush=True)


if __name__ == "__main__":
    main()
