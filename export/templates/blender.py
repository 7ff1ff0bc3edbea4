# untested in Blender with OSL, which Debian's has not; without OSL Blender 4.3 has run it.
#
# @name@, made by krs @version@: a scene with the mesh, its material, camera, lights and sky.  Beside this file there are
# @stem@.osl, and the mesh, which you make first:
#
#     krs mesh @name@.krs -o @stem@.glb
#     blender -P @stem@.blender.py
#
# It takes the mesh to one object, whose coordinates are those of the scene; it may be moved and turned then.
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector

STEM = "@stem@"
CAMERA = @python_camera@
LIGHTS = [
@python_lights@]
SKY = @python_sky@
FOLDER = os.path.dirname(os.path.abspath(__file__))


def turned(v):
    """A vector of the scene, whose y is up, in Blender, whose z is."""
    return Vector((v[0], -v[2], v[1]))


def looking(back, up):
    """The rotation of what looks against `back`."""
    back = back.normalized()
    right = up.cross(back).normalized()
    return Matrix((right, back.cross(right), back)).transposed().to_4x4()


def add(name, data, matrix):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.matrix_world = matrix
    return thing


def import_mesh():
    path = os.path.join(FOLDER, STEM + ".glb")
    if not os.path.exists(path):
        sys.exit(f"there is no {path}: krs mesh @name@.krs -o @stem@.glb")
    bpy.ops.import_scene.gltf(filepath=path)
    parts = [thing for thing in bpy.context.selected_objects if thing.type == "MESH"]
    bpy.context.view_layer.objects.active = parts[0]
    bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM")
    bpy.ops.object.make_single_user(object=True, obdata=True)
    bpy.ops.object.transform_apply()
    for thing in bpy.context.selected_objects:
        if thing not in parts:  # places of parts, and cameras and lights of the file
            bpy.data.objects.remove(thing)
    if len(parts) > 1:
        bpy.ops.object.join()
    parts[0].name = STEM
    return parts[0]


def make_material():
    material = bpy.data.materials.new(STEM)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    script = nodes.new("ShaderNodeScript")
    script.mode = "EXTERNAL"
    script.filepath = os.path.join(FOLDER, STEM + ".osl")
    script.location = (-400, 300)
    emission = "Emission Color" if "Emission Color" in shader.inputs else "Emission"  # since 4.0, and before
    shader.inputs["Emission Strength"].default_value = 1.0
    for made, given in ("Color", "Base Color"), ("Roughness",) * 2, ("Metallic",) * 2, ("Emission", emission), ("Normal",) * 2:
        if made not in script.outputs:
            sys.exit(f"Blender has not compiled {script.filepath}: its console says why")
        links.new(script.outputs[made], shader.inputs[given])
    return material


def add_camera(scene):
    data = bpy.data.cameras.new("Camera")
    data.sensor_fit = "VERTICAL"
    data.clip_end = CAMERA["far"]
    if "angle" in CAMERA:
        data.angle_y = CAMERA["angle"]
    else:
        data.type = "ORTHO"
        data.ortho_scale = CAMERA["height"]
    eye = turned(CAMERA["eye"])
    matrix = looking(eye - turned(CAMERA["target"]), turned(CAMERA["up"]))
    scene.camera = add("Camera", data, Matrix.Translation(eye) @ matrix)


def add_light(light):
    data = bpy.data.lights.new("Light", light["type"])
    most = max(light["color"]) or 1.0
    data.color = [part / most for part in light["color"]]
    if light["type"] == "SUN":
        data.energy = most
        data.angle = light["size"]
        back = turned(light["toward"])
        place = Vector((0.0, 0.0, 0.0))
    else:
        data.energy = 4.0 * math.pi * most
        data.shadow_soft_size = light["size"]
        back = -turned(light.get("axis", (0.0, -1.0, 0.0)))
        place = turned(light["place"])
    if light["type"] == "SPOT":
        data.spot_size = min(light["angle"], math.pi)
        data.spot_blend = light["edge"]
    up = Vector((0.0, 1.0, 0.0)) if abs(back.normalized().z) > 0.999 else Vector((0.0, 0.0, 1.0))
    add("Light", data, Matrix.Translation(place) @ looking(back, up))


def make_sky(world):
    """The sky by height: its horizon fades upwards by the third power, and into the ground within a quarter."""
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    place, parts, half, ramp = (nodes.new("ShaderNode" + kind) for kind in ("TexCoord", "SeparateXYZ", "Math", "ValToRGB"))
    half.operation = "MULTIPLY_ADD"
    half.inputs[1].default_value = half.inputs[2].default_value = 0.5
    links.new(place.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs["Z"], half.inputs[0])
    links.new(half.outputs[0], ramp.inputs[0])
    links.new(ramp.outputs[0], nodes["Background"].inputs["Color"])
    for height in -0.25, 0.0, 0.1, 0.2, 0.4, 0.7, 1.0:
        part = 1.0 - (1.0 - max(height, 0.0)) ** 3
        color = [a + part * (b - a) for a, b in zip(SKY["horizon"], SKY["zenith"])] if height >= 0.0 else SKY["ground"]
        ramp.color_ramp.elements.new(0.5 + 0.5 * height).color = (*color, 1.0)
    ramp.color_ramp.elements.remove(ramp.color_ramp.elements[0])  # those that it came with
    ramp.color_ramp.elements.remove(ramp.color_ramp.elements[-1])


def build():
    scene = bpy.data.scenes.new(STEM)
    bpy.context.window.scene = scene
    scene.render.engine = "CYCLES"
    mesh = import_mesh()
    if bpy.app.build_options.cycles_osl:
        scene.cycles.device = "CPU"
        scene.cycles.shading_system = True
        material = make_material()
        mesh.data.materials.clear()
        mesh.data.materials.append(material)
    else:
        print("this Blender was built without OSL: the mesh keeps the materials of its file")
    add_camera(scene)
    for light in LIGHTS:
        add_light(light)
    scene.world = bpy.data.worlds.new(STEM)
    make_sky(scene.world)


build()
