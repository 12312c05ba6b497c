"""LESS 3.0.1 on the benchmark stand: answers lines of orders until its input ends.

    image SAMPLES SEED FILE     nadir image of the middle 50 m at 850 nm; BRF, float64, rows from the north
    plane PHOTONS SEED FILE     31 directions of the principal plane at 650 and 850 nm, shape [31, 2]
    plane:WRAPS ..              the same with another number of wraps

A wrap is a border of the scene that a ray may cross (`scene.repetitive`). LESS's default is 100. On this
stand 10 give the same values to 8 digits in about half the time; 1000 change no digit and take five times
as long, so they are no fair comparison.

Each answer is a line of JSON with the seconds of the simulation alone. Its random seed is fixed: of the
principal plane, other photons are those of a longer run less those of a shorter one.
"""

import json
import os
import sys
import tempfile
import time

import less
import numpy as np

SIZE, EXTENT = 256, 50.0
WAVELENGTHS = [650, 850]
# What users of LESS get who set nothing.
DEFAULT_WRAPS = 100


def tree_with_y_up(folder):
    lines = open(os.path.join(folder, "tree.obj")).read().splitlines()
    path = os.path.join(tempfile.mkdtemp(), "tree.obj")
    with open(path, "w") as out:
        for line in lines:
            part = line.split()
            if part and part[0] == "v":
                line = f"v {part[1]} {part[3]} {-float(part[2]):.6f}"
            out.write(line + "\n")
    return path


def stand(folder, mesh, wraps):
    def both_sides(reflectance, transmittance):
        return less.Lambertian(
            reflectance=reflectance, transmittance=transmittance, back_reflectance=reflectance, wavelengths=WAVELENGTHS
        )

    scene = less.Scene(backend="embree")
    scene.size = 100.0
    scene.terrain = less.Terrain(property=less.Lambertian(reflectance=[0.127, 0.159], wavelengths=WAVELENGTHS))
    sun = less.Sun(zenith=30, azimuth=270, wavelengths=np.arange(400, 2501, 10.0), irradiance=np.ones(211))
    scene.illumination = less.Illumination(source=sun, atmosphere=less.NoAtmosphere())
    tree = less.Object("tree", mesh=mesh)
    tree.set_property("leaf", both_sides([0.0546, 0.4957], [0.0149, 0.4409]))
    tree.set_property("trunk", both_sides([0.14, 0.24], [0.0, 0.0]))
    scene.repetitive = wraps
    places = np.loadtxt(os.path.join(folder, "instances.txt"))
    positions = np.c_[places[:, :2], np.zeros(len(places))]
    scene.add(tree, positions=positions, rotations=np.degrees(places[:, 2]))
    scene.build()
    return scene


def image(scene, samples):
    projection = less.Orthographic(image_size=SIZE, extent=EXTENT)
    start = time.time()
    product = scene.simulate(less.OpticalImager(projection, bands=[850], quality=samples))
    seconds = time.time() - start
    # Its rows run from the south.
    pixels = np.asarray(product.data, dtype=float).reshape(SIZE, SIZE)[::-1]
    return seconds, pixels * np.pi / np.cos(np.radians(30.0))


def plane(scene, photons):
    zeniths = range(-75, 76, 5)
    # The sun is in the west; positive angles are on its side.
    views = [(abs(zenith), 270 if zenith >= 0 else 90) for zenith in zeniths]
    start = time.time()
    product = scene.simulate(less.BRFSensor(bands=WAVELENGTHS, directions=views, num_photons=photons))
    return time.time() - start, np.asarray(product.brf, dtype=float)


def main():
    # What the library itself says must not stand among the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    folder = sys.argv[1]
    mesh = tree_with_y_up(folder)
    scenes = {}
    for line in sys.stdin:
        what, count, _seed, file = line.split()
        product, _, wraps = what.partition(":")
        if what not in scenes:
            scenes[what] = stand(folder, mesh, 0 if product == "image" else int(wraps or DEFAULT_WRAPS))
            # The first simulation builds what the others keep.
            image(scenes[what], 1) if product == "image" else plane(scenes[what], 1000)
        measure = {"image": image, "plane": plane}[product]
        seconds, values = measure(scenes[what], int(count))
        np.save(file, values)
        print(json.dumps({"seconds": seconds}), file=answers, flush=True)


if __name__ == "__main__":
    main()
