#!/usr/bin/env bash
# tools/fuzz.sh PROGRAM: feeds one fuzz target for a few seconds, from its kept corpus and from what earlier runs found,
# unless it is what it was when it passed.
set -euo pipefail
name=$(basename "$1" _fuzz)
found=build/fuzz/corpus/$name
kept=tests/fuzz/corpus/$name
mkdir -p "$found"
arguments=("$found")
if [ -d "$kept" ]; then arguments+=("$kept"); fi
if [ -f "tests/fuzz/$name.dict" ]; then arguments+=("-dict=tests/fuzz/$name.dict"); fi
mark=$(find "$1" tests/fuzz -type f -path "*$name*" -print0 | sort -z | xargs -0 sha256sum | sha256sum)
known=build/passed/fuzz/$name
if [ "$(cat "$known" 2>/dev/null)" = "$mark" ]; then
    echo "unchanged since it passed: $1"
    exit
fi
OMP_NUM_THREADS=1 "$1" -max_total_time=4 -timeout=10 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/crashes/$name-" "${arguments[@]}"
mkdir -p "$(dirname "$known")"
echo "$mark" >"$known"
