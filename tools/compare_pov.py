#!/usr/bin/env python3
"""Scenes of POV-Ray beside what `krs import` makes of them.

    tools/compare_pov.py /usr/share/doc/povray/examples build/krs compared

Imports every .pov below the first folder, renders it with both programs, and writes a table, best
first, to compared/table.txt, and for each scene that imports a picture to compared/NAME.png: POV-Ray's
and ours as they are shown, above the depths of both.  Scenes that were compared before are not
rendered again: remove their .png for that.  Beside it NAME.png.row has what was measured of a scene,
as JSON: its name and the numbers of its row of the table.

What is measured, of pictures 160 pixels wide:

    outline  share of pixels where both see something, or both nothing
    depth    share of pixels at whose distance the other picture has something, too
    colour   mean difference of channels, from 0 to 1, of the mean colours of squares of 20 pixels
    light    mean light of ours, of what is shown of it, as a part of POV-Ray's

A pixel counts as equal if what is seen there is within the range of the other's 3x3 pixels around it:
pictures of two programs have edges half a pixel apart.  Distances may differ by 2 %.

POV-Ray's distances come from two pictures with a black and a white fog: their difference is
1 - exp(-distance), whatever is seen.  A scene whose camera is inside of something has no fog in
POV-Ray, and no depth here ("-").  Needs povray, and python3-openimageio; not part of the tests.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO

WIDTH = 160
NEAR = 0.02  # how far distances may differ
FAR = 8.0  # fogs end here: distances in units of the fog's


def run(words, seconds, folder=None):
    """The status and what was said; None for a status: it took too long."""
    try:
        done = subprocess.run(["nice"] + words, cwd=folder, timeout=seconds, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.returncode, done.stdout.decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        return None, "took too long"


def pixels(path):
    image = OpenImageIO.ImageBuf(path)
    return image.get_pixels(OpenImageIO.FLOAT), image.spec().channelnames


def write_picture(path, picture):
    height, width, channels = picture.shape
    image = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(width, height, channels, "uint8"))
    image.set_pixels(OpenImageIO.ROI(), numpy.clip(picture, 0, 1).astype("float32"))
    image.write(path)


class Refused(Exception):
    """Why a scene is not compared."""


class Comparison:
    def __init__(self, options, scene, work):
        self.options, self.scene, self.work = options, scene, work
        with open(scene, encoding="latin-1") as file:
            self.text = file.read()

    # ---- the two programs ----

    def ours(self):
        krs, made = self.options.krs, self.work + "/scene.krs"
        status, said = run([krs, "import", "-q", self.scene, "-o", made], 60)
        if status != 0:
            raise Refused("refused: " + said.strip().split("\n")[0].replace(self.scene + ":", "line ", 1))
        with open(made, encoding="utf-8") as file:
            text = file.read()
        size = re.search(r"^image \{ size: \[(\d+), (\d+)\]", text, re.M)
        self.width = WIDTH
        self.height = round(WIDTH * int(size[2]) / int(size[1])) if size else WIDTH * 9 // 16
        eye = re.search(r"^ *eye: \[(.*)\]", text, re.M)
        shown = "%dx%d" % (self.width, self.height)
        for end in ("exr", "png"):
            extra = ["--aov", "Z,P"] if end == "exr" else ["--tone-map", "none"]
            status, said = run([krs, "render", "-q", made, "--size", shown, "--samples", "1", *extra,
                                "-o", self.work + "/ours." + end], self.options.seconds)
            if status != 0:
                raise Refused("not rendered: " + said.strip().split("\n")[-1])
        planes, names = pixels(self.work + "/ours.exr")
        at = {name: planes[..., i] for i, name in enumerate(names)}
        seen = at["A"] > 0.5
        place = numpy.stack([at["P.X"], at["P.Y"], at["P.Z"]], -1)
        if eye and "projection: \"orthographic\"" not in text:
            away = numpy.linalg.norm(place - [float(x) for x in eye[1].split(",")], axis=-1)
        else:
            away = at["Z"]
        return pixels(self.work + "/ours.png")[0][..., :3], numpy.where(seen, away, numpy.inf)

    def theirs(self, name, quality, after, linear=True):
        source, picture = self.work + "/their.pov", self.work + "/" + name
        text = re.sub(r"assumed_gamma\s+[0-9.]+", "assumed_gamma 1", self.text) if linear else self.text
        with open(source, "w", encoding="latin-1") as file:
            file.write(text + "\n" + after)
        status, said = run(["povray", "+I" + source, "+O" + picture, "+FE" if linear else "+FN", "-D", "-A", "-GA", "+WT1",
                            "+W%d" % self.width, "+H%d" % self.height, "+Q%d" % quality,
                            "+L" + os.path.dirname(self.scene), "+L/usr/share/povray-3.7/include"],
                           self.options.seconds, os.path.dirname(self.scene))
        if status != 0:
            said = [line for line in said.split("\n") if "rror" in line or "too long" in line]
            raise Refused("POV-Ray: " + (said[0] if said else "no picture"))
        return pixels(picture)[0][..., :3]

    def their_distances(self, unit):
        fog = "fog { fog_type 1 distance %g color rgb %d }\n" \
              "global_settings { max_trace_level 1 assumed_gamma 1 }\n"
        through = 1 - (self.theirs("white.exr", 9, fog % (unit, 1)) -
                       self.theirs("black.exr", 9, fog % (unit, 0))).mean(-1)
        if numpy.median(through) > 0.999:
            return None  # there is no fog where the camera is inside of something
        away = -numpy.log(numpy.clip(through, numpy.exp(-FAR), 1)) * unit
        return numpy.where(away > 0.9 * FAR * unit, numpy.inf, away)

    # ---- what is measured ----

    @staticmethod
    def around(picture):
        """The least and the most of 3x3 pixels."""
        height, width = picture.shape
        wide = numpy.pad(picture, 1, mode="edge")
        parts = [wide[i:i + height, k:k + width] for i in range(3) for k in range(3)]
        return numpy.min(parts, 0), numpy.max(parts, 0)

    def agree(self, one, other, slack):
        low, high = self.around(other)
        there = (one >= low * (1 - slack)) & (one <= high * (1 + slack))
        low, high = self.around(one)
        return there & (other >= low * (1 - slack)) & (other <= high * (1 + slack))

    @staticmethod
    def squares(picture, size=20):
        """Mean colours of squares; those at the end are narrower."""
        rows = numpy.add.reduceat(picture, range(0, picture.shape[0], size), 0)
        sums = numpy.add.reduceat(rows, range(0, picture.shape[1], size), 1)
        ones = numpy.ones(picture.shape[:2] + (1,))
        parts = numpy.add.reduceat(ones, range(0, picture.shape[0], size), 0)
        return sums / numpy.add.reduceat(parts, range(0, picture.shape[1], size), 1)

    @staticmethod
    def light(picture):
        """The mean light of values as they are shown: a few stars are as bright as a dim sky."""
        return numpy.where(picture > 0.04045, ((picture + 0.055) / 1.055) ** 2.4, picture / 12.92).mean()

    def measure(self, picture):
        shown, away = self.ours()
        seen = numpy.isfinite(away)
        unit = float(numpy.median(away[seen])) if seen.any() else 1.0
        far = 0.9 * FAR * unit
        away = numpy.where(away > far, numpy.inf, away)
        distance = self.their_distances(unit)
        full = self.theirs("full.png", 9, "", linear=False)
        row = {"light": self.light(shown) / max(self.light(full), 1e-3),
               "color": numpy.abs(self.squares(full) - self.squares(shown)).mean()}
        if distance is None:
            distance = numpy.zeros_like(away)
        else:
            their_seen = numpy.isfinite(distance)
            row["outline"] = self.agree(seen.astype(float), their_seen.astype(float), 0).mean()
            big = 1e9 * unit
            row["depth"] = self.agree(numpy.minimum(away, big), numpy.minimum(distance, big),
                                      NEAR).mean()
        gray = [numpy.repeat(numpy.exp(-d / unit)[..., None], 3, -1) for d in (distance, away)]
        write_picture(picture, numpy.concatenate(
            [numpy.concatenate(pair, 1) for pair in ([full, shown], gray)], 0))
        return row


def line(name, row):
    cells = [("%6.3f" % row[c] if c in row else "     -") for c in ("depth", "outline", "color", "light")]
    return "%s  %s" % ("  ".join(cells), name)


def main():
    parser = argparse.ArgumentParser(description="POV-Ray's scenes beside what krs makes of them.")
    parser.add_argument("scenes", help="folder of .pov, or one of them")
    parser.add_argument("krs")
    parser.add_argument("output", help="folder for the table and the pictures")
    parser.add_argument("--seconds", type=float, default=60, help="longest time of one picture")
    options = parser.parse_args()
    options.krs = os.path.abspath(options.krs)
    os.makedirs(options.output, exist_ok=True)
    found = [options.scenes] if options.scenes.endswith(".pov") else sorted(
        os.path.join(folder, name) for folder, _, names in os.walk(options.scenes)
        for name in names if name.endswith(".pov"))
    base = os.path.dirname(options.scenes) if options.scenes.endswith(".pov") else options.scenes
    rows, refused = [], []
    for scene in found:
        name = os.path.relpath(scene, base)
        picture = os.path.join(options.output, name[:-4].replace("/", "-") + ".png")
        kept = picture + ".row"
        if os.path.exists(picture) and os.path.exists(kept):
            with open(kept, encoding="utf-8") as file:
                rows.append(json.load(file))
            continue
        with tempfile.TemporaryDirectory() as work:
            try:
                row = Comparison(options, os.path.abspath(scene), work).measure(os.path.abspath(picture))
            except Refused as why:
                refused.append((name, str(why)))
                print("                                  %s: %s" % refused[-1], flush=True)
                continue
        rows.append((name, {key: float(value) for key, value in row.items()}))
        with open(kept, "w", encoding="utf-8") as file:
            json.dump(rows[-1], file)
        print(line(*rows[-1]), flush=True)
    rows.sort(key=lambda row: -row[1].get("depth", -1))
    with open(os.path.join(options.output, "table.txt"), "w", encoding="utf-8") as table:
        table.write(" depth  outline  colour   light  scene\n")
        table.writelines(line(*row) + "\n" for row in rows)
        table.writelines("%s: %s\n" % pair for pair in refused)
    good = sum(row[1].get("depth", 0) >= 0.95 for row in rows)
    print("%d compared, %d of them have 95 %% of their pixels at the same distance; %d not compared" %
          (len(rows), good, len(refused)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
