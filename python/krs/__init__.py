"""krs: scenes of implicit surfaces, with exact distances, meshes and pictures.

    import krs
    scene = krs.compile("gear.krs")
    scene.distance(points), scene.mesh(0.01), scene.render((640, 360))

Functions of the language are functions here: `krs.sphere(1) | krs.box([1, 2, 1])`.
"""
from krs.words import *  # noqa: F401,F403 - first: what is named below is the package's
from krs.words import Library, use, words as _words
from krs.errors import (ArgumentError, DeviceError, Diagnostic, Error, InternalError, Interrupted, MemoryLimit,
                        SceneError, SceneWarning)
from krs.expressions import (Expression, Sequence, Sketch, camera, choose, deg, fog, image, kernel, let, light, material,
                             param, show, sky, zone)
from krs.mesh import Grid, Mesh, Section
from krs.native import version as __version__
from krs.picture import Picture, devices
from krs.scene import Camera, Parameter, Scene, compile, format
from krs.view import View, view

# What `from krs import *` has: names of Python itself, such as `min`, stay what they are.
__all__ = ["ArgumentError", "Camera", "DeviceError", "Diagnostic", "Error", "Expression", "Grid", "InternalError",
           "Interrupted", "Library", "MemoryLimit", "Mesh", "Parameter", "Picture", "Scene", "SceneError",
           "SceneWarning", "Section", "Sequence", "Sketch", "View", "camera", "choose", "deg", "devices", "fog", "image",
           "kernel", "let", "light", "material", "medium", "param", "show", "sky", "use", "view", "zone"]
