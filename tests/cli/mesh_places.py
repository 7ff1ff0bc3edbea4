"""mesh_places.py FORM FILE...: whether triangles are in the texture where a closed form says.

Reads OBJ, binary PLY and GLB by their specifications alone.  FORM is ball, can or block; whole numbers may be
added to coordinates, as pictures repeat, but not so that a triangle has both ends of the picture.
"""
import json
import math
import struct
import sys


def read_obj(path):
    points, places, triangles = [], [], []
    for line in open(path):
        word = line.split()
        if word and word[0] == "v":
            points.append([float(w) for w in word[1:4]])
        if word and word[0] == "vt":
            places.append([float(w) for w in word[1:3]])
        if word and word[0] == "f":
            corners = [[int(n) - 1 for n in w.split("/")[:2]] for w in word[1:]]
            triangles.append([(points[p], places[t]) for p, t in corners])
    return triangles


def read_ply(path):
    head, body = open(path, "rb").read().split(b"end_header\n", 1)
    words = head.decode().split()
    vertices, faces = (int(words[words.index(name) + 1]) for name in ("vertex", "face"))
    assert "s" in words and "t" in words and len(body) == 23 * vertices + 13 * faces
    all_vertices = [struct.unpack_from("<3f3B2f", body, 23 * i) for i in range(vertices)]
    found = []
    for i in range(faces):
        count, *corners = struct.unpack_from("<B3I", body, 23 * vertices + 13 * i)
        assert count == 3
        found.append([(all_vertices[k][:3], all_vertices[k][6:]) for k in corners])
    return found


def read_glb(path):
    data = open(path, "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    model, data = json.loads(data[20:20 + length]), data[28 + length:]

    def rows(index):
        accessor = model["accessors"][index]
        view = model["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        form = "<%d%s" % (width, {5126: "f", 5125: "I"}[accessor["componentType"]])
        begin = view.get("byteOffset", 0)
        return [struct.unpack_from(form, data, begin + 4 * width * i) for i in range(accessor["count"])]

    (primitive,) = model["meshes"][0]["primitives"]
    points = rows(primitive["attributes"]["POSITION"])
    places = [(u, 1 - v) for u, v in rows(primitive["attributes"]["TEXCOORD_0"])]  # v goes down there
    corners = [row[0] for row in rows(primitive["indices"])]
    return [[(points[k], places[k]) for k in corners[i:i + 3]] for i in range(0, len(corners), 3)]


def ball(x, y, z):
    """t(2 u / tau, v / pi + 0.5) at longitude u and latitude v"""
    return math.atan2(z, x) / math.pi, math.atan2(y, math.hypot(x, z)) / math.pi + 0.5


def can(x, y, z):
    """t(u / tau, y)"""
    return math.atan2(z, x) / (2 * math.pi), y


def block(x, y, z):
    """t(3 x + y, 5 z): no seams, and many pictures in a triangle"""
    return 3 * x + y, 5 * z


# And how far apart corners may be: less than half of the way around.
form, most = {"ball": (ball, 1), "can": (can, 0.5), "block": (block, math.inf)}[sys.argv[1]]
for path in sys.argv[2:]:
    triangles = {"obj": read_obj, "ply": read_ply, "glb": read_glb}[path.rsplit(".", 1)[1]](path)
    seams = 0
    for triangle in triangles:
        if most < math.inf and min(math.hypot(p[0], p[2]) for p, _ in triangle) < 0.1:
            continue  # at a pole, where u is anything
        off = [[a - b for a, b in zip(place, form(*point))] for point, place in triangle]
        assert all(abs(n - round(n)) < 1e-5 for pair in off for n in pair), (path, triangle)
        us = [place[0] for _, place in triangle]
        assert max(us) - min(us) < most, (path, triangle)
        seams += len({round(pair[0]) for pair in off}) > 1
        assert most < math.inf or not any(round(n) for pair in off for n in pair), (path, triangle)
    assert (seams > 0) == (most < math.inf) and len(triangles) >= 12, (path, seams)
