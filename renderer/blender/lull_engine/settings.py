"""What people can set: of a scene, and where lull is."""
import shutil

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty


class LullPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype='FILE_PATH',
        description="The program lull; empty: the one that is found on the PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


def find_lull():
    """Returns the path of the program. Raises FileNotFoundError with what to do."""
    addon = bpy.context.preferences.addons.get(__package__)
    wanted = bpy.path.abspath(addon.preferences.program) if addon else ""
    found = shutil.which(wanted or "lull")
    if not found:
        raise FileNotFoundError(
            (f"There is no program {wanted}" if wanted else "The program lull is not on the PATH") +
            ": set where it is in Preferences > Add-ons > Render: lull")
    return found


class LullSettings(bpy.types.PropertyGroup):
    """Each is an option of `lull render`; what is not set is not passed."""
    stop_by: EnumProperty(
        name="Stop", default='DEFAULT',
        items=(('DEFAULT', "When noise is invisible", "Each block when people would no longer see "
                "noise there"),
               ('SAMPLES', "At a number of samples", "Every pixel gets this sample count"),
               ('RULE', "By another rule", "As `lull render --stop` takes it")))
    spp: IntProperty(name="Samples", default=64, min=1, max=1 << 24,
                     description="Samples per pixel, the same for all")
    rule: StringProperty(name="Rule", default="lnoise:0.3",
                         description="As `lull render --stop` takes it")
    caution: FloatProperty(name="Caution", default=1, min=0.01, max=100,
                           description="2 stops later, rarely too early, 0.5 sooner")
    cap: IntProperty(name="Most samples", default=10000, min=1, max=1 << 24,
                     description="Samples per pixel that no block exceeds")
    time: StringProperty(name="Time", description="End after this time, such as 90s, 10m or 1h30m; "
                         "empty: when all blocks have stopped")
    denoise: BoolProperty(name="Denoise", description="Take the noise out of the picture; blocks "
                          "stop when it is clean then")
    guide: EnumProperty(
        name="Path guiding", default='off',
        items=(('off', "Off", "Light is looked for everywhere"),
               ('auto', "Where it pays", "A trial in the scene says so"),
               ('on', "On", "Learn where light comes from and send paths there")))
    max_depth: IntProperty(name="Bounces", default=12, min=0, max=1000000,
                           description="The longest path")
    seed: IntProperty(name="Seed", min=0, description="Another gives other, equally good, samples")

    def arguments(self):
        """Returns what the command line has to say."""
        said = ["--cap", str(self.cap), "--max-depth", str(self.max_depth), "--seed", str(self.seed),
                "--guide", self.guide]
        if self.stop_by == 'SAMPLES':
            said += ["--spp", str(self.spp)]
        else:
            said += ["--caution", "%g" % self.caution]
            if self.stop_by == 'RULE':
                said += ["--stop", self.rule]
        if self.time:
            said += ["--time", self.time]
        if self.denoise:
            said += ["--denoise"]
        return said
