#!/bin/bash
# Builds and tests this clone in a Debian system of its own: cmake/try_debian.sh SUITE [COMMAND]
#
# SUITE is bookworm, trixie, testing or any that debootstrap knows. Makes a bare system in $LULL_ROOTS/SUITE (default:
# build/roots/SUITE; kept for the next call, remove it as you like), copies this clone into it, with changes that are
# not committed, and runs there, without COMMAND, cmake/demo.sh and cmake/test.sh as root, then cmake/test.sh as a user
# who can install nothing. COMMAND runs alone, as root, in the clone. ../shared (or $LULL_SHARED) can be read there.
# The outputs are in SUITE/var/log/lull. Fails if anything fails, and prints what did.
set -euo pipefail
clone=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/..")
(($# == 1 || $# == 2)) || { sed -n '2,/^set/{/^set/d;s/^# \?//;p}' "$0" >&2; exit 2; }
suite=$1 command=${2-}
root=${LULL_ROOTS:-$clone/build/roots}/$suite
shared=$(readlink -f "${LULL_SHARED:-$clone/../shared}" || true)
if ((EUID != 0)); then
    exec sudo LULL_ROOTS="${LULL_ROOTS-}" LULL_SHARED="${LULL_SHARED-}" bash "$0" "$@"
fi

. "$clone/cmake/packages.sh"
install_packages debootstrap git rsync util-linux
if [[ ! -e $root/etc/lull-root ]]; then
    echo "== a root of $suite in $root"
    umount -q "$root/proc" || true # left there by a debootstrap that failed
    rm -rf --one-file-system "$root"
    mkdir -p "$root"
    debootstrap --variant=minbase "$suite" "$root" "${LULL_MIRROR:-http://deb.debian.org/debian}" >"$root.log" ||
        { tail -3 "$root.log" >&2; exit 1; }
    # The Release file of a snapshot of testing may be past its date.
    echo 'Acquire::Check-Valid-Until "false";' >"$root/etc/apt/apt.conf.d/90lull"
    chroot "$root" useradd -m lull
    touch "$root/etc/lull-root"
fi

# Files keep their times, so that a second call builds only what differs.
mkdir -p "$root/srv/lull/clone" "$root/srv/lull/shared" "$root/var/log/lull"
find "$root/srv/lull/clone" -mindepth 1 -maxdepth 1 ! -name build ! -name out -exec rm -rf {} +
(cd "$clone" && git ls-files -z --cached --others --exclude-standard | while IFS= read -rd '' f; do
    [[ ! -e $f ]] || printf '%s\0' "$f"
done) | rsync -a0 --files-from=- "$clone/" "$root/srv/lull/clone/"
chown -R 0:0 "$root/srv/lull/clone"

# inside NAME USER COMMAND: with mounts and processes of its own, of which nothing is left afterwards.
inside() {
    local log=$root/var/log/lull/$1.log start=$SECONDS rc=0
    echo "== $suite: $1"
    root=$root shared=$shared user=$2 command=$3 unshare --mount --pid --fork bash -c '
        set -e
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        mount --rbind /sys "$root/sys"
        [[ ! -d $shared ]] || mount --bind -o ro "$shared" "$root/srv/lull/shared"
        exec chroot "$root" su "$user" -s /bin/bash -c "export LC_ALL=C.UTF-8; cd /srv/lull/clone && $command"
    ' </dev/null >"$log" 2>&1 || rc=$?
    if ((rc)); then
        grep -E 'error:|\*\*\*Failed|\*\*\*Timeout|\*\*\*Exception|CMake Error|FAILED:' "$log" | head -40 || true
        tail -5 "$log"
        echo "$suite: $1 FAILED (exit code $rc, $((SECONDS - start)) s): $log"
        failed=1
    else
        tail -1 "$log"
        echo "$suite: $1 passed ($((SECONDS - start)) s)"
    fi
}

failed=0
if [[ $command ]]; then
    inside command root "$command"
else
    inside demo root "bash cmake/demo.sh"
    inside test root "bash cmake/test.sh"
    chroot "$root" chown -R lull: /srv/lull/clone
    inside user-test lull "bash cmake/test.sh"
fi
exit $failed
