"""Compares sunfleck, LESS 3.0.1, Mitsuba 3.9.1 and Embree 4.3.3 on the same scenes.

    python tools/peers/compare.py [--out DIR] [--scenes NAME ..] [--without NAME ..] [--repeats N] [--quick]

On one machine, in one run, interleaved. Writes peers.csv (each measurement), peers_summary.csv, peers_directions.csv
(each direction) and peers.svg; prints the summary as a table. README.md says what is measured and how.
"""

import argparse
import csv
import os
import platform
import statistics
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from errors import DirectionErrors, ImageError, Truth, direction_errors, samples_times_variance
from programs import embree
from programs.measurement import Measurement, Worker
from programs.sunfleck import Sunfleck
from scenes import SCENES, Tools
from scenes.scene import BANDS_NM, VIEW_ZENITHS_DEG

ROOT = Path(__file__).resolve().parent.parent.parent
# Wraps of LESS: its default, and the fewest with which the values are the same.
DEFAULT_WRAPS, FEWEST_WRAPS = 100, 10
# An image with more than this bias shows another scene.
LARGEST_BIAS = 0.05


@dataclass(frozen=True)
class Effort:
    """Numbers of samples and runs."""

    samples: list[int]
    truth_samples: int
    packets: int
    photons: int
    runs: int


FULL = {
    "stand": Effort([4, 8, 16, 32], 256, 65_536, 500_000, 8),
    "spruces": Effort([4, 16], 128, 65_536, 500_000, 6),
    "het01": Effort([4, 16], 128, 65_536, 500_000, 6),
}
QUICK = Effort([2, 4], 16, 8_192, 500_000, 2)


@dataclass
class Results:
    """Rows of the three tables."""

    measurements: list[dict] = field(default_factory=list)
    summary: list[dict] = field(default_factory=list)
    directions: list[dict] = field(default_factory=list)

    def add_measurement(self, scene: str, product: str, program: str, count: int, seed: int, one: Measurement) -> None:
        mean = float(np.nanmean(one.values))
        self.measurements.append(
            dict(scene=scene, product=product, program=program, count=count, seed=seed, seconds=one.seconds,
                 rays=one.rays or "", mean=mean)
        )
        print(f"  {program:20} {product:11} {count:>8} seed {seed}: {one.seconds:8.2f} s, mean {mean:.5f}", flush=True)

    def add_summary(self, scene: str, product: str, program: str, count: int, seconds: list[float], noise: float,
                    bias: float, bias_error: float, rays: int | None) -> None:
        median = statistics.median(seconds)
        self.summary.append(
            dict(scene=scene, product=product, program=program, count=count, seconds=median, seconds_min=min(seconds),
                 seconds_max=max(seconds), noise=noise, bias=bias, bias_error=bias_error,
                 variance_times_count=noise**2 * count, rays=rays or "", efficiency=1.0 / (noise**2 * median))
        )


def main() -> None:
    arguments = parse_arguments()
    tools = Tools(arguments.program.resolve(), ROOT)
    if not tools.data.is_dir():
        raise SystemExit(f"needs the scenes' data in {tools.data}")
    results = Results()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        loop = None if "embree" in arguments.without else embree.compile_program(folder)
        for scene in arguments.scenes:
            effort = QUICK if arguments.quick else FULL[scene]
            prepared = SCENES[scene](tools)
            prepared.save(folder / scene)
            print(f"{prepared.title}: {sum(map(len, prepared.parts.values()))} triangles, {len(prepared.places)} times")
            has_native = prepared.native is not None
            del prepared
            compare_images(results, scene, effort, arguments, folder / scene, loop, has_native)
            compare_directions(results, scene, effort, arguments, folder / scene, has_native)
    add_ratios(results.summary)
    settings = f"{processor()}, {len(os.sched_getaffinity(0))} threads"
    write(arguments.out, results, settings)
    print_table(results.summary)


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "peers", help="folder for the results")
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "sunfleck")
    parser.add_argument("--scenes", nargs="+", choices=list(SCENES), default=list(SCENES))
    parser.add_argument("--without", nargs="+", choices=["less", "mitsuba", "embree"], default=[])
    parser.add_argument("--repeats", type=int, default=2, help="images of each number of samples, at least 2")
    parser.add_argument("--quick", action="store_true", help="few samples: shows that all works, no figures to quote")
    arguments = parser.parse_args()
    if arguments.repeats < 2:
        parser.error("noise needs at least 2 repeats")
    return arguments


