"""Settings of a scene."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty


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
    caution: FloatProperty(name="Caution", default=1, min=0.01, max=100,
                           description="2 allows half as much visible noise")
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
    seed: IntProperty(name="Seed", min=0, description="Seed of the random numbers")

    def rule_used(self):
        """Returns the name of the rule of lull render --stop that stops blocks."""
        return self.rule if self.stop_by == 'RULE' else "denoised" if self.denoise else "learned"

    def arguments(self):
        """Returns the command-line arguments."""
        said = ["--cap", str(self.cap), "--max-depth", str(self.max_depth), "--seed", str(self.seed),
                "--block", str(self.block)]
        if self.integrator != 'path':
            said += ["--integrator", self.integrator]
        if self.stop_by == 'SAMPLES':
            said += ["--spp", str(self.spp)]
        else:
            said += ["--caution", "%g" % self.caution]
            if self.graded_by:
                said += ["--graded-by", "%g" % self.graded_by]
            if self.stop_by == 'RULE':
                said += ["--stop", self.rule]
        if self.time:
            said += ["--time", self.time]
        if self.denoise:
            said += ["--denoise"]
        return said
