#!/usr/bin/env bash
# Installs, builds and simulates the hourglass; its pictures end up in out/hourglass. Needs Debian 12, no GPU.
#   demo.sh [options of loam-run]      for example: demo.sh --backend cpu
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scene=samples/scenes/hourglass/scene.toml
output=out/hourglass

scripts/install_dependencies.sh demo

say "Building the scene runner"
if [[ -f build/release/CMakeCache.txt ]]; then
  configure release >/dev/null
else
  configure release -DLOAM_BUILD_TESTS=OFF -DLOAM_BUILD_BENCHMARKS=OFF
fi
cmake --build --preset release --target loam-run

say "Simulating $scene"
mkdir -p "$output"
build/release/samples/loam-run "$scene" --out "$output" "$@"

say "Done. What was made, in $PWD/$output:"
find "$output" -maxdepth 1 -mindepth 1 -printf '%f\n' | sort | sed -n '1,20s/^/  /p'
count=$(find "$output" -name '*.png' | wc -l)
echo "  ($count pictures in all; the last: $(find "$output" -name '*.png' | sort | tail -n 1))"
