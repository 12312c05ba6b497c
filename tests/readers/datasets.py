"""Compares Zarr stores and NetCDF files with the files beside them by xarray, netCDF4, scipy and GDAL (rasterio).

    python tests/readers/datasets.py FOLDER EPSG

FOLDER holds the results of a run in the formats Zarr, NetCdf and Envi; EPSG is that of the scene or 0. Exit code 77 says
that a module is missing.
"""

import csv
import json
import sys
import warnings
from pathlib import Path

try:
    import netCDF4
    import numpy as np
    import rasterio
    import scipy.io
    import xarray as xr
    import zarr
    from rasterio.warp import transform
except ImportError as missing:
    print(f"{missing.name} is missing")
    sys.exit(77)

warnings.filterwarnings("ignore", category=rasterio.errors.NotGeoreferencedWarning)

# Words of names of axes and the units in UDUNITS.
UNITS = {"deg": "degree", "m": "m", "nm": "nm", "sr": "sr", "k": "K"}


def rasters(folder, product):
    """Values, standard errors and coverage of an image, from its ENVI rasters."""
    pair = [folder / name for name in product["files"] if name.endswith(".img")]
    found = []
    for path in sorted(pair, key=lambda path: path.stem.endswith("_se")):
        lines = Path(f"{path}.hdr").read_text().splitlines()
        keys = dict(line.split(" = ", 1) for line in lines if " = " in line)
        kind = {"4": "<f4", "1": "u1"}[keys["data type"]]
        shape = [int(keys[key]) for key in ("bands", "lines", "samples")]
        values = np.fromfile(path, kind).reshape(shape)
        if kind == "u1":
            values = np.where(values == 0, np.nan, values).astype("<f4")
        else:
            values[values == -9999] = np.nan
        found.append((values, keys))
    (values, keys), (errors, _) = found
    return values, errors[:-1], errors[-1], keys


def numbers(values):
    return np.array([np.nan if value is None else value for value in values], float)


def same(found, expected):
    found = np.asarray(found)
    assert found.dtype == expected.dtype, (found.dtype, expected.dtype)
    np.testing.assert_array_equal(found, expected)


def check_axes(data, product):
    """Each axis of the summary is a coordinate of the array."""
    axes = {name: points for name, points in product["axes"].items()}
    for several in product.get("coordinates", {}).values():
        axes.update(several)
    for name, points in axes.items():
        if not points:
            continue
        stem, _, ending = name.rpartition("_")
        unit = UNITS.get(ending) if stem else None
        base = stem if unit else name
        found = [c for c in data.coords if c == base or c.startswith(f"{base}_")]
        texts = isinstance(points[0], str)
        values = np.array(points) if texts else numbers(points)
        match = [c for c in found if data.coords[c].shape == values.shape and (data.coords[c].values == values).all()]
        assert match, (name, found, data)
        if not texts:
            assert data.coords[match[0]].attrs["units"] == (unit or "1"), (name, data.coords[match[0]])


def check(dataset, folder, name, summary):
    attributes = dataset.attrs
    assert attributes["Conventions"] == "CF-1.10"
    for key in ("hash", "version"):
        assert attributes[key] == summary[key], (key, attributes)
    assert attributes["seed"] == str(summary["seed"])
    for key, product in summary["sensors"][name].items():
        data, errors = dataset[key], dataset[f"{key}_standard_error"]
        assert f"{key}_standard_error" in data.attrs["ancillary_variables"].split()
        assert data.attrs["units"] == product["unit"] == errors.attrs["units"]
        images = [file for file in product["files"] if file.endswith(".img")]
        table = (dataset[f"{key}_mean"], dataset[f"{key}_mean_standard_error"]) if images else (data, errors)
        for array, values in zip(table, ("values", "standard_error")):
            same(array, numbers(product[values]).reshape([size for size in product["shape"]]))
        check_axes(table[0], product)
        if images:
            values, se, coverage, keys = rasters(folder, product)
            same(data, values)
            same(errors, se)
            same(dataset[f"{key}_coverage"], coverage)
            place = keys.get("map info")
            if place:
                west, north, dx, dy = map(float, place.split(", ")[3:7])
                _, rows, columns = values.shape
                x, y = data.dims[2], data.dims[1]
                np.testing.assert_allclose(dataset[x], west + dx * (np.arange(columns) + 0.5), rtol=1e-15)
                np.testing.assert_allclose(dataset[y], north - dy * (np.arange(rows) + 0.5), rtol=1e-15)
                assert dataset[x].attrs["standard_name"] == "projection_x_coordinate"
                assert dataset[y].attrs["units"] == "m"
        for file in product["files"]:
            if file.endswith(".csv"):
                check_csv(folder / file, table)
        if "band" in product["axes"]:
            bands = product["axes"]["band"]
            known = [summary["wavelengths_nm"][summary["bands"].index(band)] for band in bands]
            wavelength = [c for c in table[0].coords if c.startswith("wavelength")]
            same(table[0].coords[wavelength[0]], np.array(known, float))


