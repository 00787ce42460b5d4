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
cmake --build --preset release --target loam-accuracy
say "Measuring"
build/release/benchmarks/loam-accuracy --out "$output" "$@"

table=$output/accuracy.csv page=$output/accuracy.html
if [[ $# -eq 0 ]]; then
  model=$(lscpu | sed -n 's/^Model name: *//p' | sed -n 1p)
  table=benchmarks/results/accuracy-$(tr -cs '[:alnum:]\n' '-' <<<"$model" | tr '[:upper:]' '[:lower:]' | sed 's/-$//').csv
  page=docs/accuracy.html
  cp "$output/accuracy.csv" "$table"
fi
say "Writing"
/usr/bin/python3 scripts/accuracy.py "$table" --out "$page"
