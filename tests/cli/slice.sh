#!/bin/sh
# slice.sh: `krs slice`: files that other programs accept, their areas, and what is refused.
. "$(dirname "$0")/common.sh"
plan 66
find_untrusted

# None of these files is there.
no_files() {
    for name in "$@"; do
        [ ! -e "$name" ] || return 1
    done
}

echo 'show sphere(0.5);' >ball.krs
echo 'show box([4, 3, 2]) - cylinder(1, 5).rotate([1, 0, 0], 90deg);' >plate.krs
echo 'let floor = half_space([0, 1, 0], 0); show floor; let ball = sphere(1); show ball;' >floor.krs
echo 'camera { eye: [0, 0, 5] }' >empty.krs

# Areas of files, by readers that share nothing with krs: areas FILE prints one for each layer.
cat >areas.py <<'END'
import math, re, struct, sys, zlib
def shoelace(points):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2
def sector(a, b, radius, large, sweep): # between an arc and its chord; y is downwards
    half = math.asin(min(1, math.hypot(b[0] - a[0], b[1] - a[1]) / 2 / radius))
    angle = 2 * (math.pi - half if large else half)
    return (1 if sweep else -1) * radius ** 2 / 2 * (angle - math.sin(angle))
def bulged(a, b, bulge):
    if bulge == 0:
        return 0
    chord, angle = math.hypot(b[0] - a[0], b[1] - a[1]), 4 * math.atan(bulge)
    return (chord / 2 / math.sin(angle / 2)) ** 2 / 2 * (angle - math.sin(angle))
def svg(text):
    import xml.etree.ElementTree as tree
    for group in tree.fromstring(text.encode()):
        area = 0
        for path in group:
            for part in path.get("d").split("Z"):
                points = []
                for kind, words in re.findall(r"([MLA])([^MLA]*)", part):
                    numbers = [float(x) for x in words.split()]
                    points.append(numbers[-2:])
                    if kind == "A":
                        area -= sector(points[-2], points[-1], numbers[0], numbers[3], numbers[4])
                area -= shoelace(points)
        yield area
def cli(text):
    area, count = None, 0
    for line in text.split("\n"):
        if line.startswith("$$LAYER/"): # the first tells where the second begins
            if area is not None:
                assert count > 1 or area == 0
                yield from [area] if count > 1 else []
            area, count = 0, count + 1
        if line.startswith("$$POLYLINE/"):
            numbers = [float(x) for x in line[11:].split(",")]
            points = list(zip(numbers[3::2], numbers[4::2]))
            assert len(points) == numbers[2] and points[0] == points[-1]
            assert (shoelace(points) > 0) == (numbers[1] == 1)
            area += shoelace(points)
    yield area
def dxf(text):
    words = text.split("\n")
    areas, points, layer = {}, [], None
    for code, value in zip(words[::2], words[1::2]):
        if code == "0":
            if value == "POLYLINE":
                points = []
            if value == "SEQEND":
                pieces = zip(points, points[1:] + points[:1])
                areas[layer] = areas.get(layer, 0) + shoelace(points) + sum(bulged(a, b, a[2]) for a, b in pieces)
            kind = value
        if code == "8":
            layer = value
        if code == "10" and kind == "VERTEX":
            points.append([float(value), 0, 0])
        if code == "20" and kind == "VERTEX":
            points[-1][1] = float(value)
        if code == "42":
            points[-1][2] = float(value)
    return areas.values()
def png(data):
    at, pixels = 8, b""
    while at < len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and color == 0
        if kind == b"pHYs":
            scale = struct.unpack(">I", body[:4])[0] / 1000
        if kind == b"IDAT":
            pixels += body
        at += 12 + length
    raw, above, total = zlib.decompress(pixels), [0] * width, 0
    for y in range(height):
        row = list(raw[y * (width + 1) + 1:(y + 1) * (width + 1)])
        how = raw[y * (width + 1)]
        assert how in (0, 2)
        if how == 2:
            row = [(a + b) % 256 for a, b in zip(row, above)]
        above, total = row, total + sum(row)
    return [total / 255 / scale ** 2]
