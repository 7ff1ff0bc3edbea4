"""mesh_3mf_colors.py FILE.3mf: whether triangles have the colors and materials of the scene of mesh_3mf_colors.sh."""
import sys
import xml.etree.ElementTree as tree
import zipfile

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
MATERIAL = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"

model = tree.fromstring(zipfile.ZipFile(sys.argv[1]).read("3D/3dmodel.model"))
resources = model.find(CORE + "resources")
ids = [thing.get("id") for thing in resources]
assert len(set(ids)) == len(ids)
bases = {group.get("id"): [(b.get("name"), b.get("displaycolor")) for b in group]
         for group in resources.iter(CORE + "basematerials")}
colors = {group.get("id"): [c.get("color") for c in group] for group in resources.iter(MATERIAL + "colorgroup")}
assert all(len(set(group)) == len(group) for group in colors.values())


def srgb(linear):
    return 255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055)


def check_shaded(point, color):
    """mix(red, blue) along y, from -1 to 1."""
    share = min(max(0.5 + 0.5 * point[1], 0), 1)
    wanted = (srgb(1 - share), 0, srgb(share))
    found = [int(color[1 + 2 * k:3 + 2 * k], 16) for k in range(3)]
    assert color.endswith("FF") and all(abs(a - b) <= 6 for a, b in zip(wanted, found)), (point, color)


counts = {}
for item in resources.iter(CORE + "object"):
    points = [[float(v.get(k)) for k in "xyz"] for v in item.iter(CORE + "vertex")]
    for triangle in item.iter(CORE + "triangle"):
        corners = [points[int(triangle.get(k))] for k in ("v1", "v2", "v3")]
        x = sum(corner[0] for corner in corners) / 3
        pid = triangle.get("pid", item.get("pid"))
        if pid in colors:
            numbers = [int(triangle.get(k)) for k in ("p1", "p2", "p3")]
            assert x < 1.5
            for corner, number in zip(corners, numbers):
                check_shaded(corner, colors[pid][number])
            kind = "shaded"
        else:
            kind = bases[pid][int(triangle.get("p1", item.get("pindex")))]
            wanted = ("steel", "#808080FF") if x > 7.5 else (
                ("#ff6347", "#FF6347FF") if x < 4.5 else ("#000080", "#000080FF"))
            assert kind == wanted, (x, kind)
        counts[kind] = counts.get(kind, 0) + 1
assert len(counts) == 4, counts
print(counts)
