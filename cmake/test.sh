#!/bin/bash
# Installs missing packages, checks the format, the phrases and the includes, builds and runs all tests; then builds
# the tests of readers, states and interfaces once more with address and undefined-behaviour sanitizers and runs them.
# Fails if anything fails; the last line says how many tests were skipped in both builds, and why.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. cmake/packages.sh
exec </dev/null

install_packages $build_packages $test_packages
install_browser

# The format is that of clang-format 14; later versions break some lines elsewhere.
echo "== format"
if clang-format --version | grep -q 'version 14\.'; then
    find renderer stopping tests -name '*.h' -o -name '*.cpp' | xargs clang-format --dry-run -Werror
else
    echo "not checked: $(clang-format --version)"
fi

echo "== phrases"
bash cmake/check_phrases.sh

echo "== includes"
python3 cmake/check_includes.py

# Files are compiled 32 at a time: they share the time that their headers and templates take.
for preset in release sanitize; do
    echo "== $preset"
    cmake --preset $preset -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=32
    cmake --build --preset $preset
    ctest --preset $preset -j"$(nproc)"
done

# GoogleTest writes "FILE:LINE: Skipped" and below it why, with what differs behind a colon.
echo "== skipped"
skipped=$(sed -n '/: Skipped$/{n;s/:.*//;p}' build/{release,sanitize}/Testing/Temporary/LastTest.log |
    sort | uniq -c | sed 's/^ *//' | paste -sd, | sed 's/,/, /g')
echo "All passed; skipped: ${skipped:-none}"
