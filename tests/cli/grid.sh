#!/bin/sh
# grid.sh: `krs grid`: files as their formats want them, what other programs read of them, and what is refused.
. "$(dirname "$0")/common.sh"
plan 55
find_untrusted

echo 'material red { color: [1, 0, 0] } show sphere(0.5).move([0.25, 0, 0]).paint(red);' >ball.krs
echo 'let floor = half_space([0, 1, 0], 0); show floor; let ball = sphere(1); show ball;' >floor.krs
echo 'camera { eye: [0, 0, 5] }' >empty.krs

# Readers that share nothing with krs: each finds the volume and the first sample, and compares samples with the distance
# from a ball.
cat >read.py <<'END'
import math, re, struct, sys
def ball(x, y, z):
    return math.sqrt((x - 0.25) ** 2 + y * y + z * z) - 0.5
def check(count, first, cell, values, band=math.inf):
    n = 0
    for k in range(count[2]):
        for j in range(count[1]):
            for i in range(count[0]):
                truth = ball(*(first[a] + cell * (i, j, k)[a] for a in range(3)))
                truth = max(-band, min(band, truth))
                assert abs(values[n] - truth) < 1e-6, (i, j, k, values[n], truth)
                n += 1
    assert n == len(values)
def floats(data):
    return struct.unpack("<%df" % (len(data) // 4), data)
def npy(data, records):
    assert data[:8] == b"\x93NUMPY\x01\x00"
    length, = struct.unpack("<H", data[8:10])
    assert (10 + length) % 64 == 0 and data[9 + length:10 + length] == b"\n"
    head = eval(data[10:10 + length])
    count = head["shape"][::-1]
    assert not head["fortran_order"]
    body = data[10 + length:]
    if not records:
        assert head["descr"] == "<f4"
        return count, floats(body)
    assert head["descr"] == [("distance", "<f4"), ("color", "<f4", (3,)), ("material", "<u4")]
    assert len(body) == 20 * count[0] * count[1] * count[2]
    found = list(struct.iter_unpack("<4fI", body))
    assert all(f[1:] == (1, 0, 0, 1) for f in found)
    return count, [f[0] for f in found]
def nii(data):
    assert struct.unpack("<i", data[:4])[0] == 348 and data[344:348] == b"n+1\0"
    dim = struct.unpack("<8h", data[40:56])
    kind, bits = struct.unpack("<2h", data[70:74])
    pixdim, begin = struct.unpack("<8f", data[76:108]), struct.unpack("<f", data[108:112])[0]
    assert (kind, bits, begin, data[123]) == (16, 32, 352, 2) and pixdim[0] == 1
    qform, sform = struct.unpack("<2h", data[252:256])
    rows = struct.unpack("<12f", data[280:328])
    assert qform == sform == 1 and struct.unpack("<3f", data[256:268]) == (0, 0, 0)
    assert struct.unpack("<3f", data[268:280]) == (rows[3], rows[7], rows[11])
    assert rows[0] == rows[5] == rows[10] == pixdim[1] and rows[1] == rows[2] == rows[4] == 0
    return dim, rows, floats(data[352:])
def ktx2(data, channels):
    # Fields as sections 3 and 5 of the KTX 2.0 specification have them, and the Khronos Data Format 1.3.
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    form, size, w, h, d, layers, faces, levels, packed = struct.unpack("<9I", data[12:48])
    assert form == {1: 100, 4: 109}[channels] and (size, layers, faces, levels, packed) == (4, 0, 1, 1, 0)
    dfd, dfd_size, kvd, kvd_size, sgd, sgd_size = struct.unpack("<4I2Q", data[48:80])
    at, length, plain = struct.unpack("<3Q", data[80:104])
    assert dfd == 104 and sgd == sgd_size == 0 and length == plain == 4 * channels * w * h * d
    assert at % math.lcm(4, 4 * channels) == 0 and at + length == len(data)
    total, vendor, version, size = struct.unpack("<IIHH", data[dfd:dfd + 12])
    assert total == dfd_size and vendor == 0 and version == 2 and size == 24 + 16 * channels == total - 4
    assert data[dfd + 12:dfd + 28] == bytes([1, 1, 1, 0, 0, 0, 0, 0, 4 * channels] + 7 * [0])
    for c in range(channels):
        offset, bits, kind, place, low, high = struct.unpack("<HBBIff", data[dfd + 28 + 16 * c:dfd + 44 + 16 * c])
        assert (offset, bits, kind, place, low, high) == (32 * c, 31, [0, 1, 2, 15][c] | 0xC0, 0, -1, 1)
    keys, end = {}, kvd + kvd_size
    while kvd < end:
        length, = struct.unpack("<I", data[kvd:kvd + 4])
        key, value = data[kvd + 4:kvd + 4 + length].split(b"\0", 1)
        keys[key.decode()] = value.rstrip(b"\0").decode()
        kvd += 4 + (length + 3) // 4 * 4
    assert kvd == end and list(keys) == sorted(keys) and keys["KTXorientation"] == "ruo"
    box = [float(x) for x in keys["krs.box"].split(",")]
    cell = (box[3] - box[0]) / w
    return (w, h, d), [b + cell / 2 for b in box[:3]], cell, floats(data[at:])
def vtk(data):
    text, raw = data.split(b'<AppendedData encoding="raw">\n_', 1)
    arrays = {}
    for kind, name, parts, at in re.findall(rb'type="(\w+)" Name="(\w+)" NumberOfComponents="(\d)" format="appended" offset="(\d+)"', text):
        at = int(at)
        length, = struct.unpack("<Q", raw[at:at + 8])
        letter = {b"Float32": "f", b"Int64": "q", b"UInt32": "I", b"UInt8": "B"}[kind]
        body = raw[at + 8:at + 8 + length]
        assert len(body) == length
        arrays[name.decode()] = struct.unpack("<%d%s" % (length // struct.calcsize("<" + letter), letter), body)
        end = at + 8 + length
    assert raw[end:] == b"\n</AppendedData>\n</VTKFile>\n"
    return text.decode(), arrays
def vti(data):
    text, arrays = vtk(data)
    extent = re.search(r'WholeExtent="0 (\d+) 0 (\d+) 0 (\d+)"', text).groups()
    origin = [float(x) for x in re.search(r'Origin="([^"]*)"', text).group(1).split()]
    spacing = [float(x) for x in re.search(r'Spacing="([^"]*)"', text).group(1).split()]
    assert arrays["color"][:6] == (1, 0, 0, 1, 0, 0) and set(arrays["material"]) == {1}
    return [int(e) + 1 for e in extent], origin, spacing[0], arrays["distance"]
def vtu(data, cell):
    text, arrays = vtk(data)
    points, cells = (int(x) for x in re.search(r'NumberOfPoints="(\d+)" NumberOfCells="(\d+)"', text).groups())
    at, corners = arrays["points"], arrays["connectivity"]
    assert len(at) == 3 * points and len(corners) == 8 * cells
    assert arrays["offsets"] == tuple(range(8, 8 * cells + 8, 8)) and set(arrays["types"]) == {12}
    place = [at[3 * i:3 * i + 3] for i in range(points)]
    order = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    for i in range(points):
        truth = max(-3 * cell, min(3 * cell, ball(*place[i])))
        assert abs(arrays["distance"][i] - truth) < 1e-6
    crossed = set()
    for c in range(0, len(corners), 8):
        first = place[corners[c]]
        for k in range(8):
            assert all(abs(place[corners[c + k]][a] - first[a] - cell * order[k][a]) < 1e-6 for a in range(3))
        if min(arrays["distance"][n] for n in corners[c:c + 8]) < 0 <= max(arrays["distance"][n] for n in corners[c:c + 8]):
            crossed.add(tuple(round(x / cell) for x in first))
    # Every cell that the surface crosses is there, by brute force.
    n = round(1 / cell) + 2
    for i in range(-n, n):
        for j in range(-n, n):
            for k in range(-n, n):
                signs = {ball((i + o[0]) * cell, (j + o[1]) * cell, (k + o[2]) * cell) < 0 for o in order}
                assert (len(signs) == 2) == ((i, j, k) in crossed), (i, j, k)
what, data = sys.argv[1], open(sys.argv[2], "rb").read()
if what == "npy":
    count, values = npy(data, False)
    check(count, [float(x) for x in sys.argv[3].split(",")], float(sys.argv[4]), values)
if what == "records":
    count, values = npy(data, True)
    check(count, [float(x) for x in sys.argv[3].split(",")], float(sys.argv[4]), values)
if what == "nii":
    dim, rows, values = nii(data)
    assert dim[0] == 3 and abs(rows[0] - float(sys.argv[3])) < 1e-6
    scale = rows[0] / float(sys.argv[4])
    check(dim[1:4], [rows[3] / scale, rows[7] / scale, rows[11] / scale], float(sys.argv[4]), values)
if what == "volumes":
    dim, rows, values = nii(data)
    n = dim[1] * dim[2] * dim[3]
    assert dim[0] == 4 and dim[4] == 5 and len(values) == 5 * n
    assert [set(values[v * n:(v + 1) * n]) for v in range(1, 5)] == [{1}, {0}, {0}, {1}]
if what == "ktx2":
    check(*ktx2(data, 1))
if what == "rgba":
    count, first, cell, values = ktx2(data, 4)
    assert set(values[0::4]) == {1} and set(values[1::4]) == set(values[2::4]) == {0}
    check(count, first, cell, values[3::4])
if what == "vti":
    check(*vti(data))
if what == "vtu":
    vtu(data, float(sys.argv[3]))
END
first() { sed -n 's/.*from \[\(.*\)\] on.*/\1/p' err | tr -d ' '; }
# A Python that has a module: python_with MODULE
python_with() {
    for python in python3 /usr/bin/python3; do
        "$python" -c "import $1" 2>/dev/null && return 0
    done
    return 1
}
if command -v python3 >/dev/null; then
    run grid ball.krs --cell 0.0625 -o b.npy
    python3 read.py npy b.npy "$(first)" 0.0625 2>err
    result $? "NumPy's file has the distances"
    run grid ball.krs --cell 0.0625 -o r.npy --surface-color --material
    python3 read.py records r.npy "$(first)" 0.0625 2>err
    result $? "and with colours and materials records"
    run grid ball.krs --cell 0.0625 -o b.nii --units cm
    python3 read.py nii b.nii 0.625 0.0625 2>err
    result $? "NIfTI has them in millimetres"
    run grid --quiet ball.krs --cell 0.125 -o v.nii --surface-color --material && python3 read.py volumes v.nii 2>err
    result $? "and the rest as volumes"
    run grid --quiet ball.krs --cell 0.0625 -o b.ktx2 && python3 read.py ktx2 b.ktx2 2>err
    result $? "KTX 2.0 has all fields of its specification"
    run grid --quiet ball.krs --cell 0.0625 -o c.ktx2 --surface-color && python3 read.py rgba c.ktx2 2>err
    result $? "and colours with them"
    run grid --quiet ball.krs --cell 0.0625 -o b.vti --surface-color --material && python3 read.py vti b.vti 2>err
    result $? "VTK's images have them"
    run grid --quiet ball.krs --cell 0.0625 -o b.vtu && python3 read.py vtu b.vtu 0.0625 2>err
    result $? "VTK's cells are all that the surface crosses"
else
    for i in 1 2 3 4 5 6 7 8; do skip "files of all formats, $i" "no python3"; done
fi

# ---- other programs ----
if python_with numpy; then
    run grid --quiet ball.krs --cell 0.0625 -o n.npy --fog --surface-color
    "$python" -c "
import numpy
a = numpy.load('n.npy')
assert a['color'].shape == a['density'].shape + (3,)
assert abs(a['density'].sum() * 0.0625 ** 3 / 0.5235988 - 1) < 0.001" 2>err
    result $? "NumPy reads records, and densities add up to the volume"
else
    skip "NumPy reads records, and densities add up to the volume" "no numpy"
fi
if python_with nibabel; then
    "$python" -c "
import nibabel, numpy
image = nibabel.load('b.nii')
a, m = image.get_fdata(), image.affine
at = m @ numpy.array([5, 6, 7, 1]) / 10
assert image.header.get_xyzt_units()[0] == 'mm' and (image.get_qform() == m).all()
assert abs(a[5, 6, 7] - (numpy.linalg.norm(at[:3] - [0.25, 0, 0]) - 0.5)) < 1e-6" 2>err
    result $? "nibabel reads NIfTI, where the affine matrix says"
else
    skip "nibabel reads NIfTI, where the affine matrix says" "no nibabel"
fi
if python_with vtkmodules.vtkIOXML; then
    "$python" -c "
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkMassProperties, vtkTriangleFilter
for reader, path in (vtkXMLImageDataReader(), 'b.vti'), (vtkXMLUnstructuredGridReader(), 'b.vtu'):
    reader.SetFileName(path)
    contour, mass = vtkContourFilter(), vtkMassProperties()
    contour.SetInputConnection(reader.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, 'distance')
    contour.SetValue(0, 0)
    mass.SetInputConnection(contour.GetOutputPort())
    mass.Update()
    assert abs(mass.GetVolume() / 0.5235988 - 1) < 0.01, mass.GetVolume()" 2>err
    result $? "VTK finds the surface, and its volume"
else
    skip "VTK finds the surface, and its volume" "no vtk"
fi

# ---- OpenVDB ----
run grid --quiet ball.krs --cell 0.03125 -o b.vdb --surface-color --material
if [ "$status" -eq 0 ]; then
    [ -s b.vdb ]
    result $? "OpenVDB has a file"
    run grid --quiet ball.krs --cell 0.03125 -o again.vdb --surface-color --material
    cmp b.vdb again.vdb 2>err
    result $? "which is the same each time"
    find_untrusted
    run grid --quiet ball.krs --cell 0.03125 -o capitals.VDB --surface-color --material "$untrusted"
    cmp b.vdb capitals.VDB 2>err
    result $? "and in a sandbox, whatever case the ending has"
    run grid --quiet ball.krs --cell 0.03125 --fog -o f.vdb
    run grid --quiet ball.krs --cell 0.03125 --half -o half.vdb
    if python_with pyopenvdb; then
        "$python" -c "
import pyopenvdb as vdb
g = vdb.read('b.vdb', 'surface')
assert g.gridClass == 'level set' and abs(g.background - 0.09375) < 1e-8
assert g.transform.voxelSize() == (0.03125,) * 3 and g.transform.indexToWorld((8, 0, 0)) == (0.25, 0, 0)
a = g.getConstAccessor()
for i in range(-24, 40):
    for j in range(-24, 25):
        for k in range(-24, 25):
            truth = ((i / 32 - 0.25) ** 2 + (j / 32) ** 2 + (k / 32) ** 2) ** 0.5 - 0.5
            value, active = a.probeValue((i, j, k))
            assert abs(value - max(-0.09375, min(0.09375, truth))) < 1e-6
            assert abs(abs(truth) - 0.09375) < 1e-6 or active == (abs(truth) < 0.09375)
assert vdb.read('b.vdb', 'Cd').getConstAccessor().probeValue((24, 0, 0)) == ((1, 0, 0), True)
h = vdb.read('half.vdb', 'surface')
b, wide = h.getConstAccessor(), g.background
assert h.saveFloatAsHalf and 0.998 * wide < h.background <= wide
for i in range(-24, 40):
    for j in range(-24, 25):
        fine, rough = a.getValue((i, j, 3)), b.getValue((i, j, 3))
        assert 0.999 * abs(fine) <= abs(rough) <= abs(fine) and (fine < 0) == (rough < 0), (fine, rough)
f = vdb.read('f.vdb', 'density')
assert f.gridClass == 'fog volume' and f.background == 0
total = sum(item.value * item.count for item in f.citerOnValues())
assert abs(total / 32 ** 3 / 0.5235988 - 1) < 0.001, total" 2>err
        result $? "OpenVDB reads a level set, a fog volume and colours, each sample right"
    else
        skip "OpenVDB reads a level set, a fog volume and colours" "no python3-openvdb"
    fi
    if command -v vdb_print >/dev/null; then
        vdb_print -l b.vdb >out 2>err && grep -q 'class: level set' out && grep -q 'Name: material' out && ! grep -qi error err
        result $? "vdb_print reads it"
    else
        skip "vdb_print reads it" "no vdb_print"
    fi
    if command -v blender >/dev/null; then
        cat >blender.py <<'END'
import bmesh, bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
for path, name, threshold in ("b.vdb", "surface", 0), ("f.vdb", "density", 0.5):
    bpy.ops.object.volume_import(filepath=path)
    volume = bpy.context.object
    volume.data.grids.load()
    maker = bpy.data.objects.new("maker", bpy.data.meshes.new("maker"))
    bpy.context.collection.objects.link(maker)
    modifier = maker.modifiers.new("mesh", "VOLUME_TO_MESH")
    modifier.object, modifier.grid_name = volume, name
    modifier.threshold, modifier.resolution_mode = threshold, "GRID"
    found = maker.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    mesh = bmesh.new()
    mesh.from_mesh(found)
    print(name, "ok" if abs(mesh.calc_volume() / 0.5235988 - 1) < 0.01 else mesh.calc_volume())
END
        blender -b --python blender.py >out 2>err
        grep -q 'surface ok' out && grep -q 'density ok' out
        result $? "Blender makes meshes of both, with the volume"
    else
        skip "Blender makes meshes of both, with the volume" "no blender"
    fi
else
    said 73 "libopenvdb-dev" "without OpenVDB it is said"
    for i in 1 2 3 4 5; do skip "OpenVDB, $i" "built without"; done
fi
mkdir alone && cp "$krs" alone/krs
alone/krs grid ball.krs -o a.vdb >out 2>err
status=$?
said 73 "beside this krs" "a krs without its module says so"
[ ! -e a.vdb ]
result $? "and writes nothing"

# ---- numbers of 16 bits ----
run grid ball.krs --cell 0.0625 --half --surface-color --material -o h.npy
grep -q 'rounded by a 1024th' err
result $? "that numbers are rounded is said"
run grid --quiet ball.krs --cell 0.0625 --half -o h.ktx2 -o d.npy
if python_with numpy; then
    run grid --quiet ball.krs --cell 0.0625 -o whole.npy
    "$python" -c "
import numpy, struct
h, d, f = numpy.load('h.npy'), numpy.load('d.npy'), numpy.load('whole.npy')
assert h['distance'].dtype == d.dtype == h['color'].dtype == numpy.float16 and h['material'].dtype == numpy.uint32
assert (h['distance'] == d).all() and set(h['material'].flat) == {1} and set(h['color'][..., 0].flat) == {1}
d = d.astype('f8')
assert (abs(d) <= abs(f)).all() and (abs(f) - abs(d) <= abs(f) / 1024).all() and ((d < 0) == (f < 0)).all() and (d != f).any()
data = open('h.ktx2', 'rb').read()
assert struct.unpack('<II', data[12:20]) == (76, 2)
begin, size = struct.unpack('<QQ', data[80:96])
assert data[begin:] == numpy.load('d.npy').tobytes() and len(data) == begin + size" 2>err
    result $? "they are a 1024th shorter at most, never longer, and as few bytes"
else
    skip "they are a 1024th shorter at most" "no numpy"
fi
echo 'show box([2, 2, 2]).move([0, 0, -0.99999999]);' >level.krs
run grid --quiet level.krs --cell 1 --half -o l.npy
if python_with numpy; then
    "$python" -c "
import numpy
a = numpy.load('l.npy')
assert (a < 0).sum() == 2, a" 2>err
    result $? "what is inside stays so, however near the surface"
else
    skip "what is inside stays so" "no numpy"
fi
run grid ball.krs --half -o h.vti
said 2 "no numbers of 16 bits" "formats without them are named"

# ---- many files ----
for file in s.npy s.nii s.vti s.ktx2 s.vtu; do run grid --quiet ball.krs --cell 0.0625 --surface-color -o "$file"; done
run grid ball.krs --cell 0.0625 --surface-color -o m.npy -o m.vtu -o m.nii -o m.vti -o m.ktx2
[ "$status" -eq 0 ] && [ "$(grep -c 'samples from' err)" -eq 2 ] && cmp s.npy m.npy && cmp s.nii m.nii &&
    cmp s.vti m.vti && cmp s.ktx2 m.ktx2 && cmp s.vtu m.vtu
result $? "many files at once are what each is alone"
ln -s /dev/full full.nii
run grid --quiet ball.krs --cell 0.02 -o one.npy -o full.nii
said 74 "No space left" "a full disk is told once"
[ ! -e one.npy ] && no_temporaries
result $? "and a file that was begun before is not written then"
run grid ball.krs --cell 0.1 -o one.npy -o ./one.npy
said 2 "are one file" "a file is written once"

# ---- how much it takes ----
# The most memory of a command, in kilobytes: memory_of KRS-ARGUMENTS...
memory_of() {
    python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$krs" "$@" 2>err
}
if command -v python3 >/dev/null; then
    echo 'param size = 2 in [2, 20]; show sphere(0.4).repeat(1) & box([8, size, size]);' >lattice.krs
    low=$(memory_of grid --quiet lattice.krs --cell 0.1 -o l.npy)
    high=$(memory_of grid --quiet lattice.krs --cell 0.1 --set size=20 -o h.npy)
    [ "$(wc -c <h.npy)" -gt $(($(wc -c <l.npy) * 40)) ] && [ "$high" -lt $((low * 5 / 4)) ]
    result $? "fifty times the samples take no more memory"
    echo 'show sphere(1).move([-1000, 0, 0]); show sphere(1).move([1000, 0, 0]);' >apart.krs
    high=$(memory_of grid --quiet apart.krs --cell 0.05 -o apart.vtu)
    [ "$high" -lt $((low + 50000)) ]
    result $? "nor does what is between two balls"
else
    for i in 1 2; do skip "memory, $i" "no python3"; done
fi

# ---- what is said ----
run grid ball.krs --cell 0.1 -o s.npy
said 0 "exact outside" "what is exact is said"
run grid ball.krs --cell 0.1 -o e.npy --exact --error 0.004
said 0 "at most 0.004 below the true ones" "and the error"
echo 'show ellipsoid([1, 0.0005, 1]);' >thin.krs
run grid thin.krs --cell 0.25 -o t.npy --exact --error 0.3
said 0 "distances may be too long" "what is thinner than the error is warned of"
run grid --quiet ball.krs --cell 0.1 -o q.npy
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "--quiet says nothing"
run grid --quiet ball.krs --cell 0.1 -o q2.npy && cmp q.npy q2.npy
result $? "files are the same each time"
run grid --quiet ball.krs --cell 0.1 -o -
cmp out q.npy
result $? "NumPy's goes to standard output"
run grid --quiet ball.krs
[ "$status" -eq 0 ] && [ -s ball.npy ]
result $? "there is a usual cell, and a usual file"

# ---- what is refused ----
for cell in 0 -1 nan inf 1e-300 x; do
    run grid ball.krs --cell=$cell -o a.npy
    if [ "$status" -ne 2 ] || ! grep -q -- "--cell wants a length" err; then break; fi
done
said 2 "--cell wants a length" "what is no length is refused"
run grid ball.krs --cell 1e-5 -o a.npy
said 2 "--cell 0.00081 has fewer" "what is too large is refused with a cell that fits"
run grid --quiet ball.krs --cell 0.0008 -o a.vtu --band 1 --limit memory=20M
said 2 "--limit memory" "and what has no room in memory"
run grid ball.krs --cell 1e-9 -o a.vdb
[ "$status" -eq 2 ] || [ "$status" -eq 73 ]
result $? "also of sparse files"
run grid ball.krs --cell 0.00002 -o a.nii
said 2 "can have" "NIfTI has 32767 samples along an axis"
echo 'show sphere(1e-6);' >tiny.krs
run grid tiny.krs -o a.vdb
[ "$status" -eq 73 ] || said 2 "OpenVDB has none below 1.5e-05" "OpenVDB has no cells that are too small"
[ "$status" -ne 73 ] || skip "OpenVDB has no cells that are too small" "built without"
run grid ball.krs -o a.xyz
said 2 ".vdb, .npy, .nii, .ktx2, .vti or .vtu" "formats are named"
run grid ball.krs -o a.ktx2 --material
said 2 "no room for numbers of materials" "and what they cannot have"
run grid ball.krs -o a.npy --fog --exact
said 2 "--fog writes no distances" "densities are not exact"
run grid ball.krs -o a.npy --error 0.1
said 2 "--error is that of --exact" "an error is that of exact distances"
run grid floor.krs -o a.npy
said 2 "one that has: \`ball\`" "what has no end is refused"
run grid --quiet floor.krs --within=-1,-1,-1,1,1,1 --cell 0.2 -o w.npy
ended 0 "but not what of it is in a box"
run grid empty.krs -o a.npy
said 1 "nothing to write" "nothing has no grid"
[ ! -e a.npy ]
result $? "and no file"
run grid --quiet ball.krs --cell 0.05 -o /dev/full
[ "$status" -eq 2 ]
result $? "what has no ending is no grid"
ln -s /dev/full full.npy
run grid --quiet ball.krs --cell 0.05 -o full.npy
said 74 "No space left" "a full disk is told"
{ "$krs" grid --quiet ball.krs --cell 0.01 -o - 2>err; echo $? >ended; } | head -c 100 >/dev/null
status=$(cat ended)
[ "$status" -ne 0 ] && [ "$status" -lt 128 ]
result $? "and a pipe that is closed"
mkdir inside && cp ball.krs inside && ln -s ../outside.npy inside/link.npy
run grid --quiet "$untrusted" inside/ball.krs --cell 0.1 -o inside/link.npy
[ "$status" -eq 73 ] && [ ! -e outside.npy ]
result $? "with --untrusted nothing is written through a link"
run grid --quiet ball.krs -o missing/a.npy
[ "$status" -eq 73 ] && no_temporaries
result $? "a folder that is missing is told"