def check_csv(path, table):
    """Values of a table and every second column of its file."""
    with open(path, newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    header, rows = rows[0], rows[1:]
    columns = [index for index, name in enumerate(header) if f"{name}_se" in header]
    read = np.array([[float(row[index]) for index in columns] for row in rows])
    errors = np.array([[float(row[index + 1]) for index in columns] for row in rows])
    same(np.asarray(table[0]).reshape(read.shape), read)
    same(np.asarray(table[1]).reshape(read.shape), errors)


def check_gdal(path, folder, name, summary, epsg):
    """Every image as GDAL reads it; returns what it says of them."""
    facts = {}
    for key, product in summary["sensors"][name].items():
        if not any(file.endswith(".img") for file in product["files"]):
            continue
        values, _, _, keys = rasters(folder, product)
        quoted = f'NETCDF:"{path}":{key}' if path.suffix == ".nc" else f'ZARR:"{path}":/{key}'
        with rasterio.open(quoted) as raster:
            read = raster.read()
            # Where lengths are no metres, GDAL begins with the lowest row, and says so.
            same(read[:, ::-1] if raster.transform.e > 0 else read, values)
            place = keys.get("map info")
            if place:
                west, north, dx, dy = map(float, place.split(", ")[3:7])
                expected = rasterio.Affine(dx, 0, west, 0, -dy, north)
                assert raster.transform.almost_equals(expected, 1e-6), (quoted, raster.transform)
                assert bool(raster.crs) == bool(epsg), (quoted, raster.crs)
                if epsg:
                    # Texts differ in names; places on the earth do not.
                    ways = [raster.crs, rasterio.CRS.from_epsg(epsg)]
                    places = [transform(way, "EPSG:4326", [west, west + dx], [north, north - dy]) for way in ways]
                    np.testing.assert_allclose(*places, rtol=0, atol=1e-9)
            facts[quoted.split(":")[-1]] = {"crs": str(raster.crs), "bands": raster.count, "driver": raster.driver}
    return facts


def main():
    folder, epsg = Path(sys.argv[1]), int(sys.argv[2])
    summary = json.loads((folder / "summary.json").read_text())
    facts = {"xarray": xr.__version__, "zarr": zarr.__version__, "netCDF4": netCDF4.__version__}
    facts["gdal"] = rasterio.__gdal_version__
    for name in summary["sensors"]:
        files = {file for product in summary["sensors"][name].values() for file in product["files"]}
        store, file = (folder / next(file for file in files if file.endswith(end)) for end in (".zarr", ".nc"))
        for consolidated in (True, False):
            check(xr.open_zarr(store, consolidated=consolidated), folder, name, summary)
        for engine in ("netcdf4", "scipy"):
            with xr.open_dataset(file, engine=engine) as dataset:
                check(dataset, folder, name, summary)
        with xr.open_dataset(file) as one, xr.open_zarr(store) as other:
            xr.testing.assert_equal(one, other)
            assert one.sizes == other.sizes
            facts[name] = {key: f"{data.dims} {data.dtype}" for key, data in one.variables.items()}
        with netCDF4.Dataset(file) as dataset:
            assert dataset.data_model == "NETCDF3_64BIT_OFFSET", dataset.data_model
        scipy.io.netcdf_file(file, mmap=False).close()
        facts[f"{name} by GDAL"] = [check_gdal(path, folder, name, summary, epsg) for path in (store, file)]
    print(json.dumps(facts))


main()