path = sys.argv[1]
data = open(path, "rb").read()
read = {"svg": svg, "cli": cli, "dxf": dxf, "png": png}[path.rsplit(".", 1)[1]]
print(*("%.6f" % area for area in read(data if path.endswith("png") else data.decode())))
END
# Whether the areas of a file are these, up to an error: areas_are FILE ERROR AREA...
areas_are() {
    file=$1 near=$2
    shift 2
    python3 areas.py "$file" >areas.txt 2>err || return 1
    echo "$@" | tr ' ' '\n' >wanted.txt
    tr ' ' '\n' <areas.txt | paste - wanted.txt |
        awk -v near="$near" '{ if (NF != 2 || ($1 - $2)^2 > near^2) bad = 1 } END { exit bad || NR == 0 }'
}

run slice --quiet plate.krs --layer 0.5 -o p.svg -o p.dxf -o p.cli -o 'p-%03d.png' --error 0.0005 --resolution 50 --exposure gray
[ "$status" -eq 0 ] && [ -s p.svg ] && [ -s p.dxf ] && [ -s p.cli ] && [ -s p-001.png ] && [ -s p-004.png ] &&
    [ ! -e p-005.png ] && [ ! -s err ]
result $? "files of all formats, and a picture of each layer"
if command -v python3 >/dev/null; then
    hole=8.858407
    for file in p.svg p.dxf p.cli; do
        areas_are $file 0.004 $hole $hole $hole $hole
        result $? "$file has the area of each layer"
    done
    areas_are p-003.png 0.004 $hole
    result $? "pictures in gray have it, too"
    run slice --quiet plate.krs --layer 0.5 -o 'b-%d.png' --resolution 50
    areas_are b-2.png 0.1 $hole
    result $? "and those in black and white about so"
    run slice --quiet ball.krs --layer 0.02 -o b.cli --error 0.0001
    python3 areas.py b.cli | tr ' ' '\n' | awk '{ volume += 0.02 * $1 } END { d = volume - 0.5235988; exit !(d * d < 0.0004^2 && NR == 50) }'
    result $? "layers of a ball add up to its volume"
    run slice --quiet plate.krs --plane=0,0,0,1,1,1 -o c.svg --error 0.001
    # The plane cuts the box in a hexagon, less an ellipse.
    [ "$status" -eq 0 ] && python3 areas.py c.svg >out && [ "$(wc -w <out)" -eq 1 ]
    result $? "one section of a plane"
    run slice --quiet plate.krs --axis y --layer 3 -o y.svg
    areas_are y.svg 0.001 4
    result $? "layers along another axis, in the middle of what is thinner than a layer"
    run slice plate.krs --plane=0,0,0,0,0,1 -o -
    cp out o.svg
    areas_are o.svg 0.01 $hole
    result $? "SVG goes to standard output"
    run slice --quiet plate.krs --plane=0,0,7,0,0,1 -o e.svg -o e.dxf -o e.png
    said 1 "nothing to write: \`plate.krs\` has nothing solid in this plane" "a plane that misses the solid has no section"
    no_files e.svg e.dxf e.png
    result $? "and writes nothing"
    run slice --quiet plate.krs --plane=0,0,1,0,0,1 -o t.svg
    areas_are t.svg 0.02 $hole
    result $? "and the plane of a face has the face"
else
    for i in 1 2 3 4 5 6 7 8 9 10 11 12; do skip "areas of files, $i" "no python3"; done
fi
# The most memory of a command, in kilobytes: memory_of KRS-ARGUMENTS...
memory_of() {
    python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$krs" "$@" 2>err
}
if command -v python3 >/dev/null; then
    echo 'param height = 6 in [6, 60]; show sphere(0.4).repeat(1) & box([8, 8, height]);' >lattice.krs
    low=$(memory_of slice --quiet lattice.krs --layer 0.4 --error 0.02 -o l.cli)
    high=$(memory_of slice --quiet lattice.krs --layer 0.4 --error 0.02 --set height=60 -o h.cli)
    [ "$(grep -c LAYER/ h.cli)" -eq 151 ] && [ "$high" -lt $((low * 5 / 4)) ]
    result $? "ten times the layers take no more memory"
else
    skip "ten times the layers take no more memory" "no python3"
