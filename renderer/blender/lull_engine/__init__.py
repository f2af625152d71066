"""The render engine lull for Blender: scenes go to it as glTF, pictures and layers come back."""
bl_info = {
    "name": "lull",
    "description": "A path tracer that knows when to stop",
    "author": "The authors of lull",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties > Render Engine",
    "category": "Render",
}

import bpy  # noqa: E402

from . import engine, operators, panels, program  # noqa: E402

_CLASSES = (program.LullPreferences, program.LULL_OT_test, panels.LullSettings, engine.LullEngine,
            operators.LULL_OT_check, operators.LULL_OT_export, *panels.CLASSES)


def register():
    for each in _CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.lull = bpy.props.PointerProperty(type=panels.LullSettings)
    panels.share(True)
    bpy.types.TOPBAR_MT_file_export.append(operators.menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(operators.menu)
    panels.share(False)
    del bpy.types.Scene.lull
    for each in reversed(_CLASSES):
        bpy.utils.unregister_class(each)
