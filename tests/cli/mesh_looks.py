"""mesh_looks.py LOOKS.glb BRUSHED.glb: whether materials in GLB are those of the scenes of mesh_looks.sh.

Numbers are derived from the specifications of the extensions, not from the program.
"""
import sys

import numpy as np

from gltf_rules import Glb, check

CM = 0.01


def near(found, wanted, tolerance=1e-9):
    assert np.allclose(found, wanted, rtol=tolerance, atol=tolerance), (found, wanted)


def looks(path):
    file = check(path)

    def extension(name, kind):
        return file.material(name)["extensions"]["KHR_materials_" + kind]

    def core(name):
        return file.material(name)["pbrMetallicRoughness"]

    assert core("glass")["roughnessFactor"] == 0.05 and extension("glass", "ior") == {"ior": 1.33}
    near(extension("glass", "transmission")["transmissionFactor"], 0.9)
    volume = extension("glass", "volume")
    # Light after a way of 0.7, in lengths of the scene, is exp(-0.7 absorption).
    left = np.array(volume["attenuationColor"]) ** (0.7 * CM / volume["attenuationDistance"])
    near(left, np.exp(-0.7 * np.array([0.5, 0.1, 0.05])))
    # The mean way through a ball of radius 1 is 4/3; through one that is hollow, 4 V / S.
    near(volume["thicknessFactor"], 4 / 3 * CM, 0.03)
    hollow = extension("clear", "volume")
    near(hollow["thicknessFactor"], 4 / 3 * (1 - 0.8 ** 3) / (1 + 0.8 ** 2) * CM, 0.03)
    near(hollow.get("attenuationColor", [1, 1, 1]), [1, 1, 1])
    assert "attenuationDistance" not in hollow
    near([core("paint")["metallicFactor"], core("paint")["roughnessFactor"]], [0.25, 0.5])
    assert extension("paint", "clearcoat") == {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.125}
    assert extension("velvet", "sheen") == {"sheenColorFactor": [0.5, 0.25, 0.125], "sheenRoughnessFactor": 0.4}
    assert extension("velvet", "specular") == {"specularFactor": 0.5}
    soap = extension("soap", "iridescence")
    near([soap["iridescenceFactor"], soap["iridescenceIor"], soap["iridescenceThicknessMaximum"]], [0.5, 1.35, 420])
    neon = file.material("neon")
    near(np.array(neon["emissiveFactor"]) * extension("neon", "emissive_strength")["emissiveStrength"], [30, 9, 6])
    dim = file.material("dim")
    near(dim["emissiveFactor"], [0.5, 0.25, 0])
    assert "extensions" not in dim and "extensions" not in file.material("wax")
    near(core("vary")["roughnessFactor"], 0.5, 0.01)
    some = [m["pbrMetallicRoughness"]["roughnessFactor"] for m in file.json["materials"] if m["name"] == "some"]
    assert sorted(some) == [0.25, 0.75]
    colours(file)


def colours(file):
    """What is painted with one material has its triangles: those of `paint` are about x = 6."""
    for primitive in file.json["meshes"][0]["primitives"]:
        name = file.json["materials"][primitive["material"]]["name"]
        points = file.accessor(primitive["attributes"]["POSITION"])
        used = points[file.accessor(primitive["indices"])[:, 0]] / CM
        if name == "paint":
            assert 5.4 < used[:, 0].min() and used[:, 0].max() < 6.6


def brushed(path):
    """A disc whose tangent is [x, 0, z], its mirror image, and a block without a tangent."""
    file = check(path)
    assert len(file.json["materials"]) == 2
    steel = file.material("steel")
    strength = steel["extensions"]["KHR_materials_anisotropy"]["anisotropyStrength"]
    across = steel["pbrMetallicRoughness"]["roughnessFactor"] ** 2
    along = across + (1 - across) * strength ** 2
    # OpenPBR's widths: their ratio, and the mean of their squares.
    near(across / along, 1 - 0.75)
    near((across ** 2 + along ** 2) / 2, 0.4 ** 4)
    discs = 0
    for node in file.json["nodes"]:
        if "mesh" not in node:
            continue
        for primitive in file.json["meshes"][node["mesh"]]["primitives"]:
            if file.json["materials"][primitive["material"]]["name"] == "steel":
                discs += check_discs(file, primitive)
    assert discs == 2


def check_discs(file, primitive):
    """Returns how many there are."""
    used = np.unique(file.accessor(primitive["indices"]))
    x = file.accessor(primitive["attributes"]["POSITION"])[used, 0]
    if x.max() - x.min() < 1.2:
        return check_disc(file, primitive, used)
    middle = (x.max() + x.min()) / 2
    return check_disc(file, primitive, used[x < middle]) + check_disc(file, primitive, used[x > middle])


def check_disc(file, primitive, used):
    points, normals, tangents = (file.accessor(primitive["attributes"][name])[used].astype(float)
                                 for name in ("POSITION", "NORMAL", "TANGENT"))
    assert np.abs((normals * tangents[:, :3]).sum(1)).max() < 1e-5
    flat = np.abs(normals[:, 1]) > 0.99
    middle = (points.max(0) + points.min(0)) / 2
    out = (points - middle) * [1, 0, 1]
    length = np.linalg.norm(out, axis=1)
    face = flat & (length > 0.2)
    assert face.any() and (~flat).any()
    cosine = (out[face] / length[face, None] * tangents[face, :3]).sum(1)
    assert cosine.min() > 0.98, cosine.min()
    # The side faces outwards, and the faces up and down.
    assert ((normals[~flat] * out[~flat]).sum(1) > 0).all()
    assert ((normals[flat, 1] > 0) == (points[flat, 1] > middle[1])).all()
    return 1


looks(sys.argv[1])
for name in sys.argv[2:]:
    brushed(name)