fi
# What another program finds of a mesh.
cat >flange.krs <<'END'
let foot = box([4, 0.7, 2.4]).round(0.15);
let bores = [cylinder(0.3, 2).move([side * 1.45, 0, 0]) for side in [-1, 1]];
show difference(union(foot, cylinder(0.85, 2).move([0, 0.9, 0]), blend: 0.5), cylinder(0.5, 5), bores);
END
if command -v python3 >/dev/null && command -v admesh >/dev/null; then
    run slice --quiet flange.krs --layer 0.02 --axis y -o flange.cli
    run mesh --quiet flange.krs --even --error 0.004 -o flange.stl
    admesh flange.stl >out
    python3 areas.py flange.cli | tr ' ' '\n' >areas.txt
    sed -n 's/.*Volume *: *\([0-9.]*\).*/\1/p' out | cat - areas.txt |
        awk 'NR == 1 { wanted = $1; next } { volume += 0.02 * $1 }
             END { print volume, wanted; d = volume / wanted - 1; exit !(wanted > 1 && d * d < 0.003^2) }' >found
    result $? "layers have the volume that admesh finds of the mesh"
else
    skip "layers have the volume that admesh finds of the mesh" "no admesh or python3"
fi
echo 'show rectangle([4, 3]).round(0.5) - circle(0.5);' >figure.krs
run slice --quiet figure.krs -o f.svg -o f.dxf
ended 0 "plane figures are sections"
[ "$(grep -o ' A' f.svg | wc -l)" -eq 6 ] && [ "$(grep -o ' L' f.svg | wc -l)" -eq 3 ] &&
    [ "$(grep -c '^42$' f.dxf)" -eq 6 ]
result $? "with lines as lines and arcs as arcs"
if command -v python3 >/dev/null; then
    areas_are f.svg 0.0001 11 && areas_are f.dxf 0.0001 11
    result $? "which have their area"
else
    skip "which have their area" "no python3"
fi
run slice figure.krs --layer 0.1
said 2 "neither --layer" "figures have no layers"
echo 'let plate = rectangle([4, 3]); show plate; show sphere(1);' >both.krs
run slice both.krs
said 2 "figures and solids" "figures are not cut with solids"
run slice --quiet both.krs --component plate -o plate.svg
ended 0 "but alone"
run mesh figure.krs
said 1 "cannot be shown" "other commands have nothing to show of them"
if command -v xmllint >/dev/null; then
    xmllint --noout p.svg 2>err
    result $? "SVG is XML"
else
    skip "SVG is XML" "no xmllint"
fi
run slice --quiet plate.krs --plane=0,0,0,0,0,1 -o in.svg -o in.dxf -o in.cli --units in
grep -q 'width="4in" height="3in"' in.svg && grep -q '^..UNITS/25.4' in.cli && [ "$(sed -n '/INSUNITS/{n;n;p;}' in.dxf)" = 1 ]
result $? "files say their units"
run slice --quiet ball.krs --layer 0.5 --size 64x32 --resolution 10 -o 's-%d.png'
[ "$(od -A n -t u1 -j 16 -N 8 s-1.png | tr -d ' \n')" = 0006400032 ]
result $? "pictures are as large as is asked"
grep -c 'POLYLINE' p.cli | grep -qx 8
result $? "a hole is a contour of its own"

run slice ball.krs
said 2 "--layer 0.05" "layers have a thickness"
run slice ball.krs --layer 0.1 --plane=0,0,0,0,0,1
said 2 "and --plane one" "which one section has not"
run slice ball.krs --layer 0.1 -o a.png
said 2 "%04d" "a picture has one layer"
run slice ball.krs --layer 0.1 -o 'a-%d-%d.svg'
said 2 "more than one place" "and a name one number"
run slice ball.krs --layer 0.1 -o a.xyz
said 2 ".svg, .dxf, .cli or .png" "formats are named"
run slice ball.krs --layer 1e-9 -o a.svg
said 2 "too thin" "layers are not without number"
run slice ball.krs --layer 0.1 -o 'a-%d.png' --resolution 1e8
said 2 "too large" "nor are pixels"
run slice ball.krs --layer nan -o a.svg
said 2 "--layer wants a length" "what is no number is refused"
run slice ball.krs --plane=0,0,0,0,0,0 -o a.svg
said 2 "--plane wants" "and what is no direction"
! grep -q 'not.*not' err
result $? "in words without two nots"
for name in 'a-%x.svg' 'a-%-4d.svg' 'a-%04i.svg'; do
    run slice ball.krs --layer 0.1 -o "$name"
    said 2 "no place for the number" "$name is no name"
