#!/usr/bin/env python3
"""A picture of a mesh: facets, and the edges between them.

    krs mesh part.krs -o part.stl
    tools/mesh_picture.py part.stl part.png --from 1,0.8,1.2 --size 1200x800

Reads binary STL.  Needs numpy, and no renderer: triangles are drawn into a buffer of depths.
"""
import argparse
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
    return seen[keep], normals[keep] / lengths[keep, None]


def shades(normals):
    """The light that facets with these normals send to the camera."""
    light = numpy.full(len(normals), AMBIENT)
    for direction, power in LIGHTS:
        unit = numpy.array(direction) / numpy.linalg.norm(direction)
        light += power * numpy.maximum(normals @ unit, 0)
    return light


def draw(triangle, light, depths, colours):
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
    depth = sum(w * triangle[k, 2] for k, w in enumerate(weights)) / numpy.where(total == 0, 1, total)
    part = (slice(low[1], high[1]), slice(low[0], high[0]))
    inside = inside & (total > 0) & (depth > depths[part])
    depths[part][inside] = depth[inside]
    colour = numpy.where((nearest < EDGE_WIDTH)[..., None], EDGE, numpy.array(FACET) * light)
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
    parser.add_argument("mesh", help="a binary STL file")
    parser.add_argument("picture", help="the PNG file to be written")
    parser.add_argument("--from", dest="towards", default="1,0.8,1.2", help="the direction to the camera")
    parser.add_argument("--size", default="1200x800", help="in pixels")
    options = parser.parse_args()
    width, height = (SAMPLES * int(n) for n in options.size.split("x"))
    towards = [float(n) for n in options.towards.split(",")]
    triangles, normals = look(read_stl(options.mesh), towards, width, height)
    depths = numpy.full((height, width), -numpy.inf)
    colours = numpy.full((height, width, 3), PAPER)
    for triangle, light in zip(triangles, shades(normals)):
        draw(triangle, light, depths, colours)
    means = colours.reshape(height // SAMPLES, SAMPLES, width // SAMPLES, SAMPLES, 3).mean((1, 3))
    write_png(options.picture, means)


main()
