"""Compares GeoTIFF with the ENVI rasters beside them by rasterio (GDAL) and tifffile.

    python tests/readers/geotiff.py FOLDER STEM EPSG NAME,NAME

FOLDER holds STEM.tif, STEM_se.tif, STEM.img and STEM_se.img; EPSG is that of the scene or 0, the names are those of the
bands. Exit code 77 says that a module is missing.
"""

import base64
import json
import sys
import zlib
from pathlib import Path

try:
    import numpy as np
    import imagecodecs  # noqa: F401, tifffile needs it for the predictor of floats
    import rasterio
    import tifffile
except ImportError as missing:
    print(f"{missing.name} is missing")
    sys.exit(77)


def header(path):
    """Keys and values of an ENVI header."""
    pairs = (line.split(" = ", 1) for line in path.read_text().splitlines() if " = " in line)
    return {key: value.strip("{}") for key, value in pairs}


def compare(folder, stem, ending, epsg, names):
    keys = header(folder / f"{stem}{ending}.img.hdr")
    shape = [int(keys[key]) for key in ("bands", "lines", "samples")]
    expected = np.fromfile(folder / f"{stem}{ending}.img", "<f4").reshape(shape)
    expected[expected == -9999] = np.nan
    path = folder / f"{stem}{ending}.tif"
    with rasterio.open(path) as tif:
        read = tif.read()
        assert read.dtype == np.float32
        np.testing.assert_array_equal(read, expected)
        assert list(tif.descriptions) == names, tif.descriptions
        assert all(np.isnan(value) for value in tif.nodatavals)
        mask = tif.read_masks(1) > 0
        np.testing.assert_array_equal(mask, np.isfinite(expected[0]))
        place = keys.get("map info")
        if place:
            _, _, _, west, north, dx, dy = place.split(", ")[:7]
            west, north, dx, dy = map(float, (west, north, dx, dy))
            assert tif.transform == rasterio.Affine(dx, 0, west, 0, -dy, north), tif.transform
        assert (tif.crs.to_epsg() if tif.crs else 0) == epsg, tif.crs
        tags = tif.tags()
        provenance = dict(part.split(": ", 1) for part in keys["description"].split("; ") if ": " in part)
        assert {"hash", "seed", "version", "scene", "product"} <= provenance.keys(), provenance
        recipe = provenance.pop("recipe")
        for key, value in provenance.items():
            assert tags[f"sunfleck_{key}"] == value, (key, tags)
        packed = json.loads(zlib.decompress(base64.b64decode(recipe.removeprefix("zlib:"))))
        assert json.loads(tags["sunfleck_recipe"]) == packed and "Scene(" in packed["scene"], tags
        assert f"{tags['TIFFTAG_IMAGEDESCRIPTION']}; recipe: {recipe}" == keys["description"], tags
        if "wavelength" in keys:
            found = [float(tif.tags(band)["wavelength"]) for band in tif.indexes]
            assert found == [float(nm) for nm in keys["wavelength"].split(",")], found
        tiled = tif.profile["tiled"], tif.block_shapes[0]
        overviews = tif.overviews(1)
        facts = {
            "crs": str(tif.crs),
            "bands": tif.descriptions,
            "units": tif.units,
            "tiles": tif.block_shapes[0],
            "overviews": overviews,
            "compression": tif.profile["compress"],
            "gdal": rasterio.__gdal_version__,
        }
        large = max(shape[1:]) > 256
        assert tiled == (True, (256, 256)), tiled
        assert bool(overviews) == large, overviews
        # A cloud-optimised file has its directories in front and its smallest overview first.
        assert tif.tags(1, ns="TIFF").get("IFD_OFFSET") in (None, "8", "16")
    with tifffile.TiffFile(path) as tif:
        pages = tif.series[0].levels
        read = tif.asarray()
        np.testing.assert_array_equal(read.reshape(shape), expected)
        assert [page.shape[-2:] for page in pages] == [
            tuple(-(-length // 2**level) for length in shape[1:]) for level in range(len(pages))
        ]
        starts = [page.keyframe.dataoffsets[0] for page in pages]
        assert starts == sorted(starts, reverse=True), starts
        assert tif.pages[0].offset in (8, 16)
        assert tif.pages[0].predictor == 3
        if len(pages) > 1:
            even = expected[:, : shape[1] // 2 * 2, : shape[2] // 2 * 2].astype(float)
            blocks = even.reshape(shape[0], shape[1] // 2, 2, shape[2] // 2, 2)
            with np.errstate(all="ignore"):
                means = np.nansum(blocks, (2, 4)) / np.isfinite(blocks).sum((2, 4))
            half = pages[1].asarray().reshape(shape[0], *pages[1].shape[-2:])
            half = half[:, : shape[1] // 2, : shape[2] // 2]
            np.testing.assert_allclose(half, means, rtol=1e-6)
    return facts


def main():
    folder, stem, epsg, names = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4]
    names = names.split(",")
    values = compare(folder, stem, "", epsg, names)
    errors = compare(folder, stem, "_se", epsg, [f"{name}_se" for name in names] + ["coverage"])
    print(json.dumps({"values": values, "errors": errors}))


main()
