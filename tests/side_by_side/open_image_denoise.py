#!/usr/bin/python3
"""Denoises the same samples by lull and by the networks of Open Image Denoise, and prints the error of both.

    apt-get install python3-numpy python3-openimageio
    git lfs clone https://github.com/RenderKit/oidn-weights
    tests/side_by_side/open_image_denoise.py OUT oidn-weights NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ... > oidn.csv

Each scene is rendered with --denoise at every count of --spp; both denoisers get its samples, first-hit albedo and
normals. The truth is a plain render of --truth spp with another seed and `sobol`, whose noise is part of all figures.
Errors are those of `lull compare`. Images stay in OUT; existing ones are not rendered again. Not part of CI.
"""

import argparse
import os
import sys

import numpy as np
import OpenImageIO as oiio

from crops import Crop
from oidn_network import denoise

SIZES = {'oidn, balanced': '', 'oidn, high': '_large'}  # quality, with prefiltered features


def read(path):
    """Returns colours, samples, albedo and normals, and the image's OpenImageIO.ImageSpec."""
    image = oiio.ImageBuf(path)
    if image.has_error:
        sys.exit(image.geterror())
    names, pixels = image.spec().channelnames, np.asarray(image.get_pixels(oiio.FLOAT), np.float64)
    layers = [pixels[:, :, [names.index(channel) for channel in layer.split()]]
              for layer in ('R G B', 'noisy.R noisy.G noisy.B', 'albedo.R albedo.G albedo.B', 'N.X N.Y N.Z')]
    return *layers, image.spec()


def write(path, rgb, like):
    spec = oiio.ImageSpec(like.width, like.height, 3, oiio.FLOAT)
    spec.x, spec.y, spec.full_width, spec.full_height = like.x, like.y, like.full_width, like.full_height
    image = oiio.ImageBuf(spec)
    image.set_pixels(spec.roi, np.ascontiguousarray(rgb, np.float32))
    if not image.write(path):
        sys.exit(image.geterror())


class Scene(Crop):
    def __init__(self, text, o):
        super().__init__(text, o.out, o.lull, o.resolution)
        self.o = o

    def compare(self):
        self.render('truth', '--spp', str(self.o.truth), '--seed', '99', '--sampler', 'sobol')
        for spp in self.o.spp.split(','):
            self.render(spp, '--spp', spp, '--seed', '1', '--denoise', '--aov', 'albedo,normal')
            _, noisy, albedo, normal, spec = read(self.file(spp + '.exr'))
            write(self.file(spp + '.noisy.exr'), noisy, spec)
            for name, size in SIZES.items():
                write(self.file(f'{spp}.{name}.exr'), denoise(noisy, albedo, normal, self.o.weights, size), spec)
            for name, file in (('noisy', '.noisy'), ('lull', ''), *((name, '.' + name) for name in SIZES)):
                f = self.judge(spp + file)
                print(f'{self.name},{spp},"{name}",{f["visibleDifference"]:.2f},{f["rmseLightness"]:.3f},'
                      f'{f["flip"]:.4f},{f["ssim"]:.4f}', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('out')
    parser.add_argument('weights')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--lull', default='lull')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--spp', default='16,64,256')
    parser.add_argument('--truth', type=int, default=1024)
    o = parser.parse_args()
    os.makedirs(o.out, exist_ok=True)
    print('scene,spp,denoiser,visible_difference,rmse_lightness,flip,ssim')
    for text in o.scenes:
        Scene(text, o).compare()


if __name__ == '__main__':
    main()
