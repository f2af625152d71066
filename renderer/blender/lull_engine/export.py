"""Writes a scene as glTF, in a Blender of its own, whose data may be changed (see engine.py).

The last argument is a JSON object: the file, the names of scene, view layer and its material override (or
null), the frame, the size of baked images, whether slabs of glass become sheets and whether
the world is photographed where one image of all directions is less sharp, the number of bounces, the output folder, the
name of the files in it, its suffix (.gltf or .glb), and the file of the result: `gltf`, `environment` (or null), `backdrop` (a picture
of the background of a world that has another light, or null), `groups` (light groups by the names that lull takes), `shutter`
(seconds that it is open, 0: nothing moves),
`objects` and `materials` (pass indices by name), `warnings`, and `remarks` on Cycles' usual settings.

Blender's own exporter writes the file, of a scene of plain meshes: all that a render shows, with its
modifiers, instances and particles. Area lights become emitting meshes, the world becomes an image.
Shift, depth of field and the radius of point lights are `extras`, which only lull reads.
"""
import json
import os
import sys

import bpy
from mathutils import Matrix

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bake  # noqa: E402
import flatten  # noqa: E402
import gltf  # noqa: E402
import lights  # noqa: E402
import motion  # noqa: E402
import panes  # noqa: E402
import scenes  # noqa: E402
import strands  # noqa: E402
import surfaces  # noqa: E402
import world  # noqa: E402
from notes import Notes  # noqa: E402


