#!/bin/bash
# Really installs the package of a build, runs its files and removes it again; as root,
# on a machine that may be changed: bash cmake/try_package.sh build/package/lull_0.1.0_amd64.deb
set -euo pipefail
package=$(readlink -f "${1:?a package is needed: lull_VERSION_ARCH.deb}")
if dpkg-query -W -f '${db:Status-Status}' lull 2>/dev/null | grep -qx installed; then
    echo "lull is installed already; not touched" >&2
    exit 1
fi
cd "$(mktemp -d)"
trap 'rm -rf "$PWD"' EXIT
apt-get install -y --no-install-recommends "$package"
trap 'apt-get purge -y lull; rm -rf "$PWD"' EXIT
dpkg -L lull >files

# The program, with the default rule, which has to find its model.
/usr/bin/lull --version
cat >scene.pbrt <<'SCENE'
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
LightSource "infinite"
Shape "sphere"
WorldEnd
SCENE
for spp in 20 40 60; do
    /usr/bin/lull render scene.pbrt --resolution 80x60 --cap $spp --quiet -o $spp.exr
done
bash -c '. /usr/share/bash-completion/completions/lull && complete -p lull'
[[ -r /usr/share/man/man1/lull.1 ]]

# Files for other programs. Where the package has no Python module, there is nothing to import.
cp -r /usr/share/doc/lull/examples .
if [[ -e /usr/include/png.h ]]; then
    cmake -S examples -B build && cmake --build build
    build/watch_pngs 20 20.png 40.png 60.png
fi
if grep -q '/lull/_lull\.[^/]*\.so$' files; then
    /usr/bin/python3 -c 'import lull; print(lull.Stopper(200, 200).blocks)'
fi

apt-get purge -y lull
trap 'rm -rf "$PWD"' EXIT
left=()
while IFS= read -r file; do
    [[ -d $file && $file != */lull* || ! -e $file && ! -L $file ]] || left+=("$file")
done <files
if ((${#left[@]})) || dpkg-query -W lull 2>/dev/null; then
    echo "left behind: ${left[*]}" >&2
    exit 1
fi
echo "installed, run and removed"
