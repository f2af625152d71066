#!/bin/bash
# Runs a test program of GoogleTest, or the part of it that GTEST_SHARD_INDEX names. If it does not reach its end, runs each of its
# tests by itself and names those that fail: run_shard.sh PROGRAM
set -uo pipefail
program=$1
output=$(mktemp)
trap 'rm -f "$output"' EXIT
"$program" 2>&1 | tee "$output"
result=${PIPESTATUS[0]}
grep -q '^\[==========\] .* ran\. ' "$output" && exit "$result"

echo "$program ended with exit code $result before its last test; the tests that fail by themselves:"
unset GTEST_TOTAL_SHARDS GTEST_SHARD_INDEX
"$program" --gtest_list_tests | awk '/^[^ ]/ {suite = $1; next} /^  / {print suite $1}' | while read -r test; do
    "$program" --gtest_filter="$test" --gtest_brief=1 >"$output" 2>&1 </dev/null || { echo "== $test"; cat "$output"; }
done
exit 1
