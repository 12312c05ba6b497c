"""What a program is asked for, and processes that answer."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

PEERS = Path(__file__).resolve().parent.parent


@dataclass
class Measurement:
    # Of the transport alone: no reading, tree building or compilation.
    seconds: float
    # Reflectance factors; "image": shape [row from the north, column from the west], near infrared;
    # "directions": shape [view, band]. NaN where the program has no value.
    values: np.ndarray
    # Rays that were traced, where the program says so.
    rays: int | None = None


class Worker:
    """A program in a process of its own that keeps a scene between measurements."""

    def __init__(self, name: str, module: str, scene: Path, options: list[str] | None = None):
        self.name = name
        self.folder = scene
        self.log = scene / f"{name}.log"
        command = [sys.executable, "-m", f"programs.{module}", str(scene), *(options or [])]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log.open("w"), text=True, cwd=PEERS
        )
        assert self.process.stdin and self.process.stdout, "both are pipes"
        self.orders, self.answers = self.process.stdin, self.process.stdout

    def measure(self, product: str, count: int, seed: int) -> Measurement:
        file = self.folder / f"{self.name}.npy"
        print(product, count, seed, file, sep="\t", file=self.orders, flush=True)
        answer = self.answers.readline()
        if not answer:
            end = "\n".join(self.log.read_text().splitlines()[-8:])
            raise SystemExit(f"{self.name} ended:\n{end}")
        return Measurement(json.loads(answer)["seconds"], np.load(file))

    def close(self) -> None:
        self.orders.close()
        self.process.wait()


def serve(measure: Callable[[str, int, int], Measurement]) -> None:
    """Answers the orders of a `Worker` until its input ends."""
    answers = os.fdopen(os.dup(1), "w")
    # Output of libraries must not mix with the answers.
    os.dup2(2, 1)
    for line in sys.stdin:
        product, count, seed, file = line.rstrip("\n").split("\t")
        measurement = measure(product, int(count), int(seed))
        np.save(file, measurement.values)
        print(json.dumps({"seconds": measurement.seconds}), file=answers, flush=True)
