"""Lists differences from Cycles, and exports the scene for the command line."""
import os
import shlex
import tempfile

import bpy
from bpy_extras.io_utils import ExportHelper

from .camera import resolution
from .engine import arguments, export_scene
from .process import Failure

_REPORT = "lull: differences"


def _exported(operator, context, *where):
    """Returns Exported; None after an error, which the operator reports."""
    try:
        return export_scene(context.scene, context.view_layer.name, *where)
    except (Failure, OSError) as e:
        operator.report({'ERROR'}, str(e))
        return None


class LULL_OT_check(bpy.types.Operator):
    """List what will look different in lull, without rendering"""
    bl_idname, bl_label = "lull.check", "Check Scene"

    def execute(self, context):
        with tempfile.TemporaryDirectory(prefix="lull-") as folder:
            done = _exported(self, context, folder)
        if done is None:
            return {'CANCELLED'}
        lines = done.warnings + done.remarks
        text = bpy.data.texts.get(_REPORT) or bpy.data.texts.new(_REPORT)
        text.clear()
        text.write("\n".join(lines or ["Nothing will look different."]) + "\n")
        for line in lines:
            self.report({'WARNING'}, line)
        self.report({'INFO'}, f"{len(lines) or 'No'} differences; see the text '{_REPORT}'")
        return {'FINISHED'}


class LULL_OT_export(bpy.types.Operator, ExportHelper):
    """Write the scene as lull's render engine sees it, with its world, and print the command that renders it"""
    bl_idname, bl_label = "lull.export", "Export for lull"
    filename_ext = ".glb"
    check_extension = None  # that of the path is kept
    filter_glob: bpy.props.StringProperty(default="*.glb;*.gltf", options={'HIDDEN'})

    def execute(self, context):
        scene = context.scene
        folder, file = os.path.split(self.filepath)
        name, suffix = os.path.splitext(file)
        if suffix not in (".glb", ".gltf"):
            name, suffix = file, ".glb"
        done = _exported(self, context, folder, name, suffix)
        if done is None:
            return {'CANCELLED'}
        for line in done.warnings:
            self.report({'WARNING'}, line)
        if done.backdrop:
            self.report({'WARNING'}, f"the world is left out behind the scene: put {done.backdrop} there")
        self.report({'INFO'}, shlex.join(["lull", "render", *arguments(scene, done, resolution(scene.render))]))
        return {'FINISHED'}


def menu(self, _context):
    self.layout.operator(LULL_OT_export.bl_idname, text="lull (.glb/.gltf)")
