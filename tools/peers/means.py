"""How far the mean of the nadir image is off: sunfleck and LESS 3.0.1 at several places of the benchmark stand.

    python tools/peers/means.py [--program FILE] [--samples 2 8 16]

LESS has one random seed, so that at one place the error of its mean is one number, small or large by chance.
Here the trees are moved by a part of the stand, those that leave it come in again at the other side, and the
camera sees others: places are as good as seeds. The mean of two sunfleck images of 64 samples a pixel is the truth.
"""

import argparse
import math
import os
import tempfile

import numpy as np

from compare import HERE, ROOT, STAND, Sunfleck, Worker

SIDE_M = 100.0
SHIFTS_M = [(0, 0), (50, 0), (0, 50), (50, 50), (25, 25), (75, 25), (25, 75)]
TRUTH = 64


def move(folder, shift):
    """Writes the stand with its trees moved, and its scene; says where that is."""
    trees = np.loadtxt(os.path.join(STAND, "instances.txt"))
    trees[:, :2] = (trees[:, :2] + shift) % SIDE_M
    np.savetxt(os.path.join(folder, "instances.txt"), trees, fmt="%.9f")
    os.symlink(os.path.abspath(os.path.join(STAND, "tree.obj")), os.path.join(folder, "tree.obj"))
    text = open(os.path.join(HERE, "stand.ron")).read()
    scene = os.path.join(folder, "stand.ron")
    open(scene, "w").write(text.replace("../../../shared/data/stand/", ""))
    return scene


class Place(Sunfleck):
    """sunfleck at one of the places."""

    def __init__(self, program, folder, scene):
        super().__init__(program, folder)
        self.scene = scene

    def run(self, _, **settings):
        return super().run(self.scene, **settings)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "sunfleck"))
    parser.add_argument("--samples", type=int, nargs="+", default=[2, 8, 16], help="samples a pixel")
    arguments = parser.parse_args()
    found = {}
    for shift in SHIFTS_M:
        with tempfile.TemporaryDirectory() as folder:
            sunfleck = Place(arguments.program, folder, move(folder, shift))
            less = Worker("less", "less_stand.py", folder, folder)
            truth = np.mean([np.nanmean(sunfleck.measure("image", TRUTH, seed)[1]) for seed in (1, 2)])
            for program in [less, sunfleck]:
                for count in arguments.samples:
                    seconds, pixels = program.measure("image", count, 3)
                    off = np.nanmean(pixels) / truth - 1.0
                    found.setdefault((program.name, count), []).append((seconds, off))
                    print(f"moved by {shift[0]:2} and {shift[1]:2} m  {program.name:9}{count:3} samples"
                          f"{seconds:7.2f} s  off by {100 * off:+.3f} %", flush=True)
            less.close()
    print(f"\n{'program':9} {'samples':>7} {'seconds':>8} {'off, rms':>9} {'s to 0.1 %':>11}")
    times = {}
    for (program, count), values in found.items():
        seconds, off = np.mean([one[0] for one in values]), math.sqrt(np.mean([one[1] ** 2 for one in values]))
        times.setdefault(program, []).append(seconds * (off / 0.001) ** 2)
        print(f"{program:9} {count:7} {seconds:8.2f} {100 * off:8.3f}% {times[program][-1]:11.1f}")
    for program, seconds in times.items():
        print(f"{program:9} {'mean':>7} {np.mean(seconds):30.1f}")


if __name__ == "__main__":
    main()
