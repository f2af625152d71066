"""The settings of a scene, the panels of lull, and panels of Blender that are for every engine."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .versions import motion_settings

# Panels of EEVEE and Cycles that every engine needs: properties of surfaces, the world and lights, and passes.
_BORROWED = ("EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface", "DATA_PT_EEVEE_light",
             "DATA_PT_spot", "VIEWLAYER_PT_layer_passes", "VIEWLAYER_PT_layer_passes_cryptomatte",
             "VIEWLAYER_PT_layer_passes_lightgroups", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture")
# Panels of features that lull does not support.
_OTHERS = ("RENDER_PT_simplify", "RENDER_PT_freestyle", "VIEWLAYER_PT_freestyle", "RENDER_PT_gpencil")
_TWICE = ("DATA_PT_light",)  # borrowed ones, without nodes


class LullSettings(bpy.types.PropertyGroup):
    """Options of `lull render`; unset ones are not passed."""
    stop_by: EnumProperty(
        name="Stop", default='DEFAULT',
        items=(('DEFAULT', "Invisible Noise", "Stop each block once an observer would no longer see noise in it"),
               ('SAMPLES', "Sample Count", "Render all blocks with the same sample count"),
               ('RULE', "Stopping Rule", "Stop by a rule of lull render --stop")))
    spp: IntProperty(name="Samples per Pixel", default=64, min=1, max=1 << 24,
                     description="Samples per pixel of all blocks")
    rule: StringProperty(name="Rule", default="lnoise:0.3",
                         description="Rule of lull render --stop, e.g. lnoise:0.3")
    quality: EnumProperty(
        name="Quality", default='good',
        items=(('draft', "Draft", "Allow twice as much noise as Good, after a third of the samples or more"),
               ('good', "Good", "Allow no visible noise"),
               ('final', "Final", "Allow half as much noise as Good, after twice the samples or more")))
    # Of files of earlier versions, in place of the quality where it is not 1.
    caution: FloatProperty(name="Caution", default=1, min=0.01, max=100,
                           description="2 allows half as much noise; set 1 to choose a quality")
    cap: IntProperty(name="Max Samples", default=10000, min=1, max=1 << 24,
                     description="Maximum samples per pixel of a block")
    time: StringProperty(name="Time Limit", description="End after this wall-clock time, e.g. 90s, 10m or 1h30m; "
                         "empty: no limit")
    denoise: BoolProperty(name="Denoise", default=True,
                          description="Denoise the image, and stop blocks once it is clean: by the rule 'denoised' instead of 'learned'")
    integrator: EnumProperty(
        name="Integrator", default='path',
        items=(('path', "Path Tracing", "Find light by paths from the camera"),
               ('bdpt', "Bidirectional", "Find light by paths from lights, too")))
    block: IntProperty(name="Block Size", default=200, min=8, max=1 << 16, subtype='PIXEL',
                       description="Side of the squares that stop on their own")
    max_depth: IntProperty(name="Bounces", default=12, min=0, max=1000000,
                           description="Maximum number of bounces")
    texture: IntProperty(name="Texture Size", default=1024, min=16, max=8192, subtype='PIXEL',
                         description="Largest size of the images that replace nodes which glTF does not have")
    panes: BoolProperty(name="Sheets for Panes", default=True,
                        description="Replace flat slabs of clear glass by sheets, which light sampling passes")
    graded_by: FloatProperty(name="Graded By", default=0, min=-10, max=10,
                             description="Judge noise in the image brightened by this many stops as well")
    seed: IntProperty(name="Seed", min=0, description="Seed of the random numbers, to which the frame number is added")
    same_seed: BoolProperty(name="Same Seed for All Frames", description="Do not add the frame number to the seed")

    def noise_used(self):
        """Returns the name of the property that scales noise."""
        return "quality" if self.caution == 1 else "caution"

    def seed_used(self):
        """Returns the seed of the current frame."""
        return self.seed if self.same_seed else (self.seed + self.id_data.frame_current) % 2**64

    def rule_used(self):
        """Returns the name of the rule of lull render --stop that stops blocks."""
        return self.rule if self.stop_by == 'RULE' else "denoised" if self.denoise else "learned"

    def arguments(self):
        """Returns the command-line arguments."""
        said = ["--max-spp", str(self.cap), "--max-depth", str(self.max_depth), "--seed", str(self.seed_used()),
                "--block", str(self.block)]
        if self.integrator != 'path':
            said += ["--integrator", self.integrator]
        if self.stop_by == 'SAMPLES':
            said += ["--spp", str(self.spp)]
        else:
            name = self.noise_used()
            said += ["--" + name, "%g" % self.caution if name == "caution" else self.quality]
            if self.graded_by:
                said += ["--graded-by", "%g" % self.graded_by]
            if self.stop_by == 'RULE':
                said += ["--stop", self.rule]
        if self.time:
            said += ["--time", self.time]
        if self.denoise:
            said += ["--denoise"]
        return said


def _shared():
    for panel in bpy.types.Panel.__subclasses__():
        yield from _engines_of(panel)
        for derived in panel.__subclasses__():
            yield from _engines_of(derived)


def _engines_of(panel):
    engines = getattr(panel, "COMPAT_ENGINES", None)
    name = panel.__name__
    if engines is None or name.startswith(_OTHERS) or name in _TWICE:
        return
    if 'BLENDER_RENDER' in engines or name in _BORROWED:
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
            layout.prop(settings, settings.noise_used())
            layout.prop(settings, "graded_by")
        layout.prop(settings, "cap")
        layout.prop(settings, "time")
        layout.prop(settings, "denoise")
        if settings.stop_by != 'SAMPLES':
            layout.label(text=f"Rule: {settings.rule_used()}")
        layout.operator("lull.check")
        layout.label(text="The viewport shows EEVEE's image", icon='INFO')


class LULL_RENDER_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        settings, layout = context.scene.lull, self.layout
        layout.use_property_split = True
        for name in "integrator", "max_depth", "seed", "same_seed", "texture", "panes":
            layout.prop(settings, name)


class LULL_RENDER_PT_film(_Panel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(context.scene.cycles, "film_exposure")
        layout.prop(context.scene.render, "film_transparent", text="Transparent")


class LULL_RENDER_PT_motion_blur(_Panel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {'DEFAULT_CLOSED'}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render, layout = context.scene.render, self.layout
        layout.use_property_split, layout.active = True, render.use_motion_blur
        layout.prop(motion_settings(context.scene), "motion_blur_position", text="Position")
        layout.prop(render, "motion_blur_shutter")


class LULL_RENDER_PT_performance(_Panel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        render, layout = context.scene.render, self.layout
        layout.use_property_split = True
        layout.prop(render, "threads_mode")
        if render.threads_mode == 'FIXED':
            layout.prop(render, "threads")
        layout.prop(context.scene.lull, "block")


class LULL_VIEWLAYER_PT_passes(_Panel, bpy.types.Panel):
    bl_label, bl_context, bl_parent_id = "Data", "view_layer", "VIEWLAYER_PT_layer_passes"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        for name in "mist", "position", "object_index", "material_index":
            layout.prop(context.view_layer, "use_pass_" + name)


class _LightGroupPanel(_Panel):
    bl_label, bl_options = "Light Group", {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and getattr(context, cls.bl_context)

    def draw(self, context):
        owner = getattr(context, self.bl_context)
        self.layout.prop_search(owner, "lightgroup", context.view_layer, "lightgroups", text="Light Group")


class LULL_OBJECT_PT_lightgroup(_LightGroupPanel, bpy.types.Panel):
    bl_context = "object"


class LULL_WORLD_PT_lightgroup(_LightGroupPanel, bpy.types.Panel):
    bl_context = "world"


class LULL_MATERIAL_PT_settings(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Settings", "material"
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.material

    def draw(self, context):
        layout, material = self.layout, context.material
        layout.use_property_split = True
        layout.prop(material, "pass_index")
        layout.prop(material if hasattr(material, "displacement_method") else material.cycles, "displacement_method")


CLASSES = (LULL_RENDER_PT_stopping, LULL_RENDER_PT_sampling, LULL_RENDER_PT_film, LULL_RENDER_PT_motion_blur,
           LULL_RENDER_PT_performance, LULL_VIEWLAYER_PT_passes, LULL_OBJECT_PT_lightgroup, LULL_WORLD_PT_lightgroup,
           LULL_MATERIAL_PT_settings)
