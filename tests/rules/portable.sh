#!/bin/sh
# portable.sh ROOT: the engines, what they stand on, and the dispatchers must compile for a processor without vector kernels.
# 77: no compiler for it. Scenes, outputs and commands know nothing of processors.
compiler=$(command -v aarch64-linux-gnu-g++) || { echo "no aarch64-linux-gnu-g++"; exit 77; }
cd "$1" || exit 1
empty=$(mktemp -d) || exit 1
trap 'rm -r "$empty"' EXIT
: >"$empty/isas.def" # no vector kernels
# The headers of the libraries are the same for every processor; those of C and C++ are the cross compiler's own.
printf '%s\0' src/core/*.cpp src/laws/*.cpp src/motion/*.cpp src/md/*.cpp src/md/reference/*.cpp src/dsmc/*.cpp src/automata/*.cpp \
    src/app/check.cpp simd/dispatch.cpp simd/*/dispatch.cpp | xargs -0 -n 4 "$compiler" -fsyntax-only -std=c++20 -fopenmp \
    -Wall -Wextra -Wconversion -Wshadow -Werror -DSANDLANE_VERSION='"-"' -DSANDLANE_COMPILER='"-"' \
    -Isrc -I. -I"$empty" -isystem /usr/include/eigen3 -isystem /usr/include
