"""Compares run time and error of sunfleck, LESS 3.0.1 and Mitsuba 3.9.1 on the benchmark stand.

    python tools/peers/compare.py [--out DIR] [--repeats N] [--quick]

On one machine, in one run, interleaved. Writes peers.csv (one row a measurement), peers_summary.csv and
peers.svg; prints the summary. README.md says what is measured and how.
"""

import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
STAND = os.path.join(ROOT, "..", "shared", "data", "stand")
PIXELS = 256
# Borders of the scene that rays of LESS may cross: its default, and the fewest that give the same values.
LESS_WRAPS = {"less": 100, "less, 10 wraps": 10}


class Worker:
    """A program that keeps its scene between measurements."""

    def __init__(self, name, script, folder, stand=STAND):
        self.name, self.folder = name, folder
        self.log = os.path.join(folder, f"{name}.log")
        command = [sys.executable, os.path.join(HERE, script), stand]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=open(self.log, "w"), text=True)

    def measure(self, what, count, seed):
        file = os.path.join(self.folder, f"{self.name}.npy")
        print(what, count, seed, file, file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline()
        if not answer:
            said = "".join(open(self.log).readlines()[-8:])
            raise SystemExit(f"{self.name} ended:\n{said}")
        return json.loads(answer)["seconds"], np.load(file)

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class Sunfleck:
    """sunfleck itself: a process for each measurement; seconds are those of the sensor alone, too."""

    name = "sunfleck"

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, scene, **settings):
        out = os.path.join(self.folder, "sunfleck")
        command = [self.program, "run", os.path.join(HERE, scene), "--out", out]
        for name, value in settings.items():
            command += ["--set", f"{name}={value}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return out, json.load(open(os.path.join(out, "summary.json")))

    def measure(self, what, count, seed):
        if what == "image":
            out, summary = self.run("stand.ron", samples=count, seed=seed)
            pixels = np.fromfile(os.path.join(out, "nadir_brf.img"), dtype="<f4").astype(float)
            return summary["runs"]["nadir"]["seconds"], pixels.reshape(PIXELS, PIXELS)
        _, summary = self.run("stand_plane.ron", error=count, seed=seed)
        values = np.array(summary["sensors"]["plane"]["brf"]["values"])
        return summary["runs"]["plane"]["seconds"], values.reshape(31, 2)


def rmse(a, b):
    """Relative, per value; values that are no number in either are left out."""
    known = np.isfinite(a) & np.isfinite(b)
    return float(np.sqrt(np.mean((a[known] - b[known]) ** 2)) / np.mean(b[known]))


def images(programs, truth, samples, repeats):
    rows = []
    for repeat in range(1, repeats + 1):
        for count in samples:
            for program in programs:
                seconds, pixels = program.measure("image", count, 100 * repeat + 7)
                # Noise of the truth is none of theirs.
                error = math.sqrt(max(rmse(pixels, truth.values) ** 2 - truth.error**2, 0.0))
                mean = float(np.nanmean(pixels))
                # A program that draws another scene or turns it shows here, not in its noise.
                alike = float(np.corrcoef(np.nan_to_num(pixels).ravel(), truth.values.ravel())[0, 1])
                if alike < 0.5 * truth.likeness(error):
                    raise SystemExit(f"{program.name} draws another picture: correlation {alike:.3f}, not {truth.likeness(error):.3f}")
                rows.append(
                    dict(product="nadir image, pixels", program=program.name, repeat=repeat, samples=count,
                         seconds=seconds, relative_error=error, mean=mean, correlation=alike)
                )
                print(f"{program.name:14} image {count:5} samples {seconds:8.2f} s  RMSE {100 * error:6.2f} %"
                      f"  mean {mean:.5f}  correlation {alike:.3f}", flush=True)
    return rows


class Truth:
    """An image of many samples, and what its own noise amounts to."""

    def __init__(self, sunfleck, samples):
        _, a = sunfleck.measure("image", samples // 2, 1)
        _, b = sunfleck.measure("image", samples // 2, 2)
        self.values = 0.5 * (a + b)
        self.error = rmse(a, b) / 2.0

    def likeness(self, error):
        """Correlation with an image that differs from this one by noise alone, of that relative error."""
        noisy = (np.nanstd(self.values) / np.nanmean(self.values)) ** 2
        scene = noisy - self.error**2
        return scene / math.sqrt(noisy * (scene + error**2))


def planes(sunfleck, less, photons, errors, repeats):
    rows = []

    def add(program, samples, seconds, values, other, scale):
        # Two independent estimates of the same error differ by √2 of it.
        for band, name in enumerate(["red", "nir"]):
            off = np.abs(values[:, band] - other[:, band]) / math.sqrt(2.0) / np.mean(values[:, band])
            error = scale * float(np.sqrt(np.mean(off**2)))
            rows.append(
                dict(product=f"31 directions, {name}", program=program, repeat=len(rows), samples=samples,
                     seconds=seconds, relative_error=error, mean=float(np.mean(values[:, band])), correlation="")
            )
            print(f"{program:14} plane {name:4} {samples:>9} {seconds:8.2f} s  error {100 * error:6.2f} %", flush=True)

    for repeat in range(1, repeats + 1):
        for error in errors:
            seconds, a = sunfleck.measure("plane", error, 10 * repeat)
            _, b = sunfleck.measure("plane", error, 10 * repeat + 1)
            add("sunfleck", error, seconds, a, b, 1.0)
        if less and photons and repeat == 1:
            # The seed is fixed: photons of a longer run less those of a shorter one are others.
            for name, wraps in LESS_WRAPS.items():
                seconds, once = less.measure(f"plane:{wraps}", photons, 1)
                _, twice = less.measure(f"plane:{wraps}", 2 * photons, 1)
                if np.array_equal(once, twice):
                    raise SystemExit(f"LESS traced the same photons twice: {photons} are fewer than it traces at once")
                add(name, photons, seconds, once, 2.0 * twice - once, 1.0)
    return rows


def summarise(rows):
    """Median time and root mean square error of each number of samples, and time to errors."""
    keys = list(dict.fromkeys((row["product"], row["program"]) for row in rows))
    summary = []
    for product, program in keys:
        points = {}
        for row in rows:
            if (row["product"], row["program"]) == (product, program):
                points.setdefault(row["samples"], []).append(row)
        curve = [
            (statistics.median(row["seconds"] for row in group),
             math.sqrt(statistics.mean(row["relative_error"] ** 2 for row in group)))
            for group in points.values()
        ]
        efficiency = statistics.median(1.0 / (error**2 * seconds) for seconds, error in curve)
        summary.append(dict(product=product, program=program, curve=curve, efficiency=efficiency))
    for one in summary:
        ours = next(other for other in summary if (other["product"], other["program"]) == (one["product"], "sunfleck"))
        one["ratio"] = ours["efficiency"] / one["efficiency"]
    return summary


def write(folder, rows, summary):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "peers.csv"), "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    with open(os.path.join(folder, "peers_summary.csv"), "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["product", "program", "seconds", "relative_error", "efficiency_per_s", "sunfleck_over_it"])
        for one in summary:
            for seconds, error in one["curve"]:
                writer.writerow([one["product"], one["program"], seconds, error, one["efficiency"], one["ratio"]])


COLOURS = {"sunfleck": "#0072b2", "less": "#d55e00", "less, 10 wraps": "#e69f00", "mitsuba": "#009e73"}


def draw(path, summary):
    """Run time against error, as `sunfleck bench` draws it."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.fonttype"] = "none"
    import matplotlib.pyplot as plt
    from matplotlib import ticker

    products = list(dict.fromkeys(one["product"] for one in summary))
    figure, panels = plt.subplots(1, len(products), figsize=(5.2 * len(products), 4.2), squeeze=False, layout="constrained")
    for panel, product in zip(panels[0], products):
        curves = [one for one in summary if one["product"] == product]
        for one in curves:
            seconds, errors = zip(*sorted(one["curve"]))
            panel.loglog(seconds, [100 * error for error in errors], "o-", color=COLOURS[one["program"]], label=one["program"])
        low, high = panel.get_xlim()
        bottom, top = panel.get_ylim()
        for decade in np.arange(-4.0, 8.0):
            line = np.array([low, high])
            panel.plot(line, 10.0 ** (decade / 2) / np.sqrt(line), ":", color="0.75", linewidth=0.8, zorder=0)
        for axis in [panel.xaxis, panel.yaxis]:
            axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
            axis.set_minor_locator(ticker.NullLocator())
        panel.set_xlim(low, high)
        panel.set_ylim(bottom, top)
        panel.set_title(product)
        panel.set_xlabel("seconds")
        panel.set_ylabel("relative root mean square error (%)")
        panel.grid(color="0.92")
        panel.legend(frameon=False)
    figure.suptitle("Benchmark stand: run time against error (dotted: slope -1/2)")
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "peers"))
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "sunfleck"))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--quick", action="store_true", help="few samples, and no directions by LESS: does it work?")
    parser.add_argument("--without", nargs="*", default=[], choices=["less", "mitsuba"])
    arguments = parser.parse_args()
    if not os.path.isdir(STAND):
        raise SystemExit(f"needs the benchmark stand in {os.path.normpath(STAND)}")
    samples, truth, photons, errors = [4, 8, 16, 32], 512, 500_000, [0.02, 0.01, 0.005]
    if arguments.quick:
        samples, truth, photons, errors, arguments.repeats = [2, 4], 32, None, [0.05, 0.03], 1
    with tempfile.TemporaryDirectory() as folder:
        sunfleck = Sunfleck(arguments.program, folder)
        workers = [
            Worker(name, f"{name}_stand.py", folder)
            for name in ["less", "mitsuba"]
            if name not in arguments.without
        ]
        rows = images([sunfleck, *workers], Truth(sunfleck, truth), samples, arguments.repeats)
        less = next((worker for worker in workers if worker.name == "less"), None)
        rows += planes(sunfleck, less, photons, errors, arguments.repeats)
        for worker in workers:
            worker.close()
    summary = summarise(rows)
    write(arguments.out, rows, summary)
    draw(os.path.join(arguments.out, "peers.svg"), summary)
    print(f"\n{'product':22} {'program':14} {'efficiency /s':>14} {'sunfleck over it':>17}")
    for one in summary:
        print(f"{one['product']:22} {one['program']:14} {one['efficiency']:14.4g} {one['ratio']:17.2f}")
    print(f"\npeers.csv, peers_summary.csv and peers.svg in {arguments.out}")


if __name__ == "__main__":
    main()
