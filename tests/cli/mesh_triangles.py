"""mesh_triangles.py FILE...: whether files have the same triangles; prints their number and volume.

Reads binary STL, GLB with nodes and EXT_mesh_gpu_instancing, and 3MF with components, by the words of
their specifications alone.  What a GLB may not have, a reflection among instances, is refused.
"""
import json
import struct
import sys
import xml.etree.ElementTree as tree
import zipfile

import numpy as np

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
NOWHERE = (np.eye(3), np.zeros(3))


def read_stl(path):
    bytes_ = open(path, "rb").read()
    count = struct.unpack_from("<I", bytes_, 80)[0]
    assert len(bytes_) == 84 + 50 * count
    row = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("nothing", "<u2")])
    return np.frombuffer(bytes_, row, count, 84)["corners"].astype(float)


class Glb:
    def __init__(self, path):
        bytes_ = open(path, "rb").read()
        length = struct.unpack_from("<I", bytes_, 12)[0]
        self.json = json.loads(bytes_[20:20 + length])
        self.data = bytes_[28 + length:]

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        number = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        offset = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        numbers = np.frombuffer(self.data, number, width * accessor["count"], offset)
        return numbers.reshape(-1, width)

    def instances(self, node):
        extension = node.get("extensions", {}).get("EXT_mesh_gpu_instancing")
        if not extension:
            return [NOWHERE]
        assert "EXT_mesh_gpu_instancing" in self.json["extensionsRequired"]
        names = extension["attributes"]
        at, turn, scale = (self.accessor(names[n]).astype(float)
                           for n in ("TRANSLATION", "ROTATION", "SCALE"))
        assert scale.min() > 0
        return [(rotation(turn[i]) * scale[i], at[i]) for i in range(len(at))]

    def visit(self, index, turn, at, found):
        node = self.json["nodes"][index]
        at = turn @ np.array(node.get("translation", [0, 0, 0])) + at
        turn = turn @ (rotation(node.get("rotation", [0, 0, 0, 1])) * node.get("scale", [1, 1, 1]))
        assert np.linalg.det(turn) > 0
        if "mesh" in node:
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                points = self.accessor(primitive["attributes"]["POSITION"]).astype(float)
                corners = self.accessor(primitive["indices"]).reshape(-1, 3)
                for own_turn, own_at in self.instances(node):
                    placed = (points @ own_turn.T + own_at) @ turn.T + at
                    found.append(placed[corners])
        for child in node.get("children", []):
            self.visit(child, turn, at, found)


def rotation(quaternion):
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def read_glb(path):
    file, found = Glb(path), []
    for node in file.json["scenes"][0]["nodes"]:
        file.visit(node, *NOWHERE, found)
    return np.concatenate(found)


def transform(text):
    if not text:
        return NOWHERE
    numbers = np.array([float(word) for word in text.split()]).reshape(4, 3)
    assert np.linalg.det(numbers[:3]) > 0
    return numbers[:3].T, numbers[3]


def read_3mf(path):
    model = tree.fromstring(zipfile.ZipFile(path).read("3D/3dmodel.model"))
    objects = {}

    def placed(thing):
        turn, at = transform(thing.get("transform"))
        return objects[thing.get("objectid")] @ turn.T + at

    for item in model.iter(CORE + "object"):
        mesh = item.find(CORE + "mesh")
        if mesh is None:
            parts = [placed(component) for component in item.iter(CORE + "component")]
            objects[item.get("id")] = np.concatenate(parts)
            continue
        points = np.array([[float(v.get(k)) for k in "xyz"] for v in mesh.iter(CORE + "vertex")])
        corners = [[int(t.get(k)) for k in ("v1", "v2", "v3")] for t in mesh.iter(CORE + "triangle")]
        objects[item.get("id")] = points[np.array(corners)]
    return np.concatenate([placed(item) for item in model.iter(CORE + "item")])


def read(path):
    return {"stl": read_stl, "glb": read_glb, "3mf": read_3mf}[path.rsplit(".", 1)[1]](path)


def traits(triangles):
    """Sorted numbers of each triangle, the same for all three of its corners that may come first."""
    chance, found = np.random.default_rng(1), []
    for _ in range(8):
        first, second = triangles @ chance.normal(size=3), triangles @ chance.normal(size=3)
        found.append(np.sort((first * second[:, [1, 2, 0]]).sum(1)))
    return np.array(found)


def volume(triangles):
    cross = np.cross(triangles[:, 1], triangles[:, 2])
    return np.einsum("ij,ij", triangles[:, 0], cross) / 6


files = [read(path) for path in sys.argv[1:]]
wanted = traits(files[0])
for triangles in files[1:]:
    assert len(triangles) == len(files[0])
    assert np.abs(traits(triangles) - wanted).max() < 1e-5 * np.abs(wanted).max()
print(len(files[0]), "%.6g" % volume(files[0]))
