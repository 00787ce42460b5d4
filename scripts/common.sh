# shellcheck shell=bash
# Sourced by the other scripts: stands in the root of the tree and gives them a voice.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

jobs() { nproc 2>/dev/null || echo 2; }

# configure PRESET [cmake options]: with ccache, where there is one.
configure() {
  local preset=$1
  shift
  local options=()
  if command -v ccache >/dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
  fi
  cmake --preset "$preset" "${options[@]}" "$@"
}
