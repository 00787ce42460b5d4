#!/usr/bin/env bash
# Runs the benchmarks and keeps the result as benchmarks/results/<cpu model>-<commit>.json and .md.
#
#   benchmarks/record.sh [PROGRAM] [OPTION...]    PROGRAM: build/release/benchmarks/loam-benchmarks; options go to it
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${1:-$root/build/release/benchmarks/loam-benchmarks}
shift || true
[[ -x $program ]] || { echo "record.sh: $program is not there: build it first" >&2; exit 1; }

model=$(lscpu | sed -n 's/^Model name: *//p' | sed -n 1p)
commit=$(git -C "$root" rev-parse --short HEAD)
git -C "$root" diff --quiet HEAD -- include runtime cuda benchmarks tests/reference tests/support || commit+=-modified
name=$(tr -cs '[:alnum:]\n' '-' <<<"$model" | tr '[:upper:]' '[:lower:]' | sed 's/-$//')-$commit
results=$root/benchmarks/results
mkdir -p "$results"

build=$(dirname "$(dirname "$program")")
cache=$build/CMakeCache.txt
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$cache" 2>/dev/null || true)
{
  echo "# ${model}, commit ${commit}"
  echo
  echo "- Processor: ${model}, $(nproc) cores, $(lscpu | sed -n 's/^L2 cache: *//p') L2, $(lscpu | sed -n 's/^L3 cache: *//p') L3"
  if command -v nvidia-smi >/dev/null && gpu=$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null); then
    echo "- GPU: $gpu"
  fi
  echo "- Compiler: $("${compiler:-c++}" --version | sed -n 1p)"
  echo "- Load when started: $(cut -d ' ' -f 1-3 /proc/loadavg)"
  echo
} >"$results/$name.md"

"$program" --benchmark_out="$results/$name.json" --benchmark_out_format=json "$@" |
  tee /dev/stderr | sed -n '/^Pair visits per second/,$p' >>"$results/$name.md"
echo "$results/$name.md"
