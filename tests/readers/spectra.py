"""Reads files of spectra with SPy and pyASDReader and prints what they hold as JSON.

Usage: spectra.py FOLDER; the files are those that `tests/tests/spectrum_files` writes. Exit code 77: a module is missing.
"""

import json
import logging
import os
import sys

try:
    import spectral.io.envi as envi
    from pyASDReader import ASDFile
    from spectral.database.aster import read_aster_file
    from spectral.database.usgs import SampleData, SpectrometerData
except ImportError as error:
    print(error)
    sys.exit(77)

logging.disable(logging.CRITICAL)
folder = sys.argv[1]
path = lambda name: os.path.join(folder, name)

library = envi.open(path("library.hdr"))
aster = read_aster_file(path("ecostress.txt"))
sample = SampleData.read_from_file(path("splib07a_Leaf_ASDFRa_AREF.txt"))
waves = SpectrometerData.read_from_file(path("splib07a_Wavelengths_ASD_0.35-2.5_microns_5_ch.txt"))
asd = ASDFile(path("leaf.asd"))
print(
    json.dumps(
        {
            "envi": {
                "names": library.names,
                "unit": library.bands.band_unit,
                "wavelengths": [float(w) for w in library.bands.centers],
                "spectra": [[float(v) for v in row] for row in library.spectra],
            },
            "ecostress": {"x": aster.x, "y": aster.y, "unit": aster.measurement["y units"]},
            "usgs": {"x": list(waves.values), "y": list(sample.values), "unit": waves.unit},
            "asd": {"x": [float(w) for w in asd.wavelengths], "y": [float(v) for v in asd.reflectance]},
        }
    )
)
