#!/bin/bash
# Really installs the package of a build, runs what it has put there and removes it again; as root,
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

/usr/bin/lull --version
man -w lull >/dev/null 2>&1 || test -r /usr/share/man/man1/lull.1.gz -o -r /usr/share/man/man1/lull.1
cp -r /usr/share/doc/lull/examples .
[[ ! -e /usr/include/png.h ]] || { cmake -S examples -B build && cmake --build build; }
/usr/bin/python3 -c 'import lull; print(lull.Stopper(200, 200).blocks)' || [[ ! -e /usr/lib/python3/dist-packages/lull* ]]

apt-get purge -y lull
trap 'rm -rf "$PWD"' EXIT
for left in /usr/bin/lull /usr/include/lull /usr/share/lull /usr/lib/liblull_stopping.so; do
    [[ ! -e $left ]] || { echo "left behind: $left" >&2; exit 1; }
done
echo "installed, run and removed"
