"""Compares the data sets of a sweep with its table, sweep.csv, by xarray.

    python tests/readers/sweeps.py FOLDER PARAMETERS DIMENSIONS

PARAMETERS are the names of the swept parameters, DIMENSIONS those of the points, both with commas. Exit code 77 says that
a module is missing.
"""

import csv
import itertools
import json
import sys
from pathlib import Path

try:
    import netCDF4
    import numpy as np
    import xarray as xr
    import zarr
except ImportError as missing:
    print(f"{missing.name} is missing")
    sys.exit(77)

ENDINGS = ("_deg", "_nm", "_sr", "_m", "_k")


def base(name):
    return next((name.removesuffix(ending) for ending in ENDINGS if name.endswith(ending)), name)


def cell(text):
    """A number or a text as a key."""
    try:
        return float(text)
    except ValueError:
        return text.removeprefix("'")


def expected(folder, parameters):
    """Values and errors by sensor, product, and positions on all axes."""
    with open(folder / "sweep.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    fixed = {"sensor", "product", "unit", "value", "standard_error", "note", "signed_zenith_deg"}
    table = {}
    for row in rows:
        if row["sensor"]:
            axes = {base(key): cell(text) for key, text in row.items() if key not in fixed and text}
            numbers = float(row["value"]), float(row["standard_error"])
            table.setdefault((row["sensor"], row["product"]), {})[frozenset(axes.items())] = numbers
    return table


def compare(dataset, products, parameters, dimensions):
    """Every value of the table is in the data set, and all others are NaN; returns the number of values."""
    count = 0
    for product, values in products.items():
        name = product if product in dataset else f"{product}_mean"
        data, errors = dataset[name], dataset[f"{name}_standard_error"]
        assert list(data.dims[: len(dimensions)]) == dimensions, (data.dims, dimensions)
        assert data.dtype == np.float64
        columns = {}
        for coordinate, points in data.coords.items():
            (dimension,) = points.dims
            stem = next((c for c in ["band", *map(base, parameters)] if coordinate == c), coordinate)
            if stem not in ("wavelength", "bandwidth"):
                columns[stem] = data.dims.index(dimension), points.values.tolist()
        seen = set()
        for index in itertools.product(*map(range, data.shape)):
            key = frozenset((stem, points[index[place]]) for stem, (place, points) in columns.items())
            found = data.values[index], errors.values[index]
            if key in values:
                np.testing.assert_array_equal(found, values[key])
                seen.add(key)
            else:
                assert np.isnan(found).all(), (product, key, found)
        assert len(seen) == len(values), (product, set(values) - seen)
        count += len(seen)
    return count


def main():
    folder, parameters, dimensions = Path(sys.argv[1]), sys.argv[2].split(","), sys.argv[3].split(",")
    table, counts = expected(folder, parameters), {}
    for sensor in {sensor for sensor, _ in table}:
        products = {product: values for (of, product), values in table.items() if of == sensor}
        with xr.open_zarr(folder / f"{sensor}.zarr") as one, xr.open_dataset(folder / f"{sensor}.nc") as other:
            xr.testing.assert_equal(one, other)
            counts[sensor] = compare(one, products, parameters, dimensions)
            assert counts[sensor] == compare(other, products, parameters, dimensions)
            assert one.attrs["Conventions"] == "CF-1.10"
    print(json.dumps(counts))


main()
