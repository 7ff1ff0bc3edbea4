#!/usr/bin/env python3
"""anisotropic_albedo_table.py: writes runtime/shared/anisotropic_albedo_table.def.

How much light microfacets reflect that are wider along one direction than across, where they mirror
all of it: means over the visible normals of GGX (Heitz 2018) with the masking of Smith.
tests/oracle/anisotropy.c integrates over all normals instead, and compares.
"""
import math

COSINES = 12
ROUGHNESSES = 16
ANISOTROPIES = 5
AZIMUTHS = 4
POINTS, STEP = 10946, 6765  # of a lattice by Fibonacci, which has no rows


def widths(roughness, anisotropy):
    """Those of OpenPBR."""
    across = 1 - anisotropy
    along = roughness * roughness * math.sqrt(2 / (1 + across * across))
    return max(along, 1e-3), max(across * along, 1e-3)


def hidden(v, alpha):
    """Smith's function for GGX."""
    slope = (alpha[0] * v[0]) ** 2 + (alpha[1] * v[1]) ** 2
    return 0.5 * (math.sqrt(1 + slope / max(v[2] * v[2], 1e-20)) - 1)


def unit(x, y, z):
    size = math.sqrt(x * x + y * y + z * z)
    return x / size, y / size, z / size


def mirrored(eye, alpha):
    """The reflected share, and the part of it that Schlick's factor weights."""
    tall = unit(alpha[0] * eye[0], alpha[1] * eye[1], eye[2])
    here = 1 + hidden(eye, alpha)
    whole = edge = 0.0
    for i in range(POINTS):
        phi = 2 * math.pi * (i * STEP % POINTS + 0.5) / POINTS
        z = (1 - (i + 0.5) / POINTS) * (1 + tall[2]) - tall[2]
        ring = math.sqrt(max(1 - z * z, 0))
        m = unit(alpha[0] * (ring * math.cos(phi) + tall[0]),
                 alpha[1] * (ring * math.sin(phi) + tall[1]), max(z + tall[2], 1e-9))
        facing = m[0] * eye[0] + m[1] * eye[1] + m[2] * eye[2]
        light = [2 * facing * m[j] - eye[j] for j in range(3)]
        if light[2] <= 0:
            continue
        share = here / (here + hidden(light, alpha))
        whole += share
        edge += share * max(1 - facing, 0) ** 5
    return whole / POINTS, edge / POINTS


def cell(anisotropy, roughness, column):
    """For a cosine: both shares at all azimuths, in thousandths."""
    cosine = min(max((column / (COSINES - 1)) ** 2, 1e-3), 0.999999)
    sine = math.sqrt(1 - cosine * cosine)
    alpha = widths(roughness / (ROUGHNESSES - 1), anisotropy / (ANISOTROPIES - 1))
    shares = []
    for i in range(AZIMUTHS):
        along = math.sqrt(i / (AZIMUTHS - 1))
        across = math.sqrt(1 - i / (AZIMUTHS - 1))
        shares.append(mirrored((sine * along, sine * across, cosine), alpha))
    return [round(1000 * s[0]) for s in shares] + [round(1000 * s[1]) for s in shares]


def main():
    print("""/*
 * anisotropic_albedo_table.def: how much light microfacets reflect that are wider along a tangent.
 *
 * tools/anisotropic_albedo_table.py writes this file.  KRS_ALBEDO has two cosines, whose square
 * roots are from 0 to 1.  Of each there are, in thousandths, the reflected share at four azimuths,
 * and the part of it that Schlick's factor weights.  The squared cosines of azimuths are 0, 1/3,
 * 2/3 and 1.  Roughnesses follow each other, and for each anisotropy all of them.
 */""")
    for anisotropy in range(ANISOTROPIES):
        for roughness in range(ROUGHNESSES):
            for column in range(0, COSINES, 2):
                pair = cell(anisotropy, roughness, column) + cell(anisotropy, roughness, column + 1)
                print("KRS_ALBEDO(%s)" % ", ".join(str(number) for number in pair))


main()
