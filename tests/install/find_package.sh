#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs a build into a temporary prefix, moves that elsewhere, and builds and runs a small
# project that finds Facula there.
# Usage: find_package.sh BUILD CONSUMER GENERATOR
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$1" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/prefix"
if grep -rlE --include='*.cmake' "$(realpath "$1")|$(realpath "$2/../../..")" "$work/prefix"; then
  echo "these installed files name the source or build tree"
  exit 1
fi
cmake -S "$2" -B "$work/build" -G "$3" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
grep -F "Facula_DIR:PATH=$work/prefix" "$work/build/CMakeCache.txt"
cmake --build "$work/build"
cd "$work"
build/consumer
if [[ -x prefix/bin/facula ]]; then prefix/bin/facula --version; fi
