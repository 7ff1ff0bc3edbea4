#!/usr/bin/env python3
"""A picture of a mesh: facets, and the edges between them.

    krs mesh part.krs -o part.stl
    tools/mesh_picture.py part.stl part.png --from 1,0.8,1.2 --size 1200x800

Reads binary STL, and GLB with its colours and pictures of one mesh in each node.  Needs numpy, and no renderer: triangles are drawn into a buffer of depths.
"""
import argparse
import json
import struct
import zlib

import numpy

SAMPLES = 2  # along a side of a pixel
LIGHTS = [((-0.5, 0.9, 0.7), 0.75), ((0.9, 0.3, 0.4), 0.3)]  # directions to them, seen by the camera
FACET, EDGE, PAPER = (0.93, 0.66, 0.36), (0.16, 0.14, 0.13), (1.0, 1.0, 1.0)
AMBIENT = 0.25
EDGE_WIDTH = 0.55  # half of it, in samples


def read_stl(path):
    """Corners of triangles."""
    data = open(path, "rb").read()
    (count,) = struct.unpack("<I", data[80:84])
    record = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return numpy.frombuffer(data[84:], dtype=record, count=count)["corners"].astype(float)


def unfilter(kind, row, above):
    """A row of a PNG with three bytes for each pixel."""
    if kind == 0:
        return row
    if kind == 1:
        return (numpy.cumsum(row.reshape(-1, 3), 0) & 255).ravel()
    if kind == 2:
        return (row + above) & 255
    out, up = [0, 0, 0], [0, 0, 0] + above.tolist()
    for i, value in enumerate(row.tolist()):
        left, over, corner = out[i], up[i + 3], up[i]
        away = [abs(over - corner), abs(left - corner), abs(left + over - 2 * corner)]
        near = (left, over, corner)[away.index(min(away))]
        out.append((value + ((left + over) // 2 if kind == 3 else near)) & 255)
    return numpy.array(out[3:])


def linear(levels):
    return numpy.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)


def read_png(data):
    """Linear colours of a picture of 8-bit RGB."""
    width, height = struct.unpack_from(">II", data, 16)
    packed, at = b"", 8
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    rows, above = [], numpy.zeros(3 * width, int)
    for row in numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, -1):
        above = unfilter(row[0], row[1:].astype(int), above)
        rows.append(above)
    return linear(numpy.array(rows).reshape(height, width, 3) / 255)


def read_glb(path):
    """Corners of triangles, and the paint of each: a colour, or places in a picture."""
    data = open(path, "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    model, data = json.loads(data[20:20 + length]), data[28 + length:]

    def view(number):
        found = model["bufferViews"][number]
        return data[found.get("byteOffset", 0):][:found["byteLength"]]

    def rows(number, width):
        kind = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[model["accessors"][number]["componentType"]]
        return numpy.frombuffer(view(model["accessors"][number]["bufferView"]), kind).reshape(-1, width)

    pictures = [read_png(view(image["bufferView"])) for image in model.get("images", [])]
    corners, paints = [], []
    for primitive in (p for mesh in model["meshes"] for p in mesh["primitives"]):
        attributes, numbers = primitive["attributes"], rows(primitive["indices"], 1)[:, 0]
        core = model["materials"][primitive["material"]]["pbrMetallicRoughness"]
        corners.append(rows(attributes["POSITION"], 3)[numbers].reshape(-1, 3, 3).astype(float))
        if "baseColorTexture" in core:
            picture = pictures[model["textures"][core["baseColorTexture"]["index"]]["source"]]
            paints += [(places, picture) for places in rows(attributes["TEXCOORD_0"], 2)[numbers].reshape(-1, 3, 2)]
        elif "COLOR_0" in attributes:
            paints += list(rows(attributes["COLOR_0"], 4)[numbers].reshape(-1, 3, 4).mean(1)[:, :3] / 65535)
        else:
            paints += [core.get("baseColorFactor", [1, 1, 1, 1])[:3]] * len(corners[-1])
    return numpy.concatenate(corners), paints


def look(corners, towards, width, height):
    """Corners in samples of the picture, with the depth as the third number; larger is nearer."""
    back = numpy.array(towards) / numpy.linalg.norm(towards)
    right = numpy.cross((0.0, 1.0, 0.0), back)
    right /= numpy.linalg.norm(right)
    frame = numpy.array([right, numpy.cross(back, right), back])
    seen = corners @ frame.T
    low, high = seen.reshape(-1, 3).min(0), seen.reshape(-1, 3).max(0)
    scale = 0.92 * min(width / (high[0] - low[0]), height / (high[1] - low[1]))
    seen = (seen - 0.5 * (low + high)) * scale
    normals = numpy.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    lengths = numpy.linalg.norm(normals, axis=1)
    seen = seen * (1, -1, 1) + (0.5 * width, 0.5 * height, 0)
    keep = (lengths > 0) & (normals[:, 2] > 0)
    return seen[keep], normals[keep] / lengths[keep, None], keep


def shades(normals):
    """The light that facets with these normals send to the camera."""
    light = numpy.full(len(normals), AMBIENT)
    for direction, power in LIGHTS:
        unit = numpy.array(direction) / numpy.linalg.norm(direction)
        light += power * numpy.maximum(normals @ unit, 0)
    return light


def paint_at(paint, weights):
    """The colours of points that have such weights of the corners."""
    if not isinstance(paint, tuple):
        return numpy.array(paint)
    places, picture = paint
    size = picture.shape[1::-1]
    x, y = (sum(w * places[k, i] for k, w in enumerate(weights)) * size[i] for i in range(2))
    return picture[numpy.clip(y.astype(int), 0, size[1] - 1), numpy.clip(x.astype(int), 0, size[0] - 1)]


def draw(triangle, light, paint, depths, colours):
    """Draws one triangle where it is the nearest."""
    low = numpy.maximum(numpy.floor(triangle[:, :2].min(0)).astype(int), 0)
    high = numpy.minimum(numpy.ceil(triangle[:, :2].max(0)).astype(int) + 1, depths.shape[::-1])
    if (low >= high).any():
        return
    x, y = numpy.meshgrid(numpy.arange(low[0], high[0]) + 0.5, numpy.arange(low[1], high[1]) + 0.5)
    inside, nearest, weights = True, numpy.inf, []
    for k in range(3):
        a, b = triangle[(k + 1) % 3, :2], triangle[(k + 2) % 3, :2]
        cross = (b[1] - a[1]) * (x - a[0]) - (b[0] - a[0]) * (y - a[1])
        weights.append(cross)
        inside = inside & (cross >= 0)
        nearest = numpy.minimum(nearest, cross / max(numpy.hypot(*(b - a)), 1e-12))
    total = weights[0] + weights[1] + weights[2]
    weights = [w / numpy.where(total == 0, 1, total) for w in weights]
    depth = sum(w * triangle[k, 2] for k, w in enumerate(weights))
    part = (slice(low[1], high[1]), slice(low[0], high[0]))
    inside = inside & (total > 0) & (depth > depths[part])
    depths[part][inside] = depth[inside]
    colour = numpy.where((nearest < EDGE_WIDTH)[..., None], EDGE, paint_at(paint, weights) * light)
    colours[part][inside] = colour[inside]


def write_png(path, colours):
    """Linear colours from 0 to 1, as sRGB."""
    levels = numpy.clip(colours, 0, 1)
    levels = numpy.where(levels <= 0.0031308, 12.92 * levels, 1.055 * levels ** (1 / 2.4) - 0.055)
    levels = (255 * levels + 0.5).astype(numpy.uint8)
    height, width = levels.shape[:2]
    rows = b"".join(b"\0" + row.tobytes() for row in levels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", help="a binary STL file, or a GLB")
    parser.add_argument("picture", help="the PNG file to be written")
    parser.add_argument("--from", dest="towards", default="1,0.8,1.2", help="the direction to the camera")
    parser.add_argument("--size", default="1200x800", help="in pixels")
    options = parser.parse_args()
    width, height = (SAMPLES * int(n) for n in options.size.split("x"))
    towards = [float(n) for n in options.towards.split(",")]
    if options.mesh.endswith(".glb"):
        corners, paints = read_glb(options.mesh)
    else:
        corners = read_stl(options.mesh)
        paints = [numpy.array(FACET)] * len(corners)
    triangles, normals, seen = look(corners, towards, width, height)
    paints = [paint for paint, is_seen in zip(paints, seen) if is_seen]
    depths = numpy.full((height, width), -numpy.inf)
    colours = numpy.full((height, width, 3), PAPER)
    for triangle, light, paint in zip(triangles, shades(normals), paints):
        draw(triangle, light, paint, depths, colours)
    means = colours.reshape(height // SAMPLES, SAMPLES, width // SAMPLES, SAMPLES, 3).mean((1, 3))
    write_png(options.picture, means)


main()
