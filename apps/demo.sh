#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From a fresh checkout to results in one step: installs what is missing, builds the program, runs
# its demo. Arguments are handed on, for instance: apps/demo.sh --quick --out /tmp/demo
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$root/apps/setup.sh"
(cd "$root" && cmake --preset release && cmake --build --preset release --target facula)
"$root/build/release/bin/facula" demo "$@"
echo
echo "The demo's folder is $(pwd)/demo unless --out named another; report.html in it shows everything."
