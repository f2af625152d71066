"""The panels of lull, and those of Blender that are for every engine."""
import bpy

# Panels of EEVEE that every engine needs: properties of surfaces, the world and lights.
_BORROWED = ("EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface",
             "EEVEE_WORLD_PT_surface", "DATA_PT_EEVEE_light", "DATA_PT_spot")
# Panels of features that lull does not support.
_OTHERS = ("RENDER_PT_simplify", "RENDER_PT_freestyle", "VIEWLAYER_PT_freestyle", "RENDER_PT_gpencil",
           "VIEWLAYER_PT_layer_passes")


def _shared():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or panel.__name__.startswith(_OTHERS):
            continue
        if 'BLENDER_RENDER' in engines or panel.__name__ in _BORROWED:
            yield engines


def share(with_lull):
    """Adds or removes lull among the engines of these panels."""
    for engines in _shared():
        (engines.add if with_lull else engines.discard)('LULL')


class _Panel:
    bl_space_type, bl_region_type, bl_context = 'PROPERTIES', 'WINDOW', "render"
    COMPAT_ENGINES = {'LULL'}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


class LULL_RENDER_PT_stopping(_Panel, bpy.types.Panel):
    bl_label = "Stopping"

    def draw(self, context):
        settings, layout = context.scene.lull, self.layout
        layout.use_property_split = True
        layout.prop(settings, "stop_by")
        if settings.stop_by == 'SAMPLES':
            layout.prop(settings, "spp")
        else:
            if settings.stop_by == 'RULE':
                layout.prop(settings, "rule")
            layout.prop(settings, "caution")
            layout.prop(settings, "graded_by")
        layout.prop(settings, "cap")
        layout.prop(settings, "time")
        layout.prop(settings, "denoise")
        layout.operator("lull.check")


class LULL_RENDER_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        settings, layout = context.scene.lull, self.layout
        layout.use_property_split = True
        for name in "guide", "max_depth", "seed", "texture", "panes":
            layout.prop(settings, name)
