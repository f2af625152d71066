#!/bin/bash
# Makes all that is published of a version: cmake/release.sh OUT
#
#   lull-VERSION-linux-x86_64.tar.xz        program, libraries, models, Python module, add-on; runs where it is unpacked
#   lull-VERSION-blender-linux-x86_64.zip   the add-on with the program in it, for Blender 3.4 and later
#   lull_render-VERSION-….whl               the Python module with the program, for this system's Python
#   lull_VERSION_amd64.deb                  for this release of Debian
#   SHA256SUMS
#
# They run on x86-64-v3 processors (AVX2: since 2013 and 2015) and systems with this one's glibc or a later one; make them on
# Debian 12 (cmake/try_debian.sh bookworm 'bash cmake/release.sh out/release'), the packages for Debian 13 there. Without MPI.
set -euo pipefail
(($# == 1)) || { sed -n '2,/^set/{/^set/d;s/^# \?//;p}' "$0" >&2; exit 2; }
mkdir -p "$1"
out=$(readlink -f "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. cmake/packages.sh
exec </dev/null
install_packages $build_packages dpkg-dev file patchelf pybind11-dev python3-dev python3-numpy unzip xz-utils zip

cmake --preset package -DLULL_ARCH=x86-64-v3 -DLULL_MPI=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=32
cmake --build --preset package
build=$PWD/build/package
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

echo "== Debian package"
cmake --build --preset package --target package >/dev/null
cp "$build"/lull_*.deb "$out/"

# bundle TREE: copies the libraries that its files need into lib/lull, apart from those of any Linux system, and lets all find
# them there.
bundle() {
    local tree=$1 file here elf=()
    local system='^(ld-linux-x86-64|lib(c|m|dl|pthread|rt|resolv|util|anl))\.so'
    while IFS= read -r file; do
        ! file -b "$file" | grep -q '^ELF' || elf+=("$file")
    done < <(find "$tree" -type f)
    ldd "${elf[@]}" | awk '$2 == "=>" && $3 ~ /^\// {print $1, $3}' | sort -u | while read -r name file; do
        [[ $name =~ $system || $file == "$tree"/* || $file == "$build"/* ]] || cp -L "$file" "$tree/lib/lull/$name"
    done
    for file in "$tree"/lib/lull/*.so*; do
        patchelf --force-rpath --set-rpath '$ORIGIN:$ORIGIN/..' "$file"
    done
    for file in "${elf[@]}"; do
        here=$(dirname "$file")
        patchelf --force-rpath --set-rpath "\$ORIGIN/$(realpath --relative-to="$here" "$tree/lib/lull"):\$ORIGIN/$(
            realpath --relative-to="$here" "$tree/lib")" "$file"
    done
}

echo "== portable folder"
name=lull-$version-linux-x86_64
tree=$work/$name
cmake --install "$build" --strip --prefix "$tree" >/dev/null
rm -r "$tree"/lib/python3* # of one version of Python: in the wheel
bundle "$tree"
"$tree/bin/lull" selftest
tar -C "$work" --sort=name --owner=0 --group=0 --mtime=@0 -cf - "$name" | xz -T0 -6 >"$out/$name.tar.xz"

echo "== add-on with the program"
mkdir "$work/addon"
(cd "$work/addon" && unzip -q "$tree/share/lull/lull-blender.zip")
mkdir -p "$work/addon/lull_engine/program/share/lull" "$work/addon/lull_engine/program/lib"
cp -r "$tree/bin" "$work/addon/lull_engine/program/"
cp -r "$tree/lib/lull" "$work/addon/lull_engine/program/lib/"
cp -r "$tree/share/lull/models" "$work/addon/lull_engine/program/share/lull/"
rm -f "$out/lull-$version-blender-linux-x86_64.zip"
(cd "$work/addon" && zip -qr -X "$out/lull-$version-blender-linux-x86_64.zip" .)

echo "== wheel"
cmake --install "$build" --component python --strip --prefix "$work/wheel" >/dev/null
bundle "$work/wheel"
glibc=$(ldd --version | sed -n '1s/.* //p')
/usr/bin/python3 cmake/wheel.py "$work/wheel" lib/python3/dist-packages "$version" "" "$out" "manylinux_${glibc/./_}_x86_64"

cd "$out"
sha256sum -- *.tar.xz *.zip *.whl *.deb >SHA256SUMS
ls -l "$out"
