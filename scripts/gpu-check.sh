#!/usr/bin/env bash
# What only a machine with a GPU can tell: builds, runs all tests on both backends, the same scene on both, the same bits twice, memory checks
# on the device, and the benchmarks. Downloads nothing: what the system lacks is taken from .carry/ (see carry.sh). Ends within 10 minutes on
# 16 cores: each step has a limit, and what is left of the 10 minutes.
#   gpu-check.sh OUT        writes OUT/gpu-check.json, OUT/gpu-check.md and the logs; exits 2 where there is no GPU, 1 if a step failed
out=$(mkdir -p "${1:?usage: gpu-check.sh OUT}" && cd "$1" && pwd)
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

budget=580
build=build/gpu-check
scene=samples/scenes/hourglass/scene.toml

if ! nvidia-smi -L >/dev/null 2>&1; then
  echo "no GPU here: nvidia-smi is missing or finds none" >&2
  exit 2
fi
command -v nvcc >/dev/null || export PATH=$PATH:/usr/local/cuda/bin
command -v nvcc >/dev/null || die "nvcc is neither on the PATH nor in /usr/local/cuda/bin"
query() { nvidia-smi --query-gpu="$1" --format=csv,noheader --id=0 | sed -n 1p; }
architecture=$(query compute_cap | tr -d '. ')

logs=$out/logs
mkdir -p "$logs"
: >"$logs/steps.tsv"

# step NAME LIMIT command...: runs it for at most LIMIT seconds; its exit status, time and output are kept, and the next step follows.
step() {
  local name=$1 limit=$2 start=$SECONDS status=0 left
  shift 2
  left=$((budget - SECONDS))
  [[ $left -gt 5 ]] || left=5
  [[ $limit -lt $left ]] || limit=$left
  say "$name (at most $limit s)"
  timeout --kill-after=5 "$limit" "$@" >"$logs/$name.log" 2>&1 || status=$?
  tail -n 15 "$logs/$name.log"
  echo "-- $name: exit status $status, $((SECONDS - start)) s"
  printf '%s\t%d\t%d\n' "$name" "$status" $((SECONDS - start)) >>"$logs/steps.tsv"
}

options=(-DCMAKE_BUILD_TYPE=Release -DLOAM_CUDA=ON -DCMAKE_CUDA_ARCHITECTURES="$architecture" -DLOAM_WARNINGS_AS_ERRORS=OFF)
if [[ -f .carry/libraries.tar.gz ]]; then
  rm -rf build/carried
  mkdir -p build/carried
  tar --extract --gzip --file .carry/libraries.tar.gz --directory build/carried
  carried=$PWD/build/carried/usr
  options+=(-DCMAKE_PREFIX_PATH="$carried" -DCMAKE_LIBRARY_ARCHITECTURE=x86_64-linux-gnu -DCMAKE_LIBRARY_PATH="$carried/lib/x86_64-linux-gnu")
  export C_INCLUDE_PATH=$carried/include CPLUS_INCLUDE_PATH=$carried/include LIBRARY_PATH=$carried/lib/x86_64-linux-gnu LD_LIBRARY_PATH=$carried/lib/x86_64-linux-gnu
  export PKG_CONFIG_PATH=$carried/lib/x86_64-linux-gnu/pkgconfig:$carried/share/pkgconfig PKG_CONFIG_SYSROOT_DIR=$PWD/build/carried
fi
generator=()
if command -v ninja >/dev/null; then generator=(-G Ninja); fi
rm -f "$build/CMakeCache.txt"

