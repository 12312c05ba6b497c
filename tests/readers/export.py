"""Reads exported scenes by other programs and prints what they hold.

    python tests/readers/export.py gltf|ply|las FILE

Prints JSON: number of triangles or points, area, bounds and mean place, in coordinates of the local frame, z up. Exit code 77
says that a module is missing.
"""

import json
import struct
import sys

try:
    import numpy as np

    if sys.argv[1] == "gltf":
        import trimesh
    elif sys.argv[1] == "ply":
        import trimesh
        from plyfile import PlyData
    else:
        import laspy
        import lazrs
        import pyproj  # laspy reads coordinate reference systems by it
except ImportError as missing:
    print(f"{missing.name} is missing")
    sys.exit(77)


def facts(triangles):
    """Facts of triangles, shape [triangles, 3 corners, 3 axes]."""
    edges = triangles[:, 1:] - triangles[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    areas = 0.5 * np.linalg.norm(normals, axis=1)
    middles = triangles.mean(1)
    corners = triangles.reshape(-1, 3)
    return {
        "count": len(triangles),
        "area": areas.sum(),
        "mean": list((areas[:, None] * middles).sum(0) / areas.sum()),
        # Twice the sum of the vectors of area: turned triangles would change it.
        "normal": list(normals.sum(0)),
        "low": list(corners.min(0)),
        "high": list(corners.max(0)),
    }


def z_up(points):
    """Places with z up of places with y up."""
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([x, -z, y], -1)


def instanced(path):
    """Triangles of a glTF file whose nodes have EXT_mesh_gpu_instancing, by its specification."""
    data = open(path, "rb").read()
    if data[:4] == b"glTF":
        length = struct.unpack("<I", data[12:16])[0]
        document, binary = json.loads(data[20 : 20 + length]), data[20 + length + 8 :]
    else:
        document = json.loads(data)
        binary = open(path.with_suffix(".bin"), "rb").read()

    def read(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        values = np.frombuffer(binary, kind, accessor["count"] * width, view["byteOffset"])
        return values.reshape(-1, width).astype(values.dtype if kind == "<u4" else float)

    def triangles(mesh):
        parts = document["meshes"][mesh]["primitives"]
        return np.concatenate([read(p["attributes"]["POSITION"])[read(p["indices"])[:, 0]].reshape(-1, 3, 3) for p in parts])

    def turn(rotation):
        x, y, z, w = rotation
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )

    root = document["nodes"][0]
    found = []
    for child in root["children"]:
        node = document["nodes"][child]
        shape = triangles(node["mesh"])
        if "extensions" in node:
            names = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
            places, turns, scales = (read(names[name]) for name in ("TRANSLATION", "ROTATION", "SCALE"))
        else:
            places = [node.get("translation", (0, 0, 0))]
            turns = [node.get("rotation", (0, 0, 0, 1))]
            scales = [node.get("scale", (1, 1, 1))]
        for place, rotation, scale in zip(places, turns, scales):
            found.append((shape * scale) @ turn(rotation).T + place)
    world = np.concatenate(found) @ turn(root["rotation"]).T + root["translation"]
    return z_up(world), document


def read_gltf(path):
    triangles, document = instanced(path)
    result = facts(triangles)
    result["origin"] = document["nodes"][0]["extras"]["origin_m"]
    result["generator"] = document["asset"]["generator"]
    if "extensionsRequired" not in document:
        # trimesh does not know the extension.
        scene = trimesh.load(path)
        mesh = scene.to_mesh() if hasattr(scene, "to_mesh") else scene.dump(concatenate=True)
        result["trimesh"] = facts(z_up(np.asarray(mesh.triangles)))
        colours = [g.visual.material.baseColorFactor for g in scene.geometry.values()]
        assert all(colour is not None for colour in colours), colours
    return result


def read_ply(path):
    ply = PlyData.read(path)
    corners = np.stack([ply["vertex"][axis] for axis in "xyz"], -1).astype(float)
    faces = np.stack(ply["face"]["vertex_indices"])
    result = facts(corners[faces])
    result["materials"] = np.bincount(ply["face"]["material"]).tolist()
    result["comments"] = [str(comment) for comment in ply.comments]
    normals = np.stack([ply["vertex"][axis] for axis in ("nx", "ny", "nz")], -1).astype(float)
    edges = corners[faces[:, 1:]] - corners[faces[:, :1]]
    outwards = np.cross(edges[:, 0], edges[:, 1])
    doubled = np.linalg.norm(outwards, axis=1)
    lengths = np.linalg.norm(np.roll(corners[faces], 1, axis=1) - corners[faces], axis=2)
    # Corners are rounded to float32, which turns a triangle by that over its height; one without area has any normal.
    has_area = doubled > 0
    unit = outwards[has_area] / doubled[has_area, None]
    turned = np.linalg.norm(normals[faces[:, 0]][has_area] - unit, axis=1)
    heights = (doubled / lengths.max(1))[has_area]
    assert (turned * heights < 4 * np.finfo(np.float32).eps * np.abs(corners).max()).all(), turned.max()
    mesh = trimesh.load(path, process=False)
    result["trimesh"] = facts(np.asarray(mesh.triangles))
    assert (mesh.visual.vertex_colors[:, :3] == np.stack([ply["vertex"][c] for c in ("red", "green", "blue")], -1)).all()
    return result


def read_las(path):
    with laspy.open(path) as file:
        header, las = file.header, file.read()
    points = np.stack([las.x, las.y, las.z], -1)
    crs = header.parse_crs() if any(v.record_id == 2112 and b"PROJCS" in v.record_data_bytes() for v in header.vlrs) else None
    return {
        "count": len(points),
        "declared": header.point_count,
        "mean": list(points.mean(0)),
        "low": list(points.min(0)),
        "high": list(points.max(0)),
        "header_low": list(header.mins),
        "header_high": list(header.maxs),
        "version": str(header.version),
        "format": header.point_format.id,
        "classes": {str(k): int(n) for k, n in zip(*np.unique(np.asarray(las.classification), return_counts=True))},
        "kinds": {str(k): int(n) for k, n in zip(*np.unique(np.asarray(las.user_data), return_counts=True))},
        "epsg": crs.to_epsg() if crs else None,
        "lazrs": lazrs.__name__,
    }


def main():
    from pathlib import Path

    read = {"gltf": read_gltf, "ply": read_ply, "las": read_las}[sys.argv[1]]
    print(json.dumps(read(Path(sys.argv[2])), default=float))


main()
