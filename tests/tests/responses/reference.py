"""Writes reference.json: means over bands with the curves of the Python package pyrsr 0.8.0, by numpy's trapezoidal rule.

    pip install pyrsr==0.8.0 numpy
    python reference.py

Each band: the mean of 0.05 + 0.4 / (1 + exp(-(nm - 715) / 12)), known at whole nanometres; the same weighted with the
irradiance of ASTM G173 too; that irradiance.
"""

import json
from pathlib import Path

import numpy as np
from pyrsr import RSR

HERE = Path(__file__).parent
SPECTRAL = HERE.parent.parent.parent / "engine" / "src" / "spectral"
SENSORS = {
    "Sentinel-2A MSI": ("Sentinel-2A", "MSI"),
    "Sentinel-2B MSI": ("Sentinel-2B", "MSI"),
    "Landsat 8 OLI": ("Landsat-8", "OLI_TIRS"),
}

irradiance = np.array((SPECTRAL / "astm_g173_direct.txt").read_text().split(), float)
wavelengths = np.concatenate([
    280 + 0.5 * np.arange(240), np.arange(400, 1701), [1702], 5.0 * np.arange(341, 801)
])

reference = {}
for sensor, (satellite, instrument) in SENSORS.items():
    curves = RSR(satellite=satellite, sensor=instrument, no_thermal=True, no_pan=False)
    grid = np.asarray(curves.rsrs_wvl, float)
    nm = np.arange(grid[0] - 1, grid[-1] + 2)
    sun = np.interp(nm, wavelengths, irradiance)
    spectrum = 0.05 + 0.4 / (1 + np.exp(-(nm - 715) / 12))
    bands = {}
    for band in curves.bands:
        # Noise below 0, in Landsat 8's B2 and B9, is no response.
        response = np.interp(nm, grid, np.maximum(curves[band], 0.0), left=0.0, right=0.0)
        response[~np.isin(nm, grid)] = 0.0
        mean = lambda values, weights: np.trapezoid(values * weights, nm) / np.trapezoid(weights, nm)
        numbers = [mean(spectrum, response), mean(spectrum, response * sun), mean(sun, response)]
        bands[f"B{band}"] = [float(f"{number:.13g}") for number in numbers]
    reference[sensor] = bands
(HERE / "reference.json").write_text(json.dumps(reference, indent=1) + "\n")
