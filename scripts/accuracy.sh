#!/usr/bin/env bash
# Measures how accurate settings are and what they cost, and writes docs/accuracy.html. Installs and builds what is missing; about ten minutes on a machine that does
# little else. The table goes to benchmarks/results/accuracy-<processor>.csv.
#   accuracy.sh [--quick] [--effect NAME ...]      quick: few settings, half a minute; it, or some effects alone, go to out/accuracy instead
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

output=out/accuracy
mkdir -p "$output"
scripts/install_dependencies.sh docs
if [[ ! -f build/release/CMakeCache.txt ]]; then configure release; fi
say "Building"
cmake --build --preset release --target loam-accuracy loam-run
say "Measuring"
build/release/benchmarks/loam-accuracy --out "$output" "$@"

table=$output/accuracy.csv page=$output/accuracy.html pictures=()
if [[ $# -eq 0 ]]; then
  model=$(lscpu | sed -n 's/^Model name: *//p' | sed -n 1p)
  table=benchmarks/results/accuracy-$(tr -cs '[:alnum:]\n' '-' <<<"$model" | tr '[:upper:]' '[:lower:]' | sed 's/-$//').csv
  page=docs/accuracy.html
  cp "$output/accuracy.csv" "$table"
  say "Pictures"
  for preset in fast balanced accurate reference; do # of the last frame
    build/release/samples/loam-run docs/accuracy/bridge.toml --out "$output/$preset" --accuracy "$preset" --ply-every 0 --picture-every 120
    python3 scripts/shrink_png.py "$output/$preset/frame_0120.png" "$output/$preset.png" 440
  done
  pictures=(--pictures "$output")
fi
say "Writing"
/usr/bin/python3 scripts/accuracy.py "$table" --out "$page" "${pictures[@]}"
