#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs apps/setup.sh against a pretended Debian: dpkg-query, apt-get and sudo are stand-ins that
# write down what they are asked for.
# Usage: setup.sh ROOT
set -euo pipefail
setup=$1/apps/setup.sh
fakes=$(mktemp -d)
trap 'rm -rf "$fakes"' EXIT
failures=0

stand_in() {  # stand_in NAME LINE...
  printf '%s\n' '#!/bin/bash' "${@:2}" >"$fakes/$1"
  chmod +x "$fakes/$1"
}

run() {
  : >"$fakes/log"
  status=0
  output=$(PATH=$fakes:$PATH FAKES=$fakes "$setup" 2>&1) || status=$?
}

expect() {  # expect SENTENCE COMMAND...
  "${@:2}" && return
  echo "not so: $1; status $status, output: $output, calls: $(cat "$fakes/log")"
  failures=$((failures + 1))
}

says() { [[ $output == *"$1"* ]]; }
asked() { grep -qF -- "$1" "$fakes/log"; }

stand_in sudo '"$@"'
stand_in apt-get 'echo "$@" >>"$FAKES/log"'
stand_in dpkg-query 'echo "ii "'
run
expect "with everything there it prints nothing" test -z "$output" -a "$status" -eq 0
expect "with everything there it calls no apt-get" test ! -s "$fakes/log"

stand_in dpkg-query 'case ${!#} in libcgal-dev) exit 1;; libembree-dev) echo "rc ";; *) echo "ii ";; esac'
run
expect "it succeeds" test "$status" -eq 0
expect "it fetches the lists first" asked "update"
expect "it installs what is missing and nothing else" \
  asked "install -q -y --no-install-recommends libcgal-dev libembree-dev"

stand_in apt-get '[[ $1 != update ]]'
run
expect "without a network it fails with a sentence" says "check the network"
expect "without a network its status tells" test "$status" -eq 1

stand_in apt-get '[[ $1 != install ]]'
run
expect "a failed installation names the packages" says "could not install libcgal-dev"
expect "a failed installation's status tells" test "$status" -eq 1
[[ $failures -eq 0 ]]
