# mesh_blender.py: what Blender finds in a GLB.  A line for each object: its name, "closed" or "open",
# its volume, its layers of colours and its materials.  Then one for each picture that a material asks for: which, of what,
# how many pixels wide, and its color space.
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
for material in sorted(bpy.data.materials, key=lambda material: material.name):
    for link in material.node_tree.links:
        if link.from_node.type == "TEX_IMAGE":
            # Roughness and metallic are separated before they arrive.
            targets = [link.to_socket.name] if link.to_node.type == "BSDF_PRINCIPLED" else sorted(
                output.to_socket.name for output in material.node_tree.links if output.from_node == link.to_node)
            image = link.from_node.image
            print("picture", material.name, "+".join(targets).replace(" ", "_"), image.size[0],
                  image.colorspace_settings.name)
