"""Rooms."""
import math

from cases import case, cube, matte, principled, the, without


def interior(scene):
    room(scene, matte("white", (0.8, 0.8, 0.8, 1)))


@case("room of Principled surfaces")
def interior_principled(scene):
    room(scene, principled(Base_Color=(0.8, 0.8, 0.8, 1))[0])


def room(scene, made):
    without("ball", "floor")
    cube(made, 4, (0, 0, 2))
    scene.camera.location, scene.camera.rotation_euler = (0, -1.8, 2), (math.pi / 2, 0, 0)
    scene.camera.data.lens = 18
    key = the("key")
    key.location, key.rotation_euler, key.data.energy = (0, 0, 3.9), (0, 0, 0), 60
    c = scene.cycles
    scene.lull.max_depth = c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = 32
