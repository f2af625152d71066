#!/bin/bash
# Installs what is missing, builds lull and renders one of its own scenes, textured, until each block
# has stopped by itself. To be done in minutes on two cores, the picture is 400x400 pixels with
# blocks of 100x100, and no block gets more than 1,000 samples per pixel.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. cmake/packages.sh
exec </dev/null

install_packages $build_packages

cmake --preset release -DCMAKE_UNITY_BUILD=ON -DBUILD_TESTING=OFF
cmake --build --preset release --target lull

mkdir -p out
echo "== scenes/textured, 400x400, blocks of 100x100, at most 1000 samples per pixel"
build/release/renderer/lull render scenes/textured/scene.pbrt -o out/textured.exr \
    --resolution 400x400 --block 100 --cap 1000 --report out/textured.json
echo "The picture is in $PWD/out/textured.png and, linear, in $PWD/out/textured.exr;"
echo "$PWD/out/textured.spp.png shows how many samples each block took."
echo "To call the program by its name, type: export PATH=\"$PWD/build/release/renderer:\$PATH\""
