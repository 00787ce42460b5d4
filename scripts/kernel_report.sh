#!/usr/bin/env bash
# A table of what each CUDA kernel takes: registers, stack, spilled bytes. Fails if a kernel spills. Needs nvcc, no GPU.
#   kernel_report.sh [ARCHITECTURE]      for example 75; default 90
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

architecture=${1:-90}
command -v nvcc >/dev/null || die "nvcc is not on the PATH"

directory=build/kernel-report
say "Configuring for sm_$architecture"
cmake -G Ninja -S . -B "$directory" -DCMAKE_BUILD_TYPE=Release -DLOAM_CUDA=ON -DCMAKE_CUDA_ARCHITECTURES="$architecture-real" \
  -DLOAM_BUILD_SAMPLES=OFF -DLOAM_BUILD_TESTS=OFF -DLOAM_BUILD_BENCHMARKS=OFF >/dev/null

say "Compiling the CUDA sources"
python3 scripts/kernel_report.py "$directory/compile_commands.json"
