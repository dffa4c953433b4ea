#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sets up, builds and runs every test. Arguments go to ctest, e.g. tests/run.sh -LE tidy
set -euo pipefail
cd "$(dirname "$0")/.."
apps/setup.sh
cmake --preset release
cmake --build --preset release
status=0
ctest --test-dir build/release --output-on-failure -j "$(nproc)" "$@" || status=$?
# Tests on real data that is not on this machine were skipped: say which sets.
log=build/release/Testing/Temporary/LastTest.log
{ grep -oh "real data set '[^']*' is absent" "$log" || true; } | sort -u | sed 's/^/skipped: /'
exit "$status"
