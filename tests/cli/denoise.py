#!/usr/bin/env python3
"""Writes pictures as programs name their channels, and reads them back; for denoise.sh.

denoise.py make NAME FILE: a picture whose truth is two flat colours.  denoise.py judge NOISY FILE: prints by how much the
error has fallen, and whether all other channels and attributes are as they were.
"""
import math
import random
import struct
import sys
import zlib

WIDTH, HEIGHT, NOISE, SAMPLES = 70, 50, 0.1, 16


def truth(x):
    return (0.7, 0.5, 0.3) if x < WIDTH // 2 else (0.2, 0.4, 0.6)


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def write(path, channels, extra=b"", corner=(0, 0), display=None, tile=0):
    """Writes float channels: a function of x and y for each name."""
    names = sorted(channels, key=lambda name: name.encode())
    x0, y0 = corner
    box = struct.pack("<4i", x0, y0, x0 + WIDTH - 1, y0 + HEIGHT - 1)
    lists = b"".join(n.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for n in names) + b"\0"
    head = struct.pack("<II", 20000630, 2 | (0x200 if tile else 0) | (0x400 if max(map(len, names)) > 31 else 0))
    head += attribute("channels", "chlist", lists) + attribute("compression", "compression", b"\0")
    head += attribute("dataWindow", "box2i", box)
    head += attribute("displayWindow", "box2i", struct.pack("<4i", *display) if display else box)
    head += attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    if tile:
        head += attribute("tiles", "tiledesc", struct.pack("<IIB", tile, tile, 0))
    head += extra + b"\0"
    chunks = []
    step = tile or WIDTH
    for y in range(0, HEIGHT, tile or 1):
        for x in range(0, WIDTH, step):
            data = b"".join(struct.pack("<f", channels[n](i, k)) for k in range(y, min(y + (tile or 1), HEIGHT))
                            for n in names for i in range(x, min(x + step, WIDTH)))
            place = struct.pack("<4i", x // step, y // step, 0, 0) if tile else struct.pack("<i", y + y0)
            chunks.append(place + struct.pack("<i", len(data)) + data)
    at = len(head) + 8 * len(chunks)
    table = b""
    for chunk in chunks:
        table += struct.pack("<Q", at)
        at += len(chunk)
    with open(path, "wb") as file:
        file.write(head + table + b"".join(chunks))


def read(path):
    """Returns channels as bytes by name, with the size of a number, and attributes."""
    with open(path, "rb") as file:
        whole = file.read()
    at, attributes, channels = 8, {}, []

    def text(at):
        end = whole.index(0, at)
        return whole[at:end].decode(), end + 1
    while whole[at]:
        name, at = text(at)
        kind, at = text(at)
        size, = struct.unpack_from("<i", whole, at)
        attributes[name] = (kind, whole[at + 4:at + 4 + size])
        at += 4 + size
    where, listed = 0, attributes["channels"][1]
    while listed[where]:
        end = listed.index(0, where)
        kind, = struct.unpack_from("<i", listed, end + 1)
        channels.append((listed[where:end].decode(), 2 if kind == 1 else 4))
        where = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    tile = struct.unpack_from("<I", attributes["tiles"][1])[0] if "tiles" in attributes else 0
    lines = 16 if attributes["compression"][1][0] == 3 else 1
    planes = {name: [None] * height for name, _ in channels}
    if tile:
        planes = {name: [b""] * height for name, _ in channels}
    count = -(-width // tile) * -(-height // tile) if tile else -(-height // lines)
    for chunk in struct.unpack_from("<%dQ" % count, whole, at + 1):
        if tile:
            x, y, _, _, size = struct.unpack_from("<5i", whole, chunk)
            data, y, rows, wide = whole[chunk + 20:chunk + 20 + size], y * tile, tile, min(tile, width - x * tile)
        else:
            y, size = struct.unpack_from("<ii", whole, chunk)
            data, y, rows, wide = whole[chunk + 8:chunk + 8 + size], y - y0, lines, width
        rows = min(rows, height - y)
        if size < wide * rows * sum(size for _, size in channels):
            packed = bytearray(zlib.decompress(data))
            for i in range(1, len(packed)):
                packed[i] = (packed[i - 1] + packed[i] - 128) & 255
            data, half = bytearray(len(packed)), (len(packed) + 1) // 2
            data[0::2], data[1::2] = packed[:half], packed[half:]
        place = 0
        for row in range(y, y + rows):
            for name, size in channels:
                part = bytes(data[place:place + wide * size])
                planes[name][row] = (planes[name][row] or b"") + part
                place += wide * size
    return {n: (s, b"".join(planes[n])) for n, s in channels}, attributes


def numbers(channel):
    size, data = channel
    return struct.unpack("<%d%s" % (len(data) // size, "e" if size == 2 else "f"), data)


def make(name, path):
    random.seed(3)
    noisy = [[random.gauss(0, NOISE) for _ in range(3)] for _ in range(WIDTH * HEIGHT)]
    color = {c: (lambda x, y, k=k: truth(x)[k] + noisy[y * WIDTH + x][k]) for k, c in enumerate("RGB")}
    albedo = {c: (lambda x, y, k=k: truth(x)[k]) for k, c in enumerate("RGB")}
    normal = {c: (lambda x, y, k=k: float(k == 2)) for k, c in enumerate("XYZ")}
    place = {c: (lambda x, y, k=k: (x, y, 0)[k]) for k, c in enumerate("XYZ")}

    def layer(name, values):
        return {name + ("." if name else "") + c: f for c, f in values.items()}
    bare = layer("", color)
    spread = {c: lambda x, y: NOISE * NOISE * SAMPLES for c in "RGB"}
    blender = {**layer("ViewLayer.Combined", {**color, "A": lambda x, y: 1.0}),
               **layer("ViewLayer.Denoising Albedo", albedo), **layer("ViewLayer.Denoising Normal", normal),
               **layer("ViewLayer.Denoising Depth", {"Z": lambda x, y: 1e10 if y < 5 else 5.0})}
    pbrt = {**bare, **layer("Albedo", albedo), **layer("Ns", normal), **layer("P", place), **layer("Variance", spread)}
    mitsuba = {**bare, **layer("albedo", albedo), **layer("sh_normal", normal), **layer("depth", {"T": lambda x, y: 5.0})}
    samples = attribute("samplesPerPixel", "int", struct.pack("<i", SAMPLES)) + attribute("note", "string", b"kept")
    broken = dict(pbrt, R=lambda x, y: (math.nan, math.inf, -math.inf)[x % 3] if (x + 7 * y) % 50 == 0 else color["R"](x, y))
    how = {
        "bare": (bare, {}), "blender": (blender, {}), "pbrt": (pbrt, {"extra": samples}), "mitsuba": (mitsuba, {}),
        "tiles": (pbrt, {"extra": samples, "tile": 32}), "broken": (broken, {"extra": samples}),
        "crop": (pbrt, {"extra": samples, "corner": (-7, 12), "display": (0, 0, 199, 99)}),
        "gray": (layer("", {"Y": color["R"]}), {}),
        "part": (bare, {"extra": attribute("krs:samples", "string", b"0..63/128")}),
    }
    write(path, *how[name][:1], **how[name][1])


def judge(noisy, path):
    before, said = read(noisy)
    after, told = read(path)
    kept = all(after.get(name) == channel for name, channel in before.items())
    own = {"channels", "compression", "tiles", "lineOrder", "name", "type", "version", "chunkCount"}
    kept = kept and all(told.get(name) == value for name, value in said.items() if name not in own)
    error = [0.0, 0.0]
    for k, letter in enumerate("RGB"):
        raw = next(n for n in before if n in (letter, "ViewLayer.Combined." + letter))
        for which, channel in enumerate((before[raw], after["denoised." + letter])):
            for i, number in enumerate(numbers(channel)):
                if math.isfinite(number):
                    error[which] += (number - truth(i % WIDTH)[k]) ** 2
                elif which:
                    error[which] = math.inf
    print("kept" if kept else "changed", "%.4f" % (error[1] / error[0]))


if __name__ == "__main__":
    {"make": make, "judge": judge}[sys.argv[1]](*sys.argv[2:])
