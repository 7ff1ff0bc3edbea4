"""mesh_motion.py KIND FILE.glb ERROR: whether parts are at all times where the scenes of mesh_motion.sh have them.

Poses are interpolated as glTF 2.0 says in its appendix C, and compared with closed forms, at many random times.
"""
import sys

import numpy as np

from gltf_rules import check

FPS = 4.0
chance = np.random.default_rng(7)


def interpolate(times, values, time, turns):
    time = min(max(time, times[0]), times[-1])
    after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1))
    share = (time - times[after - 1]) / (times[after] - times[after - 1])
    a, b = values[after - 1], values[after]
    if not turns:
        return a + share * (b - a)
    cosine = a @ b
    b, cosine = (-b, -cosine) if cosine < 0 else (b, cosine)
    angle = np.arccos(min(cosine, 1))
    if angle < 1e-6:
        return a + share * (b - a)
    return (np.sin((1 - share) * angle) * a + np.sin(share * angle) * b) / np.sin(angle)


def matrix(quaternion):
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class Film:
    """The vertices of each node with a mesh, in the scene, at any time."""

    def __init__(self, path):
        self.file = check(path)
        self.tracks = {}
        for channel in self.file.json.get("animations", [{"channels": []}])[0]["channels"]:
            sampler = self.file.json["animations"][0]["samplers"][channel["sampler"]]
            times, values = (self.file.accessor(sampler[key]).astype(float) for key in ("input", "output"))
            self.tracks[channel["target"]["node"], channel["target"]["path"]] = (times[:, 0], values)
        self.nodes = [i for i, node in enumerate(self.file.json["nodes"]) if "mesh" in node]
        self.end = max((times[-1] for times, _ in self.tracks.values()), default=0)
        self.keys = max((len(times) for times, _ in self.tracks.values()), default=0)

    def of(self, node, path, time, otherwise):
        if (node, path) not in self.tracks:
            return np.array(self.file.json["nodes"][node].get(path, otherwise), float)
        return interpolate(*self.tracks[node, path], time, path == "rotation")

    def vertices(self, node, time):
        primitive = self.file.json["meshes"][self.file.json["nodes"][node]["mesh"]]["primitives"][0]
        points = self.file.accessor(primitive["attributes"]["POSITION"]).astype(float)
        points = points * self.of(node, "scale", time, [1, 1, 1])
        return points @ matrix(self.of(node, "rotation", time, [0, 0, 0, 1])).T + \
            self.of(node, "translation", time, [0, 0, 0])


def turn(axis, angle):
    """Rodrigues."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def corners(size):
    return np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(size) / 2


def farthest(found, wanted):
    """Boxes have no other vertices than corners, but for those of several materials."""
    apart = np.linalg.norm(found[:, None] - wanted[None], axis=2)
    return max(apart.min(0).max(), 0 if kind == "paints" else apart.min(1).max())


def spin(t):
    return [corners([2, 0.2, 0.4]) @ turn([1, 2, 0], 9 * t).T + [3 * np.sin(t), 0, 0]]


def orbit(t):
    return [(corners([0.5, 1, 0.25]) + [5, 0, 0]) @ turn([0, 1, 0], 9 * t).T, corners([1, 1, 1]) + [0, 0.25, 0]]


def ride(t):
    return [corners([1, 1, 1]) + [2 * t, 0, 0]]


def wave(t):
    return [corners([0.2, 0.3, 0.4]) + [i, np.sin(t + i), 0] for i in range(40)]


def pair(t):
    image = corners([0.6, 0.3, 0.2]) @ turn([0, 0, 1], t).T + [2 + np.sin(t), 0.5, 0]
    return [image, image * [-1, 1, 1]]


def shake(t):
    """At rest at each quarter of a frame."""
    return [corners([1, 0.2, 0.2]) + [0.3 * np.sin(32 * np.pi * t), 0, 0]]


def twins(t):
    arm = corners([1, 0.2, 0.2])
    return [arm @ turn([0, 0, 1], t).T, arm @ turn([0, 0, 1], 2 * t).T + [3, 0, 0]]


def paints(t):
    wheel = corners([1, 0.2, 0.2]) @ turn([0, 0, 1], t).T
    return [wheel, wheel + [3, 0, 0], wheel + [0, 0, 5], wheel + [0, 3, 5]]


def check_paints(film):
    """Nodes by where they are; two are at the origin.  Parts that differ in paint share vertices and triangles."""
    found, shapes = [], set()
    for node in film.nodes:
        primitive = film.file.json["meshes"][film.file.json["nodes"][node]["mesh"]]["primitives"][0]
        core = film.file.json["materials"][primitive["material"]]["pbrMetallicRoughness"]
        color = np.array(core.get("baseColorFactor", [1, 1, 1, 1])[:3])  # which is left out if it is white
        if "COLOR_0" in primitive["attributes"]:  # of materials with several colors
            colors = film.file.accessor(primitive["attributes"]["COLOR_0"])[:, :3] // 65535
            assert (colors == colors[0]).all()
            color = color * colors[0]
        shapes.add((primitive["attributes"]["POSITION"], primitive["indices"]))
        found.append((*(int(x) for x in np.round(film.vertices(node, 0).mean(0))), *(int(c) for c in color)))
    assert sorted(found) == [(0, 0, 0, 1, 0, 0), (0, 0, 5, 0, 1, 0), (0, 3, 5, 1, 1, 1), (3, 0, 0, 0, 0, 1)], found
    assert len(shapes) == 1, shapes


kind, path, error = sys.argv[1], sys.argv[2], float(sys.argv[3])
first = float(sys.argv[4]) / FPS if len(sys.argv) > 4 else 0
film, at = Film(path), globals()[kind]
assert abs(film.end - 3) < 1e-6, film.end
worst = 0
if kind == "paints":
    check_paints(film)
if kind == "twins":  # which have one mesh
    assert len(film.file.json["meshes"]) == 1
for time in np.concatenate([[0, 3], chance.uniform(0, 3, 60)]):
    found = [film.vertices(node, time) for node in film.nodes]
    wanted = at(first + time)
    assert len(found) == len(wanted), (len(found), len(wanted))
    for solid in wanted:
        worst = max(worst, min(farthest(points, solid) for points in found))
assert worst <= error, worst
print(len(film.nodes), len(film.file.json["meshes"]), film.keys, worst)
