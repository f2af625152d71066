"""Scenes of this add-on's making."""
import bpy


def made_at(name, scene):
    """Returns a new scene at the frame of another, by which sequences of images and keys of nodes go."""
    made = bpy.data.scenes.new(name)
    made.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    return made
