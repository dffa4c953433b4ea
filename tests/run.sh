#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sets up, builds and runs every test. Arguments go to ctest, e.g. tests/run.sh -LE tidy
set -euo pipefail
cd "$(dirname "$0")/.."
apps/setup.sh
cmake --preset release
cmake --build --preset release
ctest --test-dir build/release --output-on-failure -j "$(nproc)" "$@"
