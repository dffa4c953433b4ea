#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what Facula needs on Debian 12 and is not there yet. Running it again does nothing.
# With --check it only lists what is missing (exit status 1 when something is). With --peers it
# installs what the benchmarks compare with instead; neither build nor tests need that.
set -euo pipefail

packages=(
  # compiler, build, and the tools of the house tests
  g++ cmake ninja-build pkg-config ccache clang-format clang-tidy libclang-14-dev llvm-14-dev
  universal-ctags xz-utils
  # geometry, images, point clouds, meshes, maps, ray casting
  libeigen3-dev libopencv-dev libpcl-dev libcgal-dev liboctomap-dev libflann-dev libembree-dev
  libtbb-dev libceres-dev libhwy-dev libassimp-dev libompl-dev
  # the mapper for many machines, facula-map-mpi
  libopenmpi-dev openmpi-bin
  # files, command line, messages
  libtomlplusplus-dev nlohmann-json3-dev libcli11-dev libspdlog-dev libboost-iostreams-dev
  zlib1g-dev liblzma-dev liblz4-dev
  # tests and benchmarks
  libgtest-dev libbenchmark-dev libdynamicedt3d-dev
)

# Open3D, through its Python.
peers=(python3-open3d)

fail() {
  echo "setup: $*" >&2
  exit 1
}

[[ ${1:-} != --peers ]] || packages=("${peers[@]}")

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    [[ $(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null) == ii* ]] || echo "$package"
  done
}

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
  fail "this script knows Debian and its apt-get only; install by hand: ${packages[*]}"

mapfile -t missing < <(missing_packages)
[[ ${#missing[@]} -gt 0 ]] || exit 0
if [[ ${1:-} == --check ]]; then
  printf '%s\n' "${missing[@]}"
  exit 1
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null ||
    fail "run as root, or install sudo; still to be installed: ${missing[*]}"
  echo "setup: asking sudo for the right to install packages"
  as_root=(sudo)
fi

echo "setup: installing ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q \
  -o APT::Update::Error-Mode=any ||
  fail "apt-get could not fetch the package lists; check the network and /etc/apt/sources.list"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
  "${missing[@]}" ||
  fail "apt-get could not install ${missing[*]}; its message stands above; is this Debian 12?"
