# shellcheck shell=bash
# Sourced by the other scripts: stands in the root of the tree and gives them a voice.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

jobs() { nproc 2>/dev/null || echo 2; }

# configure PRESET [cmake options]: quietly, unless it fails; with ccache, where there is one.
configure() {
  local preset=$1 options=() output
  shift
  if command -v ccache >/dev/null; then
    export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros # the latter for precompiled headers
    options=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
  fi
  output=$(cmake --preset "$preset" "${options[@]}" "$@" 2>&1) || { printf '%s\n' "$output"; die "configuring $preset failed"; }
  grep -E '^CMake Warning|CUDA compiler identification' <<<"$output" || true
  echo "configured $preset in build/$preset"
}
