"""mesh_colors.py make FOLDER: random scenes of parts that have one colour each, and NAME.json of what they are made of.
mesh_colors.py check NAME.json ERROR FILE...: whether meshes have the colours of these parts, by the distances of boxes,
balls and cylinders as they are here; prints the number of triangles.

Points of the surface that are nearer than some errors to two parts of different colours may have either.
"""
import json
import random
import sys
import xml.etree.ElementTree as tree
import zipfile

import numpy as np

from gltf_rules import Glb

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
MATERIAL = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"
SAMPLES = 20000


def text_of(part):
    forms = {"box": "box({size})", "ball": "sphere({size})", "cylinder": "cylinder({size[0]}, {size[1]})"}
    turned = ".rotate([0, 0, 1], {turn}).move({at})".format(**part)
    return forms[part["form"]].format(**part) + turned + ".paint(#%02x%02x%02x)" % tuple(part["color"])


def distance(part, points):
    c, s = np.cos(part["turn"]), np.sin(part["turn"])
    p = (points - part["at"]) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    if part["form"] == "ball":
        return np.linalg.norm(p, axis=1) - part["size"]
    if part["form"] == "box":
        q = np.abs(p) - np.array(part["size"]) / 2
    else:
        q = np.stack([np.hypot(p[:, 0], p[:, 2]) - part["size"][0], np.abs(p[:, 1]) - part["size"][1] / 2], 1)
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(1), 0)


def make(folder):
    chance = random.Random(7)

    def between(low, high):
        return round(chance.uniform(low, high), 3)

    def part(form):
        size = {"box": [between(0.5, 2) for _ in range(3)], "ball": between(0.4, 0.8),
                "cylinder": [between(0.3, 0.7), between(0.5, 2)]}[form]
        color = [chance.randrange(256) for _ in range(3)]
        return {"form": form, "size": size, "turn": between(-3, 3), "at": [between(-1, 1) for _ in range(3)],
                "color": color}

    scenes = {}
    for i in range(4):
        scenes["mixed%d" % i] = [part(form) for form in chance.choices(["box", "box", "ball", "cylinder"], k=4)]
        scenes["boxes%d" % i] = [part("box") for _ in range(5)]
    # Level faces: tiles side by side, each a little into the next.
    scenes["tiles"] = [{"form": "box", "size": [1.02, 0.3, 1.02], "turn": 0, "at": [i, 0, k], "color": color}
                       for i, k, color in [(0, 0, [200, 30, 30]), (1, 0, [30, 200, 30]), (2, 0, [30, 30, 200]),
                                           (0, 1, [200, 200, 30]), (1, 1, [30, 200, 200]), (2, 1, [200, 30, 200])]]
    for name, parts in scenes.items():
        with open("%s/%s.json" % (folder, name), "w") as file:
            json.dump(parts, file)
        with open("%s/%s.krs" % (folder, name), "w") as file:
            file.write("show union([%s]);\n" % ", ".join(map(text_of, parts)))
    print(*scenes)


def srgb(linear):
    linear = np.asarray(linear, float)
    return 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def read_3mf(path):
    model = tree.fromstring(zipfile.ZipFile(path).read("3D/3dmodel.model"))
    groups = {g.get("id"): [b.get("displaycolor") for b in g] for g in model.iter(CORE + "basematerials")}
    groups.update({g.get("id"): [c.get("color") for c in g] for g in model.iter(MATERIAL + "colorgroup")})
    corners, colors = [], []
    for item in model.iter(CORE + "object"):
        points = [[float(v.get(k)) for k in "xyz"] for v in item.iter(CORE + "vertex")]
        for t in item.iter(CORE + "triangle"):
            group = groups[t.get("pid", item.get("pid"))]
            first = t.get("p1", item.get("pindex"))
            named = [group[int(t.get(k, first))] for k in ("p1", "p2", "p3")]
            corners.append([points[int(t.get(k))] for k in ("v1", "v2", "v3")])
            colors.append([[int(n[1 + 2 * k:3 + 2 * k], 16) for k in range(3)] for n in named])
    return np.array(corners), np.array(colors, float)


def read_ply(path):
    head, data = open(path, "rb").read().split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in head.split(b"\n") if line.startswith(b"element")]
    row = np.dtype([("at", "<f4", 3), ("color", "u1", 3)])
    vertices = np.frombuffer(data, row, counts[0])
    faces = np.frombuffer(data, np.dtype([("n", "u1"), ("v", "<u4", 3)]), counts[1], counts[0] * row.itemsize)["v"]
    return vertices["at"][faces].astype(float), vertices["color"][faces].astype(float)


def read_obj(path):
    lines = [line.split() for line in open(path)]
    vertices = np.array([line[1:7] for line in lines if line and line[0] == "v"], float)
    faces = np.array([[word.split("/")[0] for word in line[1:]] for line in lines if line and line[0] == "f"], int) - 1
    return vertices[faces][:, :, :3], 255 * vertices[faces][:, :, 3:]


def read_glb(path):
    file = Glb(path)
    corners, colors = [], []
    for mesh in file.json["meshes"]:
        for primitive in mesh["primitives"]:
            faces = file.accessor(primitive["indices"]).reshape(-1, 3)
            at = file.accessor(primitive["attributes"]["POSITION"]).astype(float)[faces]
            core = file.json["materials"][primitive["material"]]["pbrMetallicRoughness"]
            color = np.ones(at.shape) * core.get("baseColorFactor", [1, 1, 1, 1])[:3]
            if "COLOR_0" in primitive["attributes"]:
                color = color * file.accessor(primitive["attributes"]["COLOR_0"])[faces][:, :, :3] / 65535
            corners.append(at)
            colors.append(srgb(color))
    return np.concatenate(corners), np.concatenate(colors)


def is_closed(corners):
    """By where corners are: each edge goes as often one way as back."""
    _, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    numbers = numbers.reshape(-1, 3)
    edges = {}
    for k in range(3):
        for edge in zip(numbers[:, k].tolist(), numbers[:, (k + 1) % 3].tolist()):
            key = min(edge), max(edge)
            edges[key] = edges.get(key, 0) + (1 if edge[0] < edge[1] else -1)
    return not any(edges.values())


def check(parts, error, path):
    reader = {"3mf": read_3mf, "ply": read_ply, "obj": read_obj, "glb": read_glb}[path.split(".")[-1]]
    corners, colors = reader(path)
    assert is_closed(corners), path
    assert np.abs(colors - colors[:, :1]).max() < 1, "a triangle has several colours"
    chance = np.random.default_rng(1)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = chance.choice(len(corners), SAMPLES, p=areas / areas.sum())
    shares = chance.dirichlet([1, 1, 1], SAMPLES)
    points = (corners[chosen] * shares[:, :, None]).sum(1)
    found = np.array([distance(part, points) for part in parts])
    nearest = found.argmin(0)
    assert np.abs(found.min(0)).max() <= 1.01 * error, np.abs(found.min(0)).max()
    wanted = np.array([part["color"] for part in parts], float)
    off = np.abs(wanted[nearest] - colors[chosen, 0]).max(1)
    same = (wanted[:, None] == wanted[nearest][None]).all(2)
    clear = np.where(same, np.inf, found).min(0) > 4 * error
    assert clear.mean() > 0.5
    assert off[clear].max() < 1.5, (path, int((off[clear] > 1.5).sum()), points[clear][off[clear] > 1.5][:3])
    return len(corners)


if sys.argv[1] == "make":
    make(sys.argv[2])
else:
    print(*[check(json.load(open(sys.argv[2])), float(sys.argv[3]), path) for path in sys.argv[4:]])
