# Names the Debian packages that lull needs and installs those that are missing; to be sourced.

build_packages="g++ cmake ninja-build libcli11-dev libdraco-dev libeigen3-dev libembree-dev libfmt-dev
    libhdf5-dev libimath-dev libmeshoptimizer-dev libopenexr-dev libopenimageio-dev libpng-dev
    libtbb-dev libtinygltf-dev nlohmann-json3-dev zlib1g-dev"
test_packages="clang-format dpkg-dev file libgtest-dev libopenmpi-dev openmpi-bin
    pybind11-dev python3-dev python3-numpy"

# install_packages NAME...: does nothing, not even a call of apt-get, where all are there.
install_packages() {
    local missing=() name sudo=
    for name; do
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null) == installed ]] ||
            missing+=("$name")
    done
    ((${#missing[@]})) || return 0
    if ! command -v apt-get >/dev/null; then
        echo "No apt-get here; lull needs what Debian calls: $*" >&2
        return 0 # CMake names the missing ones
    fi
    echo "Installing: ${missing[*]}"
    ((EUID == 0)) || sudo=sudo
    $sudo apt-get update -qq || echo "apt-get update failed; trying with the lists there are" >&2
    $sudo env DEBIAN_FRONTEND=noninteractive \
        apt-get install -qq -y --no-install-recommends "${missing[@]}" >/dev/null
}

# install_browser: Chromium and Python for the test of the report pages, if they can be had within a
# minute or so; CMake leaves the test out where they are not. Only the download has a limit, as an
# installation that was cut off would leave the system broken.
install_browser() {
    command -v chromium >/dev/null && command -v python3 >/dev/null && return 0
    command -v apt-get >/dev/null || return 0
    local sudo=
    ((EUID == 0)) || sudo=sudo
    echo "Installing, if possible: chromium python3"
    $sudo timeout 45 apt-get install -qq -y --no-install-recommends --download-only \
        chromium python3 >/dev/null 2>&1 &&
        $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends \
            --no-download chromium python3 >/dev/null 2>&1 ||
        echo "No Chromium: the report pages will not be tested" >&2
}