done
run slice ball.krs --layer 0.1 -o a.svg -o ./a.svg
said 2 "are one file" "a file is written once"
run slice ball.krs --layer 0.1 -o 'a-%d.svg' -o 'a-%02d.svg'
said 2 "are one file" "also where it is so from some layer on"
run slice ball.krs --layer 0.1 --error 1e-12 -o a.svg
said 2 "--error is too small" "and an error that numbers cannot tell"
run slice floor.krs --layer 0.1
said 2 "one that has: \`ball\`" "what has no end is refused"
run slice --quiet floor.krs --layer 0.5 --within=-2,-2,-2,2,2,2 -o w.svg
[ "$status" -eq 0 ] && { ! command -v python3 >/dev/null || { python3 areas.py w.svg >out && [ "$(wc -w <out)" -eq 8 ]; }; }
result $? "but not what of it is in a box"
run slice empty.krs --layer 0.1
said 1 "nothing to write" "nothing has no sections"
echo 'show box([1, 1, 1]) - box([2, 2, 2]);' >blank.krs
for command in "slice --layer 0.1 -o n.svg" "mesh -o n.stl" "grid -o n.npy" "info --print"; do
    # shellcheck disable=SC2086 # words are meant
    run ${command%% *} blank.krs ${command#* }
    said 1 "\`blank.krs\` has nothing solid" "${command%% *} says what is empty as all do"
done
no_files n.svg n.stl n.npy
result $? "and writes no file"
run slice ball.krs --layer 0.4 --error 1000 -o 'm-%d.svg' -o m.cli
said 1 "--error is larger than the scene" "what the error leaves nothing of is no file"
no_files m-1.svg m.cli
result $? "not even for its first layer"
echo 'show rectangle([1, 1]) - rectangle([2, 2]);' >none.krs
run slice none.krs -o n.svg
said 1 "a figure without area" "nor is a figure without area"
echo 'show text("");' >letters.krs
run slice letters.krs -o n.svg
said 1 "a figure without area" "or without letters"
grep -q 'this .text. is empty' err
result $? "which are warned of"
run slice ball.krs --plane=0,0,0,0,0,1 --axis x
said 2 "--axis is that of --layer" "a plane has no axis"
echo 'show sphere(0.2).move([0, 0, -1]); show sphere(0.2).move([0, 0, 1]);' >gap.krs
run slice --quiet gap.krs --layer 0.2 -o 'g-%02d.svg' -o g.cli
[ "$status" -eq 0 ] && [ -s g-06.svg ] && [ "$(grep -c LAYER/ g.cli)" -eq 13 ] && ! grep -q '<path' g-06.svg
result $? "layers between parts are empty"
echo 'show sphere(0.4).repeat(1) & box([4, 4, 4]);' >between.krs
run slice --quiet between.krs --layer 1 -o n.svg
said 1 "nothing solid in the planes of its layers" "layers between all parts are said to be so"
run slice --quiet both.krs --component 1 -o n.svg
cmp n.svg plate.svg
result $? "a component may be told by its number"
# All files are of the same sections, and as each alone.
for file in a.svg a.dxf a.cli; do run slice --quiet plate.krs --layer 0.5 -o "$file" --error 0.001 --resolution 50; done
run slice --quiet plate.krs --layer 0.5 -o 'a-%d.png' --error 0.001 --resolution 50
run slice --quiet plate.krs --layer 0.5 --error 0.001 --resolution 50 -o 'b-%d.png' -o b.svg -o b.dxf -o 'c-%d.svg' -o b.cli
cmp a.svg b.svg && cmp a.dxf b.dxf && cmp a.cli b.cli && cmp a-2.png b-2.png && [ -s c-4.svg ]
result $? "many files at once are what each is alone"
ln -s /dev/full full.cli
run slice --quiet plate.krs --layer 0.5 -o one.svg -o full.cli -o 'two-%d.svg'
said 74 "No space left" "a full disk is told"
no_files one.svg && no_temporaries
result $? "and files of all layers are not written then"
run check figure.krs
ended 0 "what can be cut is accepted by check"
run info figure.krs
[ "$status" -eq 0 ] && grep -q 'figure .*krs slice' out
result $? "and told by info"
mkdir inside && cp ball.krs inside && ln -s ../outside.svg inside/link.svg
run slice --quiet "$untrusted" inside/ball.krs --layer 0.5 -o inside/link.svg
[ "$status" -eq 73 ] && [ ! -e outside.svg ]
result $? "with --untrusted nothing is written through a link"
run slice --quiet ball.krs --layer 0.5 -o missing/a.svg
[ "$status" -eq 73 ] && no_temporaries
result $? "a folder that is missing is told"
