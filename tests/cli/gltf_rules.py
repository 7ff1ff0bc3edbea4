"""gltf_rules.py FILE.glb...: whether files keep the rules of glTF 2.0 and of its extensions; also what tests read GLB by.

The rules are those of the specifications of Khronos, as its validator applies them to what such files have.
"""
import json
import struct
import sys

import numpy as np

NUMBERS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
INFINITE = float("inf")
# Extensions of materials: each field with the least and the greatest value of its numbers.
FIELDS = {
    "KHR_materials_anisotropy": {"anisotropyStrength": (0, 1), "anisotropyRotation": (-INFINITE, INFINITE)},
    "KHR_materials_clearcoat": {"clearcoatFactor": (0, 1), "clearcoatRoughnessFactor": (0, 1)},
    "KHR_materials_emissive_strength": {"emissiveStrength": (0, INFINITE)},
    "KHR_materials_ior": {"ior": (1, INFINITE)},
    "KHR_materials_iridescence": {"iridescenceFactor": (0, 1), "iridescenceIor": (1, INFINITE),
                                  "iridescenceThicknessMinimum": (0, INFINITE),
                                  "iridescenceThicknessMaximum": (0, INFINITE)},
    "KHR_materials_sheen": {"sheenColorFactor": (0, 1), "sheenRoughnessFactor": (0, 1)},
    "KHR_materials_specular": {"specularFactor": (0, 1)},
    "KHR_materials_transmission": {"transmissionFactor": (0, 1)},
    "KHR_materials_volume": {"thicknessFactor": (0, INFINITE), "attenuationDistance": (1e-300, INFINITE),
                             "attenuationColor": (0, 1)},
}
COLORS = {"attenuationColor", "sheenColorFactor"}


class Glb:
    """A file: its JSON, and accessors as arrays."""

    def __init__(self, path):
        bytes_ = open(path, "rb").read()
        magic, version, length = struct.unpack_from("<4sII", bytes_)
        assert magic == b"glTF" and version == 2 and length == len(bytes_)
        size, kind = struct.unpack_from("<I4s", bytes_, 12)
        assert kind == b"JSON" and size % 4 == 0
        self.json = json.loads(bytes_[20:20 + size])
        data_size, kind = struct.unpack_from("<I4s", bytes_, 20 + size)
        self.data = bytes_[28 + size:]
        assert kind == b"BIN\0" and data_size == len(self.data)

    def all(self, kind):
        return self.json.get(kind, [])

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        start = accessor.get("byteOffset", 0)
        number, width = np.dtype(NUMBERS[accessor["componentType"]]), WIDTHS[accessor["type"]]
        size = number.itemsize * width * accessor["count"]
        assert start + size <= view["byteLength"] and (view.get("byteOffset", 0) + start) % number.itemsize == 0
        assert view.get("byteOffset", 0) + view["byteLength"] <= len(self.data)
        numbers = np.frombuffer(self.data, number, width * accessor["count"], view.get("byteOffset", 0) + start)
        return numbers.reshape(-1, width)

    def material(self, name):
        found = [m for m in self.json["materials"] if m["name"] == name]
        assert len(found) == 1, name
        return found[0]


def check_accessors(file):
    for index, accessor in enumerate(file.all("accessors")):
        numbers = file.accessor(index)
        assert accessor["count"] > 0 and np.isfinite(numbers).all()
        for bound, found in (("min", numbers.min(0)), ("max", numbers.max(0))):
            assert bound not in accessor or np.allclose(accessor[bound], found, rtol=1e-6, atol=0)


def check_material(material):
    core = material.get("pbrMetallicRoughness", {})
    assert all(0 <= core.get(name, 1) <= 1 for name in ("metallicFactor", "roughnessFactor"))
    assert all(0 <= part <= 1 for part in material.get("emissiveFactor", []))
    for name, content in material.get("extensions", {}).items():
        for field, value in content.items():
            low, high = FIELDS[name][field]
            numbers = value if field in COLORS else [value]
            assert len(numbers) == (3 if field in COLORS else 1) and all(low <= n <= high for n in numbers), field
    used = material.get("extensions", {})
    assert "KHR_materials_volume" not in used or "KHR_materials_transmission" in used


def textures_of(material):
    core = material.get("pbrMetallicRoughness", {})
    found = [core.get("baseColorTexture"), core.get("metallicRoughnessTexture"), material.get("emissiveTexture")]
    return [texture for texture in found if texture]


