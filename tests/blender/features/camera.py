"""Features of cameras and films."""
import math

from compatible import open_shutter
from cases import ball, case, cube, dressed, empty, matte, surface, the, wall, without
from world import world_image


@case("shift, portrait")
def shift(scene):
    scene.camera.data.shift_x, scene.camera.data.shift_y = 0.15, 0.2
    scene.render.resolution_x, scene.render.resolution_y = scene.render.resolution_y, scene.render.resolution_x


@case("vertical sensor fit")
def sensor(scene):
    scene.camera.data.sensor_fit, scene.camera.data.shift_y = 'VERTICAL', 0.2


def orthographic(scene):
    scene.camera.data.type, scene.camera.data.ortho_scale = 'ORTHO', 6


@case("panoramic camera")
def panorama(scene):
    scene.camera.data.type = 'PANO'


@case("depth of field")
def depth_of_field(scene):
    dof = scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 3, 0.2


@case("aperture blades")
def blades(scene):
    depth_of_field(scene)
    scene.camera.data.dof.aperture_blades = 3


@case("clip start before a wall")
def clip_start(scene):
    o = wall(matte("outside"), 3, -4, 4)
    o.name = "outside"
    ball(matte("ball", (0.6, 0.2, 0.1, 1)))
    scene.camera.data.clip_start = 3


@case("clip end")
def clip_end(scene):
    scene.camera.data.clip_end = 6.5


@case("motion blur")
def motion_blur(scene):
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1
    for frame, x in (0, -1), (1, 0), (2, 1):
        the("ball").location.x = x
        the("ball").keyframe_insert("location", frame=frame)


def keyed(owner, path, *values):
    for frame, value in enumerate(values):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


@case("motion blur of the camera, before a sky")
def motion_of_camera(scene):
    world_image(scene)
    motion_blur(scene)
    open_shutter(scene, 'START')
    keyed(scene.camera, "rotation_euler", (1.25, 0, 0), (1.25, 0, 0), (1.35, 0, 0.2))


@case("motion blur of copies that turn, and of a parent")
def motion_of_copies(scene):
    motion_blur(scene)
    without("ball")
    parent = empty()
    keyed(parent, "rotation_euler", (0, 0, 0), (0, 0, 0.4), (0, 0, 0.8))
    first = cube(matte("box", (0.6, 0.2, 0.1, 1)), at=(0, 0, 0.7))
    copies = [first, first.copy(), first.copy()]
    for o, x in zip(copies, (-2, 0, 2)):
        o.parent, o.location.x = parent, x
        if o != first:
            scene.collection.objects.link(o)


@case("motion blur of emitters (a lamp, a mesh) and of a shape")
def motion_of_lamps(scene):
    motion_blur(scene)
    dressed(surface('Emission')[0])
    keyed(the("key"), "location", (0.5, -2, 5), (1.5, -2, 5), (2.5, -2, 5))
    o = cube(matte("box", (0.1, 0.2, 0.6, 1)), at=(2, 0, 0.5))
    o.shape_key_add(name="Basis")
    key = o.shape_key_add(name="up")
    for point in key.data:
        point.co.z *= 3
    keyed(key, "value", 0, 0.5, 1)


@case("percentage of the resolution")
def percentage(scene):
    scene.render.resolution_percentage = 50


@case("pixel aspect")
def pixel_aspect(scene):
    scene.render.pixel_aspect_x = 2


@case("border, cropped")
def border(scene):
    r = scene.render
    r.use_border = r.use_crop_to_border = True
    r.border_min_x, r.border_max_x, r.border_min_y, r.border_max_y = 0.21, 0.83, 0.3, 0.9


@case("exposure of the film and of the view")
def exposure(scene):
    scene.cycles.film_exposure, scene.view_settings.exposure = 2.5, 1


@case("transparent film")
def transparent(scene):
    scene.render.film_transparent = True


@case("transparent film, with transparent glass")
def transparent_glass(scene):
    transparent(scene)
    scene.cycles.film_transparent_glass = True
    dressed(surface('BsdfGlass', Roughness=0, IOR=1.05)[0])


@case("Cycles' own limits: 4 diffuse bounces, indirect light clamped at 10")
def limits(scene):
    without("ball", "floor")
    cube(matte("white", (0.8, 0.8, 0.8, 1)), 4, (0, 0, 2))
    scene.camera.location, scene.camera.rotation_euler = (0, -1.8, 2), (math.pi / 2, 0, 0)
    scene.camera.data.lens = 18
    key, c = the("key"), scene.cycles
    key.location, key.rotation_euler, key.data.energy = (0, 0, 3.9), (0, 0, 0), 60
    scene.lull.max_depth = c.max_bounces = c.transmission_bounces = 32
    c.diffuse_bounces, c.glossy_bounces, c.sample_clamp_indirect = 4, 4, 10


@case("camera under a parent of uneven and negative scale")
def sheared_camera(scene):
    scene.camera.parent = empty(scale=(1, 1.5, 0.8), rotation_euler=(0.1, 0, 0.3))
