#!/bin/bash
# Installs missing packages, builds lull and its Blender add-on, and renders two of its own scenes, denoised, in blocks of
# the size that observers judged: plants by a wall of bricks, until each of four blocks is clean, and a room by day of six
# blocks, for 80 seconds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. cmake/packages.sh
exec </dev/null

install_packages $build_packages

cmake --preset release -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=32 -DBUILD_TESTING=OFF
cmake --build --preset release --target lull blender_addon

mkdir -p out
echo "== scenes/textured, 400x400, denoised until each block is clean"
build/release/renderer/lull render scenes/textured/scene.pbrt -o out/textured.exr --resolution 400x400 \
    --denoise --report out/textured.html
echo "== scenes/room by day, 600x400, denoised, unfinished after 80 seconds"
build/release/renderer/lull render scenes/room/room.pbrt -o out/room.exr --resolution 600x400 \
    --denoise --time 80s --report out/room.html
echo
echo "Open $PWD/out/textured.png      the image, finished"
echo "     $PWD/out/textured.html     every block's samples and decisions"
echo "     $PWD/out/textured.spp.png  the samples of each block, dark: few, bright: many"
echo "     $PWD/out/textured.exr      the image, linear, with the samples before they were denoised"
echo "     $PWD/out/room.html         the room, unfinished, with an estimate for each block"
echo "The same room by night: build/release/renderer/lull render scenes/room/room-night.pbrt --denoise --time 10m"
echo "To call the program by its name, type: export PATH=\"$PWD/build/release/renderer:\$PATH\""
