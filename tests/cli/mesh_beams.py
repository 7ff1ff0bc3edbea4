"""mesh_beams.py FILE.3mf THICK: whether a file has the beams of the scene of mesh_beams.sh, by closed forms of their ends."""
import math
import sys
import xml.etree.ElementTree as tree
import zipfile

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
BEAMS = "{http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02}"

thick = float(sys.argv[2])
model = tree.fromstring(zipfile.ZipFile(sys.argv[1]).read("3D/3dmodel.model"))
assert model.get("requiredextensions") == "b"
resources = model.find(CORE + "resources")
ids = [thing.get("id") for thing in resources]
assert len(set(ids)) == len(ids)
bases = {group.get("id"): [b.get("displaycolor") for b in group] for group in resources.iter(CORE + "basematerials")}
assert all(bases.values())


def placed(point):
    """Turned by 30 degrees about z, twice as large, and moved."""
    x, y, z = point
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    return (2 * (c * x - s * y), 2 * (s * x + c * y) + 3, 2 * z)


def key(beam):
    ends = sorted(((tuple(round(n, 5) + 0.0 for n in end), round(radius, 5)) for end, radius in beam))
    return tuple(ends)


def beams_of(item):
    mesh = item.find(CORE + "mesh")
    points = [tuple(float(v.get(k)) for k in "xyz") for v in mesh.iter(CORE + "vertex")]
    (lattice,) = mesh.findall(BEAMS + "beamlattice")
    assert len(list(mesh.iter(CORE + "triangle"))) == 0 and list(mesh)[-1] is lattice
    assert lattice.get("cap") == "sphere" and lattice.get("clippingmode") == "none"
    assert len(set(points)) == len(points)
    usual, found = float(lattice.get("radius")), []
    for beam in lattice.find(BEAMS + "beams"):
        first = float(beam.get("r1", usual))
        ends = [(points[int(beam.get("v1"))], first), (points[int(beam.get("v2"))], float(beam.get("r2", first)))]
        assert math.dist(ends[0][0], ends[1][0]) > float(lattice.get("minlength")) > 0
        found.append(key(ends))
    return sorted(found)


comb = [[((i, 0, 0), thick), ((i, 1, 0.5), 0.5 * thick)] for i in range(12)]
wanted = {
    "#FF6347FF": [[((0, 0, 0), 0.1), ((2, 0, 0), 0.1)], [((2, 0, 0), 0.1), ((2, 2, 0), 0.1)],
                  [((2, 2, 0), 0.1), ((0, 0, 0), 0.1)]],
    "#008000FF": [[(placed(end), 2 * radius) for end, radius in beam] for beam in comb],
}
meshes = 0
for item in resources.iter(CORE + "object"):
    if item.find(CORE + "mesh").find(BEAMS + "beamlattice") is None:
        assert len(list(item.iter(CORE + "triangle"))) >= 12
        meshes += 1
        continue
    color = bases[item.get("pid")][int(item.get("pindex"))]
    assert beams_of(item) == sorted(key(beam) for beam in wanted.pop(color)), color
assert not wanted and meshes == 3
assert len(model.find(CORE + "build")) == 5