run=$build/samples/loam-run
tests() { step "tests-$1" "$2" env LOAM_TEST_BACKEND="$1" ctest --test-dir "$build" --no-tests=error --output-on-failure -j "$(($(jobs) / 2))" --timeout 100; }
simulate() { "$run" "$scene" --no-pictures --ply-every 0 "${@:2}" --out "$out/runs/$1"; }
hash_of() { sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$out/runs/$1/stats.json"; }
same_bits() {
  simulate first --backend cuda --frames 60
  simulate second --backend cuda --frames 60
  echo "state_hash $(hash_of first), then $(hash_of second)"
  [[ -n $(hash_of first) && $(hash_of first) == "$(hash_of second)" ]]
}
same_story() {
  simulate cpu --backend cpu --frames 120
  simulate cuda --backend cuda --frames 120
  scripts/compare_runs.py "$out/runs/cpu" "$out/runs/cuda"
}
benchmarks() {
  local programs program
  mapfile -t programs < <(find "$build/benchmarks" -maxdepth 1 -type f -executable -name 'loam*')
  [[ ${#programs[@]} -gt 0 ]] || { echo "no benchmark was built"; return 1; }
  for program in "${programs[@]}"; do "$program" --benchmark_out="$out/${program##*/}.json" --benchmark_out_format=json; done
}
export -f simulate hash_of same_bits same_story benchmarks
export run scene out logs build

step configure 90 cmake "${generator[@]}" -S . -B "$build" "${options[@]}"
step build 280 cmake --build "$build" --parallel "$(jobs)"
tests cuda 100
tests cpu 80
step parity 60 ctest --test-dir "$build" --no-tests=error --output-on-failure --label-regex '^gpu$' --timeout 50
step same-bits 60 bash -euo pipefail -c same_bits
step same-story 60 bash -euo pipefail -c same_story
if command -v compute-sanitizer >/dev/null; then
  for tool in memcheck initcheck racecheck; do
    step "$tool" 45 compute-sanitizer --tool "$tool" --error-exitcode 9 \
      "$run" "$scene" --backend cuda --frames 1 --scale 0.02 --no-pictures --ply-every 0 --out "$out/runs/$tool"
  done
else
  echo "compute-sanitizer is missing: not run"
fi
step benchmarks 90 bash -euo pipefail -c benchmarks
# A second build, without fused multiply-adds, has the bits of the tiles that the tests emulate on the CPU.
step parity-configure 60 cmake "${generator[@]}" -S . -B build/gpu-parity "${options[@]}" -DLOAM_CUDA_PARITY=ON -DLOAM_BUILD_SAMPLES=OFF -DLOAM_BUILD_BENCHMARKS=OFF
step parity-build 180 cmake --build build/gpu-parity --parallel "$(jobs)" --target loam-tests-gpu
step parity-bits 60 env LOAM_TEST_CUDA_PARITY=1 build/gpu-parity/tests/loam-tests-gpu

GPU=$(query name) DRIVER=$(query driver_version) MEMORY=$(query memory.total) ARCHITECTURE=$architecture \
  COMMIT=$(git rev-parse HEAD 2>/dev/null || echo unknown) CHANGED=$(git status --porcelain --untracked-files=no 2>/dev/null | wc -l) \
  NVCC=$(nvcc --version | sed -n 's/.*release \(.*\),.*/\1/p') python3 - "$out" <<'PYTHON'
import json, os, pathlib, sys

out = pathlib.Path(sys.argv[1])
machine = {name.lower(): os.environ[name] for name in ("GPU", "MEMORY", "DRIVER", "NVCC", "ARCHITECTURE", "COMMIT")}
machine["changed_files"] = int(os.environ["CHANGED"])
machine["cpu"] = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown")
machine["cores"] = os.cpu_count()
steps = []
for line in (out / "logs" / "steps.tsv").read_text().splitlines():
    name, status, seconds = line.split("\t")
    tail = (out / "logs" / f"{name}.log").read_text(errors="replace").splitlines()[-40:]
    steps.append({"name": name, "status": int(status), "timed_out": int(status) in (124, 137), "seconds": int(seconds), "tail": tail})
(out / "gpu-check.json").write_text(json.dumps({"machine": machine, "steps": steps}, indent=1) + "\n")

rows = [f"| {step['name']} | {'passed' if step['status'] == 0 else 'timed out' if step['timed_out'] else 'failed (%d)' % step['status']} "
        f"| {step['seconds']} s |" for step in steps]
tails = [f"## {step['name']}\n\n```\n" + "\n".join(step["tail"]) + "\n```\n" for step in steps]
(out / "gpu-check.md").write_text(
    f"# GPU check\n\n{machine['gpu']}, {machine['memory']}, driver {machine['driver']}, nvcc {machine['nvcc']}, sm_{machine['architecture']};\n"
    f"{machine['cpu']}, {machine['cores']} cores. Commit {machine['commit']}"
    + (f", {machine['changed_files']} files changed" if machine["changed_files"] else "") + ".\n\n"
    "| step | result | time |\n| --- | --- | --- |\n" + "\n".join(rows) + "\n\n" + "\n".join(tails))
passed = sum(step["status"] == 0 for step in steps)
print("\n".join(["", *rows, f"steps: {passed} passed, {len(steps) - passed} failed"]))
sys.exit(0 if passed == len(steps) else 1)
PYTHON