def check_textures(file):
    for texture in file.all("textures"):
        image = file.json["images"][texture["source"]]
        view = file.json["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        assert image["mimeType"] == "image/png" and "target" not in view
        assert file.data[start:start + 8] == b"\x89PNG\r\n\x1a\n" and start + view["byteLength"] <= len(file.data)
        sampler = file.json["samplers"][texture["sampler"]]
        assert sampler["magFilter"] in (9728, 9729) and sampler["minFilter"] in (9728, 9729, 9984, 9985, 9986, 9987)
        assert {sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)} <= {33071, 33648, 10497}
    assert len({texture["source"] for texture in file.all("textures")}) == len(file.all("images"))


def check_primitive(file, primitive):
    attributes = primitive["attributes"]
    views = {name: file.json["accessors"][index] for name, index in attributes.items()}
    count = views["POSITION"]["count"]
    assert "min" in views["POSITION"] and "max" in views["POSITION"]
    assert all(view["count"] == count for view in views.values())
    indices = file.accessor(primitive["indices"])
    assert indices.max() < count and len(indices) % 3 == 0 and indices.max() < 2 ** 32 - 1
    assert "TANGENT" not in attributes or "NORMAL" in attributes
    if "NORMAL" in attributes:
        normals = file.accessor(attributes["NORMAL"]).astype(float)
        assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 5e-4
    if "TANGENT" in attributes:
        tangents = file.accessor(attributes["TANGENT"]).astype(float)
        assert np.abs(np.linalg.norm(tangents[:, :3], axis=1) - 1).max() < 5e-4
        assert set(np.unique(tangents[:, 3])) <= {-1.0, 1.0}
    material = file.json["materials"][primitive["material"]]
    for texture in textures_of(material):
        assert texture["index"] < len(file.all("textures")) and "TEXCOORD_0" in attributes
        assert texture.get("texCoord", 0) == 0
    assert "KHR_materials_anisotropy" not in material.get("extensions", {}) or "TANGENT" in attributes


def check_animation(file, animation):
    targets = set()
    for channel in animation["channels"]:
        sampler, path = animation["samplers"][channel["sampler"]], channel["target"]["path"]
        times, values = file.accessor(sampler["input"]), file.accessor(sampler["output"])
        bounds = file.json["accessors"][sampler["input"]]
        assert "min" in bounds and "max" in bounds
        assert times[0] >= 0 and (np.diff(times[:, 0]) > 0).all() and len(values) == len(times)
        assert sampler.get("interpolation", "LINEAR") in ("LINEAR", "STEP")
        assert values.shape[1] == {"translation": 3, "rotation": 4, "scale": 3}[path]
        if path == "rotation":
            assert np.abs(np.linalg.norm(values.astype(float), axis=1) - 1).max() < 5e-4
        assert "matrix" not in file.json["nodes"][channel["target"]["node"]]
        key = (channel["target"]["node"], path)
        assert key not in targets
        targets.add(key)


def check_nodes(file):
    above = [0] * len(file.all("nodes"))
    for node in file.all("nodes"):
        assert abs(np.linalg.norm(node.get("rotation", [0, 0, 0, 1])) - 1) < 5e-4
        for child in node.get("children", []):
            above[child] += 1
    for root in file.json["scenes"][0]["nodes"]:
        above[root] += 1
    assert max(above) == 1


def extensions_of(thing):
    if isinstance(thing, list):
        return set().union(*map(extensions_of, thing)) if thing else set()
    if not isinstance(thing, dict):
        return set()
    found = set(thing.get("extensions", {}))
    return found.union(*(extensions_of(part) for part in thing.values())) if thing else found


def check(path):
    file = Glb(path)
    assert file.json["asset"]["version"] == "2.0"
    check_accessors(file)
    check_nodes(file)
    check_textures(file)
    for material in file.all("materials"):
        check_material(material)
    for mesh in file.all("meshes"):
        for primitive in mesh["primitives"]:
            check_primitive(file, primitive)
    for animation in file.all("animations"):
        check_animation(file, animation)
    assert extensions_of(file.json) == set(file.all("extensionsUsed"))
    assert set(file.all("extensionsRequired")) <= set(file.all("extensionsUsed"))
    return file


if __name__ == "__main__":
    for name in sys.argv[1:]:
        check(name)
