"""An LLVM that Mitsuba's compiler works with on this machine."""

import glob
import os
import re
import subprocess
import sys

VARIABLE = "DRJIT_LIBLLVM_PATH"
PLACES = [
    # As the wheel of karellen-llvm-core brings it.
    f"{sys.prefix}/lib/libLLVM*.so*",
    "/usr/lib/*-linux-gnu/libLLVM*.so*",
    "/usr/lib/llvm-*/lib/libLLVM*.so*",
    "/usr/lib64/libLLVM*.so*",
    "/usr/local/lib/libLLVM*.so*",
    "/opt/homebrew/opt/llvm*/lib/libLLVM.dylib",
    "/usr/local/opt/llvm*/lib/libLLVM.dylib",
]

# A rendering that compiles a kernel of each kind.
PROBE = """
import mitsuba as mi
mi.set_variant("llvm_ad_mono")
import drjit as dr
scene = mi.load_dict(mi.cornell_box())
dr.eval(mi.render(scene, spp=1, sensor=mi.load_dict({"type": "perspective", "film": {"type": "hdrfilm", "width": 4, "height": 4}})))
dr.sync_thread()
print("works")
"""


def version(path):
    """Major version of a library by its name: `libLLVM-19.so` and `libLLVM.so.19.1` are 19."""
    numbers = re.findall(r"\d+", os.path.basename(os.path.realpath(path)))
    return int(numbers[0]) if numbers else 0


def works(path):
    """Whether Mitsuba renders with this library, or with the one that it finds itself."""
    environment = {**os.environ, **({VARIABLE: path} if path else {})}
    command = [sys.executable, "-c", PROBE]
    try:
        probe = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return False
    return probe.returncode == 0 and probe.stdout.strip().endswith("works")


def choose():
    """Leaves the variable as it is if it is set or not needed, or names the newest library that works."""
    if os.environ.get(VARIABLE) or works(None):
        return
    found = {os.path.realpath(path) for place in PLACES for path in glob.glob(place)}
    for path in sorted(found, key=version, reverse=True):
        if works(path):
            os.environ[VARIABLE] = path
            return
    tried = ", ".join(sorted(found)) or "none found"
    raise SystemExit(
        f"Mitsuba finds no LLVM that it works with on this machine (tried: {tried}).\n"
        f"Install one of version 17 or newer, such as Debian's libllvm19 or pip's karellen-llvm-core, or set {VARIABLE} to its libLLVM.so"
    )