def sunflecks(arguments: argparse.Namespace, folder: Path, has_native: bool) -> list[Sunfleck]:
    """sunfleck on the triangles of all, and on its own mesh."""
    programs = [Sunfleck("sunfleck", arguments.program.resolve(), folder)]
    if has_native:
        programs.append(Sunfleck("sunfleck, own mesh", arguments.program.resolve(), folder, is_native=True))
    return programs


def compare_images(results: Results, scene: str, effort: Effort, arguments: argparse.Namespace, folder: Path,
                   loop: Path | None, has_native: bool) -> None:
    programs: list = sunflecks(arguments, folder, has_native)
    halves = [programs[0].measure("image", effort.truth_samples // 2, seed).values for seed in (1001, 1002)]
    truth = Truth(*halves)
    if "less" not in arguments.without:
        programs.append(Worker("LESS", "less", folder, ["0"]))
    if loop is not None:
        programs.append(embree.Embree(loop, folder))
    if "mitsuba" not in arguments.without:
        programs.append(Worker("Mitsuba", "mitsuba", folder))
    found: dict[tuple[str, int], list[Measurement]] = {}
    for seed in range(1, arguments.repeats + 1):
        for count in effort.samples:
            for program in programs:
                # Recording its kernels takes long: every second number of samples is enough.
                if program.name == "Mitsuba" and count not in effort.samples[1::2]:
                    continue
                one = program.measure("image", count, seed)
                results.add_measurement(scene, "image", program.name, count, seed, one)
                found.setdefault((program.name, count), []).append(one)
    for program in programs:
        program.close()
    noises: dict[str, dict[int, float]] = {}
    for (name, count), runs in found.items():
        error = truth.error([one.values for one in runs])
        check_picture(scene, name, error)
        seconds = [one.seconds for one in runs]
        noises.setdefault(name, {})[count] = error.noise
        results.add_summary(
            scene, "image", name, count, seconds, error.noise, error.bias, error.detectable_bias, runs[0].rays
        )
    for name, noise in noises.items():
        constant, exponent = samples_times_variance(list(noise), list(noise.values()))
        print(f"  {name}: noise² of a pixel is {constant:.3f} / N; fitted exponent {exponent:.2f}")


def check_picture(scene: str, name: str, error: ImageError) -> None:
    """Ends the run if a program draws another scene; sunfleck's own mesh may differ from the triangles."""
    if name != "sunfleck, own mesh" and error.bias > LARGEST_BIAS + error.detectable_bias:
        percent = f"{100 * error.bias:.1f} %"
        raise SystemExit(f"{name} draws another picture of {scene}: its pixels differ by {percent} beyond noise")


def compare_directions(results: Results, scene: str, effort: Effort, arguments: argparse.Namespace, folder: Path,
                       has_native: bool) -> None:
    programs: list = sunflecks(arguments, folder, has_native)
    counts = {program.name: effort.packets for program in programs}
    if "less" not in arguments.without:
        for wraps in (FEWEST_WRAPS, DEFAULT_WRAPS):
            programs.append(Worker(f"LESS, {wraps} wraps", "less", folder, [str(wraps)]))
            counts[programs[-1].name] = effort.photons
    found: dict[str, list[Measurement]] = {program.name: [] for program in programs}
    for seed in range(1, effort.runs + 1):
        for program in programs:
            # The values are those of fewer wraps: two runs are enough to time it.
            if program.name == f"LESS, {DEFAULT_WRAPS} wraps" and seed > 2:
                continue
            one = program.measure("directions", counts[program.name], seed)
            results.add_measurement(scene, "directions", program.name, counts[program.name], seed, one)
            found[program.name].append(one)
    for program in programs:
        program.close()
    reference = np.array([one.values for one in found["sunfleck"]])
    for name, runs in found.items():
        values = np.array([one.values for one in runs])
        if name == f"LESS, {DEFAULT_WRAPS} wraps":
            fewest = np.array([one.values for one in found[f"LESS, {FEWEST_WRAPS} wraps"]])
            difference = float(np.max(np.abs(values / fewest[: len(values)] - 1.0)))
            print(f"  LESS with {DEFAULT_WRAPS} and {FEWEST_WRAPS} wraps: values differ by at most {difference:.1e}")
            values = fewest
        errors = direction_errors(values, reference)
        add_directions(results, scene, name, counts[name], [one.seconds for one in runs], errors, values, runs[0].rays)


def add_directions(results: Results, scene: str, name: str, count: int, seconds: list[float], errors: DirectionErrors,
                   values: np.ndarray, rays: int | None) -> None:
    for band, label in enumerate(BANDS_NM):
        results.add_summary(
            scene, f"directions, {label}", name, count, seconds, float(errors.noise()[band]),
            float(errors.mean_bias[band]), float(errors.mean_bias_error[band]), rays,
        )
        for view, zenith in enumerate(VIEW_ZENITHS_DEG):
            results.directions.append(
                dict(scene=scene, program=name, band=label, view_zenith_deg=zenith,
                     brf=float(values[:, view, band].mean()), count=count,
                     variance_times_count=float(errors.variance[view, band] * count),
                     bias=float(errors.bias[view, band]), bias_error=float(errors.bias_error[view, band]))
            )


def add_ratios(summary: list[dict]) -> None:
    """Adds each row's efficiency relative to sunfleck's: median over the numbers of samples."""
    def efficiency(row: dict, program: str) -> float:
        of_program = [
            other["efficiency"] for other in summary
            if (other["scene"], other["product"], other["program"]) == (row["scene"], row["product"], program)
        ]
        return statistics.median(of_program)

    for row in summary:
        row["sunfleck_over_it"] = efficiency(row, "sunfleck") / efficiency(row, row["program"])


def processor() -> str:
    """Name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def write(folder: Path, results: Results, settings: str) -> None:
    from chart import draw

    folder.mkdir(parents=True, exist_ok=True)
    tables = {"peers": results.measurements, "peers_summary": results.summary, "peers_directions": results.directions}
    for name, rows in tables.items():
        with (folder / f"{name}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
    draw(folder / "peers.svg", results.summary, settings)
    print(f"\npeers.csv, peers_summary.csv, peers_directions.csv and peers.svg in {folder}\n")


def print_table(summary: list[dict]) -> None:
    """The summary as a table of Markdown."""
    columns = ["scene", "product", "program", "samples", "seconds", "noise", "bias", "noise² x samples", "M rays/s"]
    columns.append("efficiency of sunfleck over it")
    print(f"| {' | '.join(columns)} |")
    print("|---" * len(columns) + "|")
    for row in summary:
        is_reference = row["program"] == "sunfleck" and row["product"] != "image"
        bias = f"{100 * row['bias']:.2f} (± {100 * row['bias_error']:.2f}) %"
        cells = [
            row["scene"], row["product"], row["program"], str(row["count"]), f"{row['seconds']:.2f}",
            f"{100 * row['noise']:.2f} %", "reference" if is_reference else bias, f"{row['variance_times_count']:.3g}",
            f"{row['rays'] / row['seconds'] / 1e6:.2f}" if row["rays"] else "", f"{row['sunfleck_over_it']:.2f}",
        ]
        print(f"| {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
