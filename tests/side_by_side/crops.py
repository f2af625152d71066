"""Renders a part of a scene by lull, and measures the error of images of it."""

import json
import os
import subprocess

from seconds import Seconds


class Crop:
    """NAME=SCENE.pbrt[@X0,X1,Y0,Y1]. Images are NAME.*.exr in a folder; existing ones are not rendered again."""

    def __init__(self, text, folder, lull, resolution):
        self.name, rest = text.split('=')
        self.scene, _, self.crop = rest.partition('@')
        self.folder, self.lull, self.resolution = folder, lull, resolution
        self.seconds = Seconds(self.file('seconds.json'))

    def file(self, name):
        return os.path.join(self.folder, f'{self.name}.{name}')

    def render(self, name, *how):
        crop = ['--crop', self.crop] if self.crop else []
        self.seconds.run(name, [self.lull, 'render', self.scene, '--resolution', self.resolution, *crop, '--quiet',
                                '-o', self.file(name + '.exr'), '--report', self.file(name + '.json'), *how])

    def judge(self, name):
        """Returns the figures of `lull compare` for an image, with the image `truth` as reference."""
        out = self.file(name)
        subprocess.run([self.lull, 'compare', '--reference', self.file('truth.exr'), '--automatic', self.file(name + '.exr'),
                        '-o', out], check=True, capture_output=True)
        figures = json.load(open(out + '.compare.json'))
        return next(i for i in figures['images'] if i['name'] == 'automatic')['figures']