def load(what):
    """Opens the scene, alone, so that everything keeps its name."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(what["blend"]) as (_, wanted):
        wanted.scenes = [what["scene"]]
        wanted.materials = [what["material"]] if what["material"] else []
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


def _set_objects(scene):
    """Returns the objects that the background set of a scene shows, and the sets of that set."""
    found, seen = set(), {scene}
    while (scene := scene.background_set) and scene not in seen:
        seen.add(scene)
        layer = next((layer for layer in scene.view_layers if layer.use), scene.view_layers[0])
        found |= rendered_objects(layer.layer_collection)
    return found


def show_as_rendered(scene, layer):
    """Sets what the viewport shows, which can be read, to what a render does, also in collections that have copies alone."""
    wanted = rendered_objects(layer.layer_collection) | _set_objects(scene)
    for collection in _collections(layer.layer_collection):
        collection.hide_viewport = False
    for collection in bpy.data.collections:
        collection.hide_viewport = collection.hide_render
    listed = set(layer.objects)  # objects of libraries may have the same names
    for o in bpy.data.objects:
        o.hide_viewport = o.hide_render
        if o in listed:
            o.hide_set(o not in wanted)
        o.show_instancer_for_viewport = o.show_instancer_for_render
        for modifier in o.modifiers:
            modifier.show_viewport = modifier.show_render
            for shown, rendered in (("levels", "render_levels"), ("steps", "render_steps"), ("viewport_resolution", "resolution")):
                if hasattr(modifier, shown) and hasattr(modifier, rendered):
                    setattr(modifier, shown, getattr(modifier, rendered))
    for settings in bpy.data.particles:
        settings.display_percentage, settings.display_method = 100, 'RENDER'
    for curve in bpy.data.curves:
        curve.resolution_u = curve.render_resolution_u or curve.resolution_u
        curve.resolution_v = curve.render_resolution_v or curve.resolution_v
    for ball in bpy.data.metaballs:
        ball.resolution = ball.render_resolution
    for tree in bpy.data.node_groups:
        _deny_viewport(tree)
    strands.prepare()
    r = scene.render
    r.simplify_subdivision, r.simplify_child_particles = r.simplify_subdivision_render, r.simplify_child_particles_render
    return wanted


def _deny_viewport(tree):
    """Lets geometry nodes that ask for the viewport know that there is none."""
    for node in [n for n in tree.nodes if n.type == 'IS_VIEWPORT']:
        answer = tree.nodes.new('FunctionNodeInputBool')
        answer.boolean = False
        for link in list(node.outputs[0].links):
            tree.links.new(answer.outputs[0], link.to_socket)


def note_film(scene, notes):
    if scene.render.use_multiview:
        notes.say("all views have the same picture")
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        notes.say("pixels are square, whatever their aspect")
    if scene.render.film_transparent and scene.cycles.film_transparent_glass:
        notes.say("glass is opaque before a transparent background")
    if scene.render.use_simplify and (scene.cycles.use_camera_cull or scene.cycles.use_distance_cull):
        for o in scene.objects:
            if o.cycles.use_camera_cull or o.cycles.use_distance_cull:
                notes.add("shown although Cycles culls by the camera or the distance", o.name)
    if any(c.holdout for c in _collections(bpy.context.view_layer.layer_collection)):
        notes.say("collections that are holdouts are shown as any others")


def limits(scene, depth):
    """Returns sentences about what Cycles has and lull has not: none about the usual settings that change nothing."""
    c, r, found = scene.cycles, scene.render, []
    if c.max_bounces < depth:
        found.append(f"{c.max_bounces} bounces")
    for name in "diffuse", "glossy", "transmission":
        if getattr(c, name + "_bounces") < min(depth, c.max_bounces):
            found.append(f"{getattr(c, name + '_bounces')} {name} bounces")
    if c.sample_clamp_indirect > 0 or c.sample_clamp_direct > 0:
        found.append("clamping")
    if not (c.caustics_reflective and c.caustics_refractive):
        found.append("no caustics")
    said = ["differs: limits of Cycles do not hold, and rooms are brighter: " + ", ".join(found)] if found else []
    if c.use_fast_gi:
        said.append("differs: all bounces are traced, without Cycles' fast approximation")
    if c.blur_glossy > 0:
        said.append("differs: caustics of rough surfaces are sharper, without Cycles' Filter Glossy")
    if c.transparent_max_bounces < 8:
        said.append(f"differs: rays pass any number of transparent surfaces, not {c.transparent_max_bounces}")
    if r.use_simplify and c.texture_limit_render != 'OFF':
        said.append("differs: textures have their full size")
    if c.pixel_filter_type != 'BOX' or c.filter_width != 1:
        said.append("differs: edges are as sharp as means over pixels, whatever Cycles' filter")
    return said + _unjudged(scene)


def _unjudged(scene):
    """Returns a sentence about what changes the colours of a picture and is unknown to lull, which only judges noise by them."""
    view = scene.view_settings
    found = [f"the look '{view.look}'"] * (view.look != 'None') + ["gamma"] * (view.gamma != 1) + \
        ["curves"] * view.use_curve_mapping + [f"a display of {scene.display_settings.display_device}"] * \
        (scene.display_settings.display_device != 'sRGB')
    return ["noise is judged without " + ", ".join(found)] if found else []


def _collections(collection):
    return [collection] + [c for child in collection.children for c in _collections(child)]


def check_camera(scene):
    """Raises: SystemExit without a camera that glTF has."""
    if scene.camera is None:
        raise SystemExit("the scene has no camera")
    if scene.camera.data.type == 'PANO':
        raise SystemExit(f"camera '{scene.camera.name}' is panoramic, which glTF does not support")


def _upright(matrix):
    """Returns the place of a camera without shear, of the same direction."""
    z = matrix.col[2].xyz.normalized()
    y = matrix.col[1].xyz
    y = (y - y.project(z)).normalized()
    made = Matrix((y.cross(z), y, z)).transposed().to_4x4()
    made.translation = matrix.translation
    return made


def add_camera(scene, flat, moving, notes):
    """Copies the camera, with the properties that glTF lacks as `extras`."""
    camera = scene.camera
    data = camera.data
    lens = {"clipStart": data.clip_start, "clipEnd": data.clip_end}
    width, height = scene.render.resolution_x, scene.render.resolution_y
    fits_width = data.sensor_fit == 'HORIZONTAL' or data.sensor_fit == 'AUTO' and width >= height
    side = width if fits_width else height
    if data.shift_x or data.shift_y:
        lens["shift"] = [data.shift_x * side / width, data.shift_y * side / height]
    if data.dof.use_dof and data.type == 'ORTHO':  # one lens for all pixels would make it a perspective one
        notes.say(f"the orthographic camera '{camera.name}' is sharp at all distances")
    elif data.dof.use_dof:
        focus = data.dof.focus_distance
        if data.dof.focus_object:
            at = data.dof.focus_object.matrix_world
            if data.dof.focus_subtarget:
                at = at @ data.dof.focus_object.pose.bones[data.dof.focus_subtarget].matrix
            focus = -(camera.matrix_world.normalized().inverted() @ at.translation).z
        lens["lensRadius"] = data.lens * 1e-3 / (2 * data.dof.aperture_fstop)
        lens["focusDistance"] = max(focus, 1e-5)
        if data.dof.aperture_blades or data.dof.aperture_ratio != 1:
            notes.say(f"the aperture of camera '{camera.name}' is round")
    made = bpy.data.objects.new(camera.name, data.copy())
    made.data["lull"] = lens
    evaluated = camera.evaluated_get(bpy.context.evaluated_depsgraph_get())
    made.matrix_world = evaluated.matrix_world
    if flatten.is_sheared(evaluated.matrix_world):
        made.matrix_world = _upright(evaluated.matrix_world)
        notes.say(f"the picture of camera '{camera.name}' is not sheared as the scale of its parent has it")
    moving.mark(made, evaluated)
    flat.collection.objects.link(made)
    flat.camera = made
    for name in "resolution_x", "resolution_y", "resolution_percentage", "pixel_aspect_x", "pixel_aspect_y":
        setattr(flat.render, name, getattr(scene.render, name))


def export(path):
    gltf.mend_exporter()
    bpy.ops.export_scene.gltf(
        filepath=path, export_format='GLB' if path.endswith('.glb') else 'GLTF_SEPARATE', use_active_scene=True, use_renderable=True,
        export_cameras=True, export_lights=True, export_extras=True, export_apply=False,
        export_animations=False, export_current_frame=True, export_skins=False, export_morph=False)


def indices(blocks):
    """Returns the pass indices that are not 0, by name."""
    return {block.name: block.pass_index for block in blocks if block.pass_index}


def main():
    what = json.loads(sys.argv[-1])
    notes = Notes()
    scene = load(what)
    layer = bpy.context.window.view_layer
    wanted = show_as_rendered(scene, layer)
    # A pose is evaluated at the frame only in a graph that is up to date.
    bpy.context.evaluated_depsgraph_get()
    moving = motion.Motion(scene, what["frame"] + what["subframe"], notes)
    scene.frame_set(what["frame"], subframe=what["subframe"])
    flat = scenes.made_at('lull', scene)
    check_camera(scene)
    note_film(scene, notes)
    made = flatten.flatten(flat, wanted, what["material"] and bpy.data.materials[what["material"]], moving, notes)
    lamps = lights.find(scene, wanted)
    add_camera(scene, flat, moving, notes)
    baker = bake.Baker(what["texture"], flat)
    for o in surfaces.prepare(made, baker, notes):
        notes.add("left out, being nothing but a volume", o["lull_source"])
        flat.collection.objects.unlink(o)
    if what["panes"]:
        panes.prepare(made, notes)
    flatten.move_sheared(made)
    base = os.path.join(what["folder"], what["name"])
    lights.add(lamps, scene, flat, base, baker, notes)
    baker.end()
    flatten.leave_copies(flat)
    flatten.undress_others(flat)
    is_sharp = what["sharp"] and not moving.moves(scene.camera)
    environment, backdrop, suns = world.write(scene, layer, flat.camera, base, is_sharp, notes)
    if backdrop and moving.moves(scene.camera):
        notes.say("the background is sharp although the camera moves")
    lights.add_suns(suns, flat)
    bpy.context.window.scene = flat
    path = base + what["suffix"]
    export(path)
    groups, is_blurred = gltf.patch(path, [g.name for g in layer.lightgroups], moving.shutter, notes)
    if environment and scene.world.lightgroup in layer.lightgroups:
        groups[scene.world.lightgroup] = "environment"
    with open(what["said"], "w", encoding="utf-8") as f:
        json.dump({"gltf": path, "environment": environment, "backdrop": backdrop, "groups": groups,
                   "shutter": moving.shutter if is_blurred else 0,
                   "objects": indices(wanted), "materials": indices(bpy.data.materials), "warnings": notes.lines(),
                   "remarks": limits(scene, what["depth"])}, f)


main()
