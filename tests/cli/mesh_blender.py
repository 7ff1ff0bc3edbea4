# mesh_blender.py: what Blender finds in a GLB.  A line for each object: its name, "closed" or "open",
# its volume, its layers of colours and its materials.
#
#     blender -b --factory-startup --python mesh_blender.py -- FILE.glb
import sys

import bmesh
import bpy
import numpy

numpy.bool = bool  # Blender 3.4's reader asks for names that newer versions of numpy lack
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])
for thing in sorted(bpy.data.objects, key=lambda thing: thing.name):
    if thing.type != "MESH":
        continue
    mesh = bmesh.new()
    mesh.from_mesh(thing.data)
    closed = all(edge.is_manifold for edge in mesh.edges)
    print("object", thing.name.replace(" ", "_"), "closed" if closed else "open",
          round(mesh.calc_volume(), 3), len(thing.data.color_attributes),
          ",".join(material.name for material in thing.data.materials))
