# compositor.py: what Blender's compositor makes of an EXR.  Prints the passes that its image node
# offers; and writes the colours and the matte of one component as an EXR each, if there are mattes.
#
#     blender -b --factory-startup --python compositor.py -- FILE.exr COMPONENT FOLDER
import sys

import bpy

path, component, folder = sys.argv[-3:]
scene = bpy.context.scene
scene.use_nodes = True
nodes, links = scene.node_tree.nodes, scene.node_tree.links
nodes.clear()
picture = bpy.data.images.load(path)
image = nodes.new("CompositorNodeImage")
image.image = picture
names = [socket.name for socket in image.outputs]
print("passes", *sorted(names))
shown = [("colours", image.outputs["Combined"])]
if "CryptoComponent00" in names:
    matte = nodes.new("CompositorNodeCryptomatteV2")
    matte.source, matte.image = "IMAGE", picture
    matte.layer_name = "CryptoComponent"
    matte.matte_id = component
    shown.append(("matte", matte.outputs["Matte"]))
else:
    image.layer = "light"
    print("layer light:", *sorted(socket.name for socket in image.outputs))
    shown = []
composite = nodes.new("CompositorNodeComposite")
render = scene.render
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_mode = "RGBA"
render.image_settings.color_depth = "32"
render.image_settings.exr_codec = "ZIP"
render.resolution_x, render.resolution_y = 64, 36
render.resolution_percentage = 100
for name, socket in shown:
    links.new(socket, composite.inputs["Image"])
    render.filepath = f"{folder}/{name}.exr"
    bpy.ops.render.render(write_still=True)
