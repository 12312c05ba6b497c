"""Scenes and files that tests share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import sunfleck as sf

REPOSITORY = Path(os.environ.get("SUNFLECK_REPOSITORY", Path(__file__).resolve().parents[3]))


@pytest.fixture
def stand() -> sf.Scene:
    """A few tilted squares above soil."""
    return sf.parse(STAND)


STAND = """// A small scene.
Scene(
    format: 1,
    title: "Squares",
    params: { "rho": 0.1 },
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)], // two
    materials: {
        "leaf": Leaf(reflectance: Bands(["=rho", 0.45]), transmittance: Bands([0.03, 0.4])),
        "soil": Lambertian(reflectance: Bands([0.12, 0.25])),
    },
    meshes: {
        "crown": Crown(
            shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0),
            base_m: 1.0,
            leaf_area_m2: 8.0,
            leaf: Disc(radius_m: 0.1),
            leaf_material: "leaf",
            seed: 1,
        ),
    },
    terrain: Plane(size_m: (8.0, 6.0), material: "soil"),
    instances: [List(of: "crown", at_m: [(2.0, 2.0, 0.0), (6.0, 3.0, 0.0)])],
    // From the south-east.
    sun: (zenith_deg: 30.0, azimuth_deg: 135.0, irradiance: Constant(1.5)),
    sensors: {
        "map": Orthographic(size_px: (16, 12), cover: WholeScene, samples_per_px: 16),
        "plane": Directions(views: PrincipalPlane(step_deg: 15.0), until: Samples(512)),
        "balance": Photons(per_m2: 200.0, measure: [Albedo]),
    },
)
"""
