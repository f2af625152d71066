"""Takes the pictures of the add-on's panels, scenes/pictures/panels-*.png, in a Blender where lull_engine is installed:

xvfb-run -s "-screen 0 560x820x24" blender --factory-startup --window-geometry 0 0 560 820 --python scenes/panels.py
"""
import pathlib

import bpy

PICTURES = pathlib.Path(__file__).resolve().parent / "pictures"
TABS = ("RENDER", "VIEW_LAYER")
PAUSE = 3  # seconds for Blender to draw the effect of a step


def largest_area():
    return max(bpy.context.window_manager.windows[0].screen.areas, key=lambda area: area.width * area.height)


def open_panels():
    from lull_engine import panels
    for panel in panels.CLASSES:
        bpy.utils.unregister_class(panel)
        panel.bl_options = set()
        bpy.utils.register_class(panel)
    bpy.context.scene.render.engine = 'LULL'
    largest_area().type = 'PROPERTIES'


def choose(tab):
    largest_area().spaces[0].context = tab


def take(tab):
    name = tab.lower().replace("_", "-")
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=largest_area()):
        bpy.ops.screen.screenshot_area(filepath=str(PICTURES / f"panels-{name}.png"))


def run(steps):
    step, *others = steps
    step()
    if others:
        bpy.app.timers.register(lambda: run(others), first_interval=PAUSE)


bpy.context.preferences.view.show_splash = False
bpy.ops.preferences.addon_enable(module="lull_engine")
steps = [open_panels] + [lambda act=act, tab=tab: act(tab) for tab in TABS for act in (choose, take)]
bpy.app.timers.register(lambda: run(steps + [bpy.ops.wm.quit_blender]), first_interval=PAUSE)
