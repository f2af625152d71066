#!/bin/bash
# Installs missing packages, builds lull and its Blender add-on, and renders one of its own scenes, a room by day,
# denoised: each block until it is clean, or until 110 seconds have passed. The image is 600x400 pixels, six blocks of
# the size that observers judged.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. cmake/packages.sh
exec </dev/null

install_packages $build_packages

cmake --preset release -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=32 -DBUILD_TESTING=OFF
cmake --build --preset release --target lull blender_addon

mkdir -p out
echo "== scenes/room by day, 600x400, denoised, at most 110 seconds"
build/release/renderer/lull render scenes/room/room.pbrt -o out/room.exr --resolution 600x400 \
    --denoise --time 110s --report out/room.html
echo
echo "Open $PWD/out/room.png        the image"
echo "     $PWD/out/room.html       every block's samples and decisions"
echo "     $PWD/out/room.spp.png    the samples of each block, dark: few, bright: many"
echo "     $PWD/out/room.exr        the image, linear, with the samples before they were denoised"
echo "The same room by night: build/release/renderer/lull render scenes/room/room-night.pbrt --denoise --time 10m"
echo "To call the program by its name, type: export PATH=\"$PWD/build/release/renderer:\$PATH\""
