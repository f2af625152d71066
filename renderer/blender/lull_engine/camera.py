"""The camera of a render; parameters that glTF lacks become `extras`."""
import math

from mathutils import Matrix

from .process import Failure
from .shown import is_sheared


def resolution(render):
    """Returns the width and height of the whole picture, in pixels."""
    scale = render.resolution_percentage / 100
    return int(render.resolution_x * scale), int(render.resolution_y * scale)


def views(render):
    """Returns the names of the views of a render, such as left and right; a single view has an empty name."""
    named = [v.name for v in render.views if v.use and (render.views_format == 'MULTIVIEW' or v.name in ("left", "right"))]
    return named if render.use_multiview else [""]


class View:
    """The view of an evaluated scene's camera. Raises: Failure."""

    def __init__(self, scene, graph, notes):
        camera = self._camera = scene.camera
        if camera is None:
            raise Failure("the scene has no camera")
        self.data = data = camera.data
        if data.type == 'PANO':
            raise Failure(f"camera '{camera.name}' is panoramic, which glTF does not support")
        if not camera.matrix_world.determinant():
            raise Failure(f"camera '{camera.name}' is scaled to nothing")
        self.name, self.matrix, self._graph, self._notes = camera.name, camera.matrix_world.copy(), graph, notes
        r = scene.render
        self.width, self.height = r.resolution_x, r.resolution_y
        self.pixels = self.width * r.resolution_percentage / 100
        fits_width = data.sensor_fit == 'HORIZONTAL' or data.sensor_fit == 'AUTO' and self.width >= self.height
        self.side = self.width if fits_width else self.height
        sensor = data.sensor_height if data.sensor_fit == 'VERTICAL' else data.sensor_width
        # Half the extent of a pixel's worth of the longer side: at a distance of 1, or anywhere.
        self._half = (data.ortho_scale if data.type == 'ORTHO' else sensor / data.lens) / 2 / self.side
        self.stereo, self._moved = [], 0  # arguments of `lull render` for two eyes, and how far the frame is moved at a distance of 1
        if is_sheared(self.matrix):
            self.matrix = _upright(self.matrix)
            notes.say(f"the picture of camera '{camera.name}' is not sheared as the scale of its parent has it")
        if r.use_multiview and r.views_format == 'STEREO_3D' and data.stereo.interocular_distance > 0:
            self._part_eyes(r, data.sensor_width / sensor)

    def _part_eyes(self, render, share):
        """Sets the camera to the middle of both eyes. Blender's shift is in sensor widths, `share` of the side that the lens fits."""
        eyes = self.data.stereo
        for kind, is_set in (("toe-in", eyes.convergence_mode == 'TOE'), ("spherical", eyes.use_spherical_stereo),
                             ("orthographic", self.data.type == 'ORTHO')):
            if is_set:
                raise Failure(f"the eyes of camera '{self.name}' are {kind}; lull has eyes that are off-axis or parallel, in perspective")
        away = {'LEFT': 0.5, 'RIGHT': -0.5, 'CENTER': 0}[eyes.pivot] * eyes.interocular_distance
        scale = self.matrix.col[0].length
        self.matrix = self.matrix @ Matrix.Translation((away / scale, 0, 0))
        self.stereo = ["--stereo", "%.9g" % (eyes.interocular_distance / scale)]
        if eyes.convergence_mode == 'OFFAXIS':
            self.stereo[1] += ",%.9g" % (eyes.convergence_distance * share / scale)
            self._moved = away / (eyes.convergence_distance * share)
        if len(views(render)) == 1:
            self.stereo += ["--eye", *views(render)]

    def pixel_width(self, distance):
        """Returns the width of a pixel at a distance."""
        return 2 * self._half * self.width / self.pixels * (1 if self.data.type == 'ORTHO' else distance)

    def extent(self):
        """Returns the width and height of the frame, at a distance of 1 or anywhere."""
        return 2 * self._half * self.width, 2 * self._half * self.height

    def shift(self):
        """Returns the offset of the frame, in fractions of its width and height."""
        return self.data.shift_x * self.side / self.width - self._moved / self.extent()[0], self.data.shift_y * self.side / self.height

    def focus(self):
        """Returns the distance at which the picture is sharp; None without depth of field."""
        dof = self.data.dof
        if not dof.use_dof:
            return None
        if not dof.focus_object:
            return dof.focus_distance
        seen = dof.focus_object.evaluated_get(self._graph)
        at = seen.matrix_world
        if dof.focus_subtarget:
            at = at @ seen.pose.bones[dof.focus_subtarget].matrix
        return -(self._camera.matrix_world.normalized().inverted() @ at.translation).z

    def described(self):
        """Returns the camera for glTF."""
        data, x, y = self.data, self._half * self.width, self._half * self.height
        lens = {"clipStart": data.clip_start, "clipEnd": data.clip_end}
        if any(self.shift()):
            lens["shift"] = list(self.shift())
        if data.dof.use_dof and data.type == 'ORTHO':  # one lens for all pixels would make it a perspective one
            self._notes.say(f"the orthographic camera '{self.name}' is sharp at all distances")
        elif data.dof.use_dof:
            lens["lensRadius"] = data.lens * 1e-3 / (2 * data.dof.aperture_fstop)
            lens["focusDistance"] = max(self.focus(), 1e-5)
            if data.dof.aperture_blades or data.dof.aperture_ratio != 1:
                self._notes.say(f"the aperture of camera '{self.name}' is round")
        near = {"znear": data.clip_start, "zfar": data.clip_end}
        shape = {"orthographic": {"xmag": x, "ymag": y, **near}} if data.type == 'ORTHO' else {
            "perspective": {"yfov": 2 * math.atan(y), "aspectRatio": x / y, **near}}
        return {"name": self.name, "type": next(iter(shape)), **shape, "extras": {"lull": lens}}


def _upright(matrix):
    """Returns the place of a camera without shear, of the same direction."""
    z = matrix.col[2].xyz.normalized()
    y = matrix.col[1].xyz
    y = (y - y.project(z)).normalized()
    made = Matrix((y.cross(z), y, z)).transposed().to_4x4()
    made.translation = matrix.translation
    return made
