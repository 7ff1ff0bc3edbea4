"""mesh_bake.py FILE.glb SIDE: whether pictures of materials show what closed forms say, at random points of triangles.

The scene is that of mesh_bake.sh.  Pictures are read by the specification of PNG, and looked at as programs do it: the
four nearest pixels, each by how near it is.
"""
import struct
import sys
import zlib

import numpy as np

import gltf_rules

POINTS = 40000
BYTE = 1 / 255


def read_png(data):
    """All pixels of an 8-bit RGB picture, from 0 to 1."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack_from(">I", data, at + 8 + length)[0]
        if kind == b"IHDR":
            width, height, depth, color, *rest = struct.unpack(">IIBBBBB", body)
            assert (depth, color, rest) == (8, 2, [0, 0, 0])
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 3 * width + 1)
    above, found = np.zeros(3 * width, int), []
    for row in rows:
        above = unfilter(row[0], row[1:].astype(int), above)
        found.append(above)
    return np.array(found).reshape(height, width, 3) / 255


def unfilter(kind, row, above):
    if kind == 0:
        return row
    if kind == 2:
        return (row + above) & 255
    if kind == 1:
        return (np.cumsum(row.reshape(-1, 3), 0) & 255).ravel()
    out, up = [0, 0, 0], above.tolist()
    for i, value in enumerate(row.tolist()):
        left, over, corner = out[i], up[i], up[i - 3] if i >= 3 else 0
        guess = left + over - corner
        near = min((abs(guess - left), 0, left), (abs(guess - over), 1, over), (abs(guess - corner), 2, corner))[2]
        out.append((value + ((left + over) // 2 if kind == 3 else near)) & 255)
    return np.array(out[3:])


def look(picture, places):
    height, width, _ = picture.shape
    x, y = places[:, 0] * width - 0.5, places[:, 1] * height - 0.5
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    found = 0
    for i in (0, 1):
        for k in (0, 1):
            weight = (x - left if i else 1 - x + left) * (y - top if k else 1 - y + top)
            pixel = picture[np.clip(top + k, 0, height - 1), np.clip(left + i, 0, width - 1)]
            found = found + weight[:, None] * pixel
    return found


def to_srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def to_linear(encoded):
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


# ---- the scene ----

CELL, SHIFT = 3, 0.1


def to_block(p):
    """Onto the bore and its rims, on both sides of which corners are: all else of the block is flat."""
    radius, farthest = np.hypot(p[:, 0], p[:, 2]), np.abs(p).max(0)
    assert (farthest <= [1.0001, 0.5001, 0.5001]).all()
    factor = np.where((radius < 0.3001) | ((radius < 0.35) & (np.abs(p[:, 1]) < 0.4999)), 0.3 / radius, 1)
    return np.stack([p[:, 0] * factor, p[:, 1], p[:, 2] * factor], 1)


def to_ball(p):
    away = p - [2, 0, 0]
    return [2, 0, 0] + 0.7 * away / np.linalg.norm(away, axis=1)[:, None]


def to_ring(p):
    around = np.stack([p[:, 0], 0 * p[:, 0], p[:, 2]], 1)
    middle = [0, 2, 0] + 0.5 * around / np.linalg.norm(around, axis=1)[:, None]
    away = p - middle
    return middle + 0.2 * away / np.linalg.norm(away, axis=1)[:, None]


def board_color(p):
    odd = np.floor(CELL * p + SHIFT).sum(1) % 2
    return np.where(odd[:, None] < 0.5, [0.9, 0.1, 0.1], [0.9, 0.9, 0.8])


def board_gloss(p):
    return np.stack([0.2 + 0.6 * np.clip(p[:, 1] + 0.5, 0, 1), np.clip(p[:, 2] + 0.5, 0, 1)], 1)


def ball_color(p):
    return np.stack([0.5 + p[:, 0] / 6, 0.5 + 0.5 * p[:, 1], 0.5 + 0 * p[:, 0]], 1)


def ring_emission(p):
    return np.stack([3 + 2 * p[:, 0], 1 + 0 * p[:, 0], 0.5 + 0 * p[:, 0]], 1)


def from_borders(p):
    """How far points are from where the board changes its color."""
    part = CELL * p + SHIFT
    return (np.abs(part - np.rint(part)) / CELL).min(1)


# ---- the file ----


class Patch:
    """Triangles of one material: corners in space and in the pictures."""

    def __init__(self, file, primitive):
        attributes, corners = primitive["attributes"], file.accessor(primitive["indices"])[:, 0]
        self.points = file.accessor(attributes["POSITION"]).astype(float)[corners].reshape(-1, 3, 3)
        self.places = file.accessor(attributes["TEXCOORD_0"]).astype(float)[corners].reshape(-1, 3, 2)
        self.material = file.json["materials"][primitive["material"]]
        assert self.places.min() >= 0 and self.places.max() <= 1

    def areas(self):
        a, b, c = self.points.swapaxes(0, 1)
        return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2

    def pixels(self, side):
        """How long a pixel is on each triangle, at most: charts are seen by 45 degrees, or less."""
        a, b, c = self.places.swapaxes(0, 1)
        across = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
        return 1.5 * np.sqrt(self.areas() / np.maximum(across, 1e-12)) / side

    def sample(self, random, count):
        areas = self.areas()
        chosen = random.choice(len(areas), count, p=areas / areas.sum())
        weights = random.dirichlet([1, 1, 1], count)[:, :, None]
        return chosen, (weights * self.points[chosen]).sum(1), (weights * self.places[chosen]).sum(1)

    def seams(self, shares):
        """Points of edges whose two sides are apart in the picture: in space, in both places, and triangles."""
        sides, found = {}, []
        for t, (points, places) in enumerate(zip(self.points, self.places)):
            for k in range(3):
                ends = sorted((tuple(points[n]), tuple(places[n])) for n in (k, (k + 1) % 3))
                sides.setdefault((ends[0][0], ends[1][0]), []).append((ends[0][1], ends[1][1], t))
        for (a, b), both in sides.items():
            if len(both) == 2 and both[0][:2] != both[1][:2]:
                for share in shares:
                    between = [(1 - share) * np.array(p) + share * np.array(q)
                               for p, q in [(a, b), both[0][:2], both[1][:2]]]
                    found.append((*between, both[0][2]))
        return [np.array(column) for column in zip(*found)]


def pictures_of(file):
    found = []
    for texture in file.all("textures"):
        image = file.json["images"][texture["source"]]
        view = file.json["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        found.append(read_png(file.data[start:start + view["byteLength"]]))
    return found


def values_of(patch, pictures, places):
    """What a program sees: base colour and emission as numbers of sRGB, roughness and metallic."""
    core, found = patch.material["pbrMetallicRoughness"], {}
    if "baseColorTexture" in core:
        found["color"] = look(pictures[core["baseColorTexture"]["index"]], places)
        assert "baseColorFactor" not in core
    if "metallicRoughnessTexture" in core:
        found["gloss"] = look(pictures[core["metallicRoughnessTexture"]["index"]], places)[:, 1:]
        assert core.get("roughnessFactor", 1) == core.get("metallicFactor", 1) == 1
    if "emissiveTexture" in patch.material:
        found["glow"] = look(pictures[patch.material["emissiveTexture"]["index"]], places)
        assert np.allclose(patch.material["emissiveFactor"], 1, atol=1e-6)
    return found


def near(found, wanted, allowed, what):
    worst = (np.abs(found - wanted) / np.broadcast_to(np.expand_dims(allowed, -1), found.shape)).max()
    print(what, "of what is allowed: %.2f" % worst)
    assert worst <= 1, what


def check_values(patch, found, points, pixel, what):
    """Closed forms; linear ones change by no more than their slopes in the length of a pixel."""
    name = patch.material["name"]
    if name == "board":
        on = to_block(points)
        clear = from_borders(on) > 2 * pixel
        assert clear.sum() > (0 if "seams" in what else 1000)
        near(found["color"][clear], to_srgb(board_color(on[clear])), 1.01 * BYTE + 0 * pixel[clear], what + " colours")
        near(found["gloss"], board_gloss(on), BYTE + 0.2 * pixel, what + " gloss")
        # Within a chart what is linear is exact, but for rounding to bytes.
        usual = np.quantile(np.abs(found["gloss"] - board_gloss(on)), 0.9) / BYTE
        assert "seams" in what or usual < 0.55, usual
    elif name == "colour":
        near(found["color"], to_srgb(ball_color(to_ball(points))), BYTE + 0.2 * pixel, what + " gradient")
    else:
        strength = patch.material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
        wanted = ring_emission(to_ring(points)) / strength
        assert 0.99 < strength / 4.4 < 1.0001
        near(to_linear(found["glow"]), wanted, 0.01 + 0.2 * pixel, what + " emission")


def main():
    file, side = gltf_rules.check(sys.argv[1]), int(sys.argv[2])
    pictures, random, names = pictures_of(file), np.random.default_rng(1), []
    assert len(pictures) == 3 and all(p.shape == (side, side, 3) for p in pictures)
    for mesh in file.json["meshes"]:
        for primitive in mesh["primitives"]:
            material = file.json["materials"][primitive["material"]]
            names.append(material["name"])
            assert "COLOR_0" not in primitive["attributes"]
            if "TEXCOORD_0" not in primitive["attributes"]:
                color = material["pbrMetallicRoughness"]["baseColorFactor"]
                assert material["name"] == "#008000" and np.allclose(color, [0, 0.21586, 0, 1], atol=1e-4)
                continue
            patch = Patch(file, primitive)
            chosen, points, places = patch.sample(random, POINTS)
            check_values(patch, values_of(patch, pictures, places), points, patch.pixels(side)[chosen],
                         material["name"])
            points, ones, others, triangles = patch.seams([0.15, 0.5, 0.77])
            assert len(points) > 20
            for n, places in enumerate((ones, others)):
                check_values(patch, values_of(patch, pictures, places), points, patch.pixels(side)[triangles],
                             "%s at seams, side %d," % (material["name"], n))
    assert sorted(set(names)) == ["#008000", "board", "colour", "glow"] and len(names) == 4 * len(file.json["meshes"])


main()
