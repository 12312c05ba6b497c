"""Embree 4.3.3: `embree_path.cpp`, compiled here, traces the rays of the image.

Headers and library are found in the folder that EMBREE_DIR names (with `include` and `lib`) and in the system's
(Debian 13: `apt-get install libembree-dev`), the library also in LESS's package, which brings the same version.
"""

import os
import shutil
import subprocess
import sysconfig
from pathlib import Path

import numpy as np

from scenes.scene import IMAGE_BAND, BANDS_NM, IMAGE_EXTENT_M, PIXELS, Optics, Scene

from .measurement import Measurement

# Instruction sets that Embree 4 is built with; the faster one is measured.
INSTRUCTION_SETS = ["avx2", "avx512"]


def compile_program(folder: Path) -> Path:
    places = [Path(os.environ[name]) for name in ["EMBREE_DIR"] if name in os.environ] + [Path("/usr")]
    headers = [place / "include" for place in places if (place / "include" / "embree4" / "rtcore.h").exists()]
    if not headers:
        raise SystemExit("no headers of Embree 4: install libembree-dev, set EMBREE_DIR or use --without embree")
    found = [file for place in places for file in sorted(place.glob("lib/**/libembree4.so*"))]
    found += sorted((Path(sysconfig.get_paths()["purelib"]) / "less").glob("libembree4.so*"))
    if not found:
        raise SystemExit("no library of Embree 4: set EMBREE_DIR or install less3d, which brings it")
    library = found[0]
    program = folder / "embree_path"
    compiler = os.environ.get("CXX") or shutil.which("g++") or "c++"
    command = [compiler, "-std=c++17", "-O3", "-march=native", "-ffast-math", "-fno-finite-math-only", "-pthread"]
    command += [str(Path(__file__).with_name("embree_path.cpp")), f"-I{headers[0]}", str(library)]
    command += [f"-Wl,-rpath,{library.parent}", "-Wl,--allow-shlib-undefined", "-o", str(program)]
    subprocess.run(command, check=True)
    return program


def write_scene(scene: Scene, path: Path) -> None:
    band = list(BANDS_NM).index(IMAGE_BAND)

    def surface(optics: Optics) -> np.ndarray:
        return np.array([optics.reflectance[band], optics.transmittance[band]], "<f4")

    with path.open("wb") as file:
        np.array([len(scene.parts), len(scene.places), PIXELS], "<u4").tofile(file)
        np.array([scene.size_m, IMAGE_EXTENT_M, np.radians(scene.sun_zenith_deg)], "<f4").tofile(file)
        surface(scene.soil).tofile(file)
        for name, triangles in scene.parts.items():
            surface(scene.optics[name]).tofile(file)
            np.array([len(triangles)], "<u4").tofile(file)
            triangles.astype("<f4").tofile(file)
        scene.places.astype("<f4").tofile(file)


class Embree:
    name = "Embree"

    def __init__(self, program: Path, folder: Path):
        self.program, self.folder = program, folder
        write_scene(Scene.read(folder), folder / "embree.bin")
        times = {name: min(self.run(name, 1, seed).seconds for seed in (1, 2)) for name in INSTRUCTION_SETS}
        self.instructions = min(times, key=times.__getitem__)
        print(f"  Embree traces with {self.instructions}")

    def run(self, instructions: str, samples: int, seed: int) -> Measurement:
        image = self.folder / "embree_image.bin"
        threads = len(os.sched_getaffinity(0))
        arguments = [self.folder / "embree.bin", samples, seed, image, threads, instructions]
        command = [str(argument) for argument in [self.program, *arguments]]
        answer = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
        pixels = np.fromfile(image, "<f4").astype(float).reshape(PIXELS, PIXELS)
        return Measurement(float(answer[1]), pixels, int(answer[2]))

    def measure(self, product: str, count: int, seed: int) -> Measurement:
        assert product == "image", "the loop on Embree has no periodic scene"
        return self.run(self.instructions, count, seed)

    def close(self) -> None:
        pass
