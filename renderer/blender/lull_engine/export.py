"""Writes a scene as glTF, in a Blender of its own, whose data may be changed (see engine.py).

The last argument is a JSON object: the file, the names of scene and view layer, the frame, the output
folder, and the file of the result, with `gltf`, `environment` (or null) and `warnings`.

Blender's own exporter writes the file. Area lights become emitting meshes, the world becomes an image.
Shift, depth of field and the radius of point lights are `extras`, which only lull reads.
"""
import json
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lights  # noqa: E402
import surfaces  # noqa: E402
import world  # noqa: E402

_MESHES = {'MESH', 'CURVE', 'SURFACE', 'META', 'FONT'}
_UNSEEN = {'CAMERA', 'LIGHT', 'EMPTY', 'ARMATURE', 'LATTICE', 'SPEAKER', 'LIGHT_PROBE'}


def load(what):
    """Opens the scene, alone, so that everything keeps its name."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(what["blend"]) as (_, wanted):
        wanted.scenes = [what["scene"]]
    scene = wanted.scenes[0]
    window = bpy.context.window
    window.scene = scene
    window.view_layer = scene.view_layers[what["layer"]]
    scene.render.engine = 'CYCLES'
    return scene


def rendered_objects(layer_collection):
    """Returns the objects of a view layer that its render shows."""
    if layer_collection.exclude or layer_collection.collection.hide_render:
        return set()
    found = {o for o in layer_collection.collection.objects if not o.hide_render}
    for child in layer_collection.children:
        found |= rendered_objects(child)
    return found


def show_as_rendered(scene, layer):
    """Sets the visibility of the viewport, which the exporter uses, to that of a render."""
    wanted = rendered_objects(layer.layer_collection)
    collections = [layer.layer_collection]
    for collection in collections:
        collections += collection.children
        collection.hide_viewport = False
        collection.collection.hide_viewport = False
    for o in scene.objects:
        o.hide_render = o not in wanted
        o.hide_viewport = False  # dependencies are evaluated, too
        if o.name in layer.objects:
            o.hide_set(o.hide_render)
        for modifier in o.modifiers:
            modifier.show_viewport = modifier.show_render
            if hasattr(modifier, "render_levels"):
                modifier.levels = modifier.render_levels
    scene.render.use_simplify = False
    return wanted


def warn_of_objects(objects, warn):
    for o in objects:
        if o.type not in _MESHES | _UNSEEN:
            warn(f"object '{o.name}' is left out: glTF has nothing like {o.type.lower()}")
        for system in o.particle_systems:
            warn(f"particles '{system.name}' of object '{o.name}' are left out")
        if o.type in _MESHES and (o.is_shadow_catcher or o.is_holdout):
            warn(f"object '{o.name}' is shown as any other, not as shadow catcher or holdout")


def warn_of_film(scene, warn):
    if scene.render.use_motion_blur:
        warn("there is no motion blur")
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        warn("pixels are square, whatever their aspect")


def set_camera(scene, warn):
    """Adds the properties that glTF lacks to the camera, as `extras`. Raises: SystemExit without a camera."""
    camera = scene.camera
    if camera is None:
        raise SystemExit("the scene has no camera")
    data = camera.data
    if data.type == 'PANO':
        raise SystemExit(f"camera '{camera.name}' is panoramic, which glTF does not support")
    for o in scene.objects:
        o.hide_render = o.hide_render or (o.type == 'CAMERA' and o != camera)
    camera.hide_render = False
    lens = {}
    width, height = scene.render.resolution_x, scene.render.resolution_y
    fits_width = data.sensor_fit == 'HORIZONTAL' or data.sensor_fit == 'AUTO' and width >= height
    side = width if fits_width else height
    if data.shift_x or data.shift_y:
        lens["shift"] = [data.shift_x * side / width, data.shift_y * side / height]
    if data.dof.use_dof:
        focus = data.dof.focus_distance
        if data.dof.focus_object:
            at = data.dof.focus_object.matrix_world.translation
            focus = -(camera.matrix_world.normalized().inverted() @ at).z
        # As Cycles has it: the lens in metres, or 1 for an orthographic camera.
        length = data.lens * 1e-3 if data.type == 'PERSP' else 1
        lens["lensRadius"] = length / (2 * data.dof.aperture_fstop)
        lens["focusDistance"] = max(focus, 1e-5)
        if data.dof.aperture_blades or data.dof.aperture_ratio != 1:
            warn(f"the aperture of camera '{camera.name}' is round")
    if lens:
        data["lull"] = lens


def patch(path):
    """Corrects the written file where the exporter has no option."""
    with open(path, encoding="utf-8") as f:
        root = json.load(f)
    for material in root.get("materials", []):
        extensions = material.get("extensions", {})
        # Without this, glass would be a thin sheet; Blender's is solid.
        if "KHR_materials_transmission" in extensions:
            extensions.setdefault("KHR_materials_volume", {"thicknessFactor": 1})
        # Without this, surfaces without specular reflection would reflect at grazing angles.
        specular = extensions.get("KHR_materials_specular", {})
        if specular.get("specularColorFactor") == [0, 0, 0]:
            specular["specularFactor"] = 0
    with open(path, "w", encoding="utf-8") as f:
        json.dump(root, f)


def export(path):
    bpy.ops.export_scene.gltf(
        filepath=path, export_format='GLTF_SEPARATE', use_active_scene=True, use_renderable=True,
        export_cameras=True, export_lights=True, export_extras=True, export_apply=True,
        export_animations=False, export_current_frame=True, export_skins=False, export_morph=False)


def main():
    what = json.loads(sys.argv[-1])
    warnings = []

    def warn(text):
        if text not in warnings:
            warnings.append(text)

    scene = load(what)
    layer = bpy.context.window.view_layer
    objects = show_as_rendered(scene, layer)
    scene.frame_set(what["frame"], subframe=what["subframe"])
    warn_of_film(scene, warn)
    warn_of_objects(objects, warn)
    set_camera(scene, warn)
    surfaces.prepare(objects, warn)
    lights.prepare(scene, warn)
    environment = world.write(scene, os.path.join(what["folder"], "world.exr"), warn)
    path = os.path.join(what["folder"], "scene.gltf")
    export(path)
    patch(path)
    with open(what["said"], "w", encoding="utf-8") as f:
        json.dump({"gltf": path, "environment": environment, "warnings": warnings}, f)


main()
