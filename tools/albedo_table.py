#!/usr/bin/env python3
"""albedo_table.py: writes runtime/shared/albedo_table.def.

How much light microfacets reflect, where they mirror all of it: means over the visible normals of
GGX (Heitz 2018) with the masking of Smith, and over the sheen of Estevez and Kulla (2017).
tests/oracle/albedo.c integrates over all normals instead, and compares.
"""
import math

SIDE = 64
POINTS = 192
LEAST_SHEEN = 0.3  # the least roughness of sheen, as in bsdf.glsl


def lambda_of(cosine, alpha):
    """Smith's function for GGX."""
    tangent = max(1 - cosine * cosine, 0) / max(cosine * cosine, 1e-20)
    return 0.5 * (math.sqrt(1 + alpha * alpha * tangent) - 1)


def mirrored(cosine, alpha):
    """The reflected share, and the part of it that Schlick's factor weights."""
    eye = (math.sqrt(1 - cosine * cosine), cosine)
    length = math.hypot(alpha * eye[0], eye[1])
    tall = (alpha * eye[0] / length, eye[1] / length)
    whole = edge = 0.0
    for i in range(POINTS):
        phi = math.pi * (i + 0.5) / POINTS  # the other half is the same
        for k in range(POINTS):
            part = (k + 0.5) / POINTS  # its third power is even, so that steep facets count right
            weight, rise = 3 * part ** 2, part ** 3 * (1 + tall[1])
            ring = math.sqrt(max(1 - (rise - tall[1]) ** 2, 0))
            m = (alpha * (ring * math.cos(phi) + tall[0]), alpha * ring * math.sin(phi),
                 max(rise, 1e-9))
            size = math.sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2])
            facing = (m[0] * eye[0] + m[2] * eye[1]) / size
            leaves = 2 * facing * m[2] / size - eye[1]
            if leaves <= 0:
                continue
            here = 1 + lambda_of(cosine, alpha)
            share = weight * here / (here + lambda_of(leaves, alpha))
            whole += share
            edge += share * max(1 - facing, 0) ** 5
    return whole / POINTS ** 2, edge / POINTS ** 2


def sheen(cosine, alpha):
    """The reflected share of sheen: D of Estevez and Kulla, V of Neubelt and Pettineo."""
    eye = (math.sqrt(1 - cosine * cosine), cosine)
    total = 0.0
    for i in range(POINTS):
        phi = math.pi * (i + 0.5) / POINTS  # the other half is the same
        for k in range(POINTS):
            z = (k + 0.5) / POINTS
            ring = math.sqrt(1 - z * z)
            h = (eye[0] + ring * math.cos(phi), ring * math.sin(phi), eye[1] + z)
            size = math.sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2])
            sine = math.sqrt(max(1 - (h[2] / size) ** 2, 0))
            d = (2 + 1 / alpha) * sine ** (1 / alpha) / (2 * math.pi)
            total += d / (4 * (z + cosine - z * cosine)) * z
    return 2 * math.pi * total / POINTS ** 2


def main():
    print("""/*
 * albedo_table.def: how much light microfacets reflect, where they mirror all of it.
 *
 * tools/albedo_table.py writes this file.  KRS_ALBEDO: the reflected share of GGX; the part of it
 * that Schlick's factor (1 - cosine)^5 weights; and the share of sheen, which may be above 1.
 * Columns are the square roots of cosines, rows are roughnesses, both from 0 to 1 in ALBEDO_SIDE
 * steps.  Those of sheen begin at LEAST_SHEEN_ROUGHNESS (bsdf.glsl).
 */""")
    for row in range(SIDE):
        roughness = row / (SIDE - 1)
        for column in range(SIDE):
            cosine = min(max((column / (SIDE - 1)) ** 2, 1e-4), 0.999999)
            alpha = max(roughness * roughness, 1e-3)
            fuzz = LEAST_SHEEN + (1 - LEAST_SHEEN) * roughness
            numbers = mirrored(cosine, alpha) + (sheen(cosine, fuzz * fuzz),)
            print("KRS_ALBEDO(%.5f, %.5f, %.5f)" % numbers)


main()
