#!/usr/bin/python3
"""Denoises the same samples by lull and by the networks of Open Image Denoise, and prints the error of both.

    git lfs clone https://github.com/RenderKit/oidn-weights
    tests/measurements/open_image_denoise.py OUT oidn-weights NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ... > oidn.csv

Each scene is rendered with --denoise at every count of --spp; both denoisers get its samples, first-hit albedo and
normals. The truth is a plain render of --truth spp with another seed and `sobol`, whose noise is part of all figures.
Errors are those of `lull compare`. Images stay in OUT; existing ones are not rendered again. Needs OpenImageIO.
"""

import argparse

import numpy as np
import OpenImageIO as oiio

from measure import Renders, read
from oidn_network import denoise

SIZES = {'oidn, balanced': '', 'oidn, high': '_large'}  # quality, with prefiltered features


def write(path, rgb, like):
    """Writes an image of the part that another file shows."""
    image = oiio.ImageBufAlgo.channels(oiio.ImageBuf(str(like)), ('R', 'G', 'B'))
    image.set_pixels(image.roi, np.ascontiguousarray(rgb, np.float32))
    if not image.write(str(path), oiio.FLOAT):
        raise OSError(image.geterror())


def compare(scene, o):
    scene.render('truth', spp=o.truth, seed=99, sampler='sobol')
    for spp in o.spp.split(','):
        scene.render(spp, spp=spp, seed=1, denoise=True, aov='albedo,normal')
        noisy, albedo, normal = (read(scene.file(spp), *layer) for layer in (('noisy.',), ('albedo.',), ('N.', 'XYZ')))
        write(scene.file(spp + '.noisy'), noisy, scene.file(spp))
        for name, size in SIZES.items():
            write(scene.file(f'{spp}.{name}'), denoise(noisy, albedo, normal, o.weights, size), scene.file(spp))
        for name, file in (('noisy', '.noisy'), ('lull', ''), *((name, '.' + name) for name in SIZES)):
            f = scene.compare(spp + file)
            print(f'{scene.folder.name},{spp},"{name}",{f["visibleDifference"]:.2f},{f["rmseLightness"]:.3f},'
                  f'{f["flip"]:.4f},{f["ssim"]:.4f}', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('out')
    parser.add_argument('weights')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--spp', default='16,64,256')
    parser.add_argument('--truth', type=int, default=1024)
    o = parser.parse_args()
    print('scene,spp,denoiser,visible_difference,rmse_lightness,flip,ssim')
    for text in o.scenes:
        compare(Renders.parse(text, o.out, resolution=o.resolution), o)


if __name__ == '__main__':
    main()
