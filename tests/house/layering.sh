#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fails when the tree below ROOT breaks the house's floors: an include that runs up, a heavy library
# outside the files named for it, a folder without an idea, a source file that nobody builds.
# Usage: layering.sh ROOT
set -euo pipefail
cd "$1"
rooms=()
for room in acquire reconstruct map apps tests; do [[ -d $room ]] && rooms+=("$room"); done
complaints=0

complain() {
  echo "$*"
  complaints=$((complaints + 1))
}

# The floor a path lies on.
floor_of() {
  case $1 in
    acquire/core/*) echo core ;;
    tests/support/*) echo support ;;
    *) echo "${1%%/*}" ;;
  esac
}

# The floors that a floor may see.
declare -A sees=(
  [core]="core"
  [acquire]="core acquire"
  [reconstruct]="core reconstruct"
  [map]="core reconstruct map"
  [apps]="core acquire reconstruct map apps"
  [support]="core support"
  [tests]="core acquire reconstruct map apps support tests"
)

# The heavy library an include belongs to, as it stands in file names; nothing for others.
heavy_library() {
  case $1 in
    pcl/*) echo pcl ;;
    CGAL/*) echo cgal ;;
    opencv2/* | opencv/*) echo opencv ;;
    octomap/* | dynamicEDT3D/*) echo octomap ;;
    flann/*) echo flann ;;
    ceres/*) echo ceres ;;
    embree*/*) echo embree ;;
    ompl/*) echo ompl ;;
  esac
}

check_own_include() {
  local file=$1 target=$2
  local from to
  from=$(floor_of "$file")
  to=$(floor_of "$target")
  [[ -e $target ]] || complain "$file includes <facula/$target>, which is not there"
  [[ " ${sees[$from]} " == *" $to "* ]] ||
    complain "$file ($from) includes <facula/$target> ($to): the arrow runs up"
}

check_foreign_include() {
  local file=$1 target=$2
  if [[ $file == acquire/core/* && $target == */* && $target != Eigen/* && $target != sys/* ]]; then
    complain "$file includes <$target>: acquire/core knows Eigen and the standard library only"
  fi
  local library stem
  library=$(heavy_library "$target")
  [[ -n $library ]] || return 0
  stem=$(basename "${file%.*}")
  if [[ $file == *.hpp ]]; then
    [[ $stem == "${library}_bridge" ]] ||
      complain "$file includes <$target>: of the headers only ${library}_bridge.hpp may"
  elif [[ ! $stem =~ (^|_)${library}(_|$) ]]; then
    complain "$file includes <$target>: only files named *_$library.cpp may"
  fi
}

check_includes() {
  local line file include
  while IFS= read -r line; do
    file=${line%%:*}
    include=${line#*:}
    if [[ $include =~ ^[[:space:]]*\#[[:space:]]*include[[:space:]]*\<facula/([^>]+)\> ]]; then
      check_own_include "$file" "${BASH_REMATCH[1]}"
    elif [[ $include =~ ^[[:space:]]*\#[[:space:]]*include[[:space:]]*\<([^>]+)\> ]]; then
      check_foreign_include "$file" "${BASH_REMATCH[1]}"
    else
      complain "$file includes by quotes: write #include <facula/...>"
    fi
  done < <(grep -rHE '^[[:space:]]*#[[:space:]]*include' "${rooms[@]}" \
             --include='*.hpp' --include='*.cpp' | grep -v '^tests/install/consumer/' || true)
}

check_folders() {
  local folder
  while IFS= read -r folder; do
    complain "$folder/: name a folder after its idea"
  done < <(find "${rooms[@]}" -type d -regextype posix-extended \
             -regex '.*/(utils?|common|misc|helpers?)')
}

# Whether a CMakeLists.txt in a folder above the file lists it by its path from there. Tests and
# benchmarks are also listed by their bare name, room/name for name_test.cpp, name for bench_name.cpp
# and name_fuzz.cpp.
is_built() {
  local file=$1 folder=$1 name
  while [[ $folder == */* ]]; do
    folder=${folder%/*}
    [[ -f $folder/CMakeLists.txt ]] || continue
    name=${file#"$folder/"}
    grep -qE "(^|[[:space:](/])${name//./\\.}([[:space:])]|\$)" "$folder/CMakeLists.txt" && return 0
    [[ $file == tests/* ]] || continue
    name=$(basename "${file%.cpp}")
    name=${name%_test}
    name=${name%_fuzz}
    grep -qE "(^|[[:space:](/])${name#bench_}([[:space:])]|\$)" "$folder/CMakeLists.txt" && return 0
  done
  return 1
}

check_sources() {
  local file
  while IFS= read -r file; do
    is_built "$file" || complain "$file: no CMakeLists.txt lists it"
  done < <(find "${rooms[@]}" -name '*.cpp')
}

check_includes
check_folders
check_sources
[[ $complaints -eq 0 ]] || { echo "$complaints complaints"; exit 1; }
