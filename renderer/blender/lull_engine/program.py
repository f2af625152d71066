"""The program lull: which one runs, and the add-on's preferences."""
import functools
import os
import shutil
import subprocess

import bpy
from bpy.props import StringProperty

from .process import Failure

_OWN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "program", "bin", "lull")
_VERSION = "0.1.0"  # of the add-on, and so of the program


def _found():
    """Returns the path of the program, or None, and where it was looked for."""
    if os.path.exists(_OWN):
        if not os.access(_OWN, os.X_OK):  # zip files are unpacked without it
            os.chmod(_OWN, 0o755)
        return _OWN, "in the add-on"
    addon = bpy.context.preferences.addons.get(__package__)
    wanted = bpy.path.abspath(addon.preferences.program) if addon else ""
    return shutil.which(wanted or "lull"), wanted or "on the PATH"


def _version_of(path):
    """Returns the version of a program, which is asked once. Raises: Failure."""
    found = _asked(path, os.path.getmtime(path))
    if isinstance(found, Failure):
        raise found
    return found


@functools.lru_cache
def _asked(path, _time_of_change):
    """Returns the version of a program, or a Failure."""
    try:
        ran = subprocess.run([path, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                             timeout=30, check=False)
    except (OSError, subprocess.TimeoutExpired) as e:
        return Failure(f"{path} does not run: {e}")
    words = ran.stdout.split()
    if ran.returncode != 0 or words[:1] != ["lull"] or len(words) < 2:
        return Failure(f"{path} does not run: {(ran.stderr or ran.stdout).strip() or 'exit code %d' % ran.returncode}")
    return words[1]


def find_lull():
    """Returns the path of a program of the add-on's version. Raises: Failure."""
    path, where = _found()
    if path is None:
        raise Failure((f"Program lull not found {where}" if where == "on the PATH" else f"Program not found: {where}") +
                      "; set its path in Preferences > Add-ons > Render: lull")
    if (version := _version_of(path)) != _VERSION:
        raise Failure(f"{path} is lull {version}; this add-on needs lull {_VERSION}")
    return path


def _told():
    """Returns a line about the program, and whether it can be used."""
    try:
        path = find_lull()
        return f"Version {_version_of(path)}, " + ("the add-on's own" if path == _OWN else path), True
    except Failure as e:
        return str(e), False


class LULL_OT_test(bpy.types.Operator):
    """Run the program, and show its version"""
    bl_idname, bl_label = "lull.test", "Test"

    def execute(self, _context):
        _asked.cache_clear()
        line, is_right = _told()
        self.report({'INFO'} if is_right else {'ERROR'}, line)
        return {'FINISHED'} if is_right else {'CANCELLED'}


class LullPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", subtype='FILE_PATH', description="Path of the program lull; empty: lull on the PATH")

    def draw(self, _context):
        layout = self.layout
        if not os.path.exists(_OWN):
            layout.prop(self, "program")
        row = layout.split(factor=0.85)
        line, is_right = _told()
        row.label(text=line, icon='CHECKMARK' if is_right else 'ERROR')
        row.operator(LULL_OT_test.bl_idname)
