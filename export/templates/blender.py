# untested in Blender with OSL, which Debian's has not; without, it has been run.
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
SKY = @python_sky@  # the mean of the scene's
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
        thing.select_set(thing in parts)
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
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*SKY, 1.0)


build()
