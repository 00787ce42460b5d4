#!/usr/bin/env bash
# Installs, builds and runs everything that guards the project. Needs Debian 12, no GPU; two cores will do.
#   test.sh            all steps but layout, which is a part of release
#   test.sh STEP...    some of them
# Steps:
#   format    every source is as clang-format leaves it
#   headers   every public header alone as C99, C++17 and C++20, the sample host and README's as C99, with gcc and clang
#   release   release build, warnings as errors; all tests
#   symbols   the library exports the functions of include/loam and nothing else
#   kernels   no instruction set's code can be reached from another
#   layout    sizes, offsets and values of the ABI against the baseline (the release step has this too)
#   package   a host project builds against the installed library, and configures with the source tree taken in; laws and cloth can be left out
#   tidy      clang-tidy over what stands above the kernels
#   asan      address and undefined-behaviour sanitizers: unit, abi, hard cases
#   tsan      thread sanitizer: determinism, the job system, two worlds at once, and the unit tests with threads
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

all_steps=(format headers release symbols kernels package tidy asan tsan)

sources() { git ls-files --cached "$@" | while IFS= read -r path; do [[ -f $path ]] && printf '%s\0' "$path"; done; }

source_patterns=('*.h' '*.hpp' '*.c' '*.cpp' '*.cu' '*.cuh')

# The version that the format was written for, where the system has it under that name.
tool() { command -v "$1-14" || command -v "$1" || die "$1 is missing"; }

build_release() {
  configure release -DLOAM_BUILD_TESTS=ON -DLOAM_BUILD_SAMPLES=ON -DLOAM_BUILD_BENCHMARKS=ON
  cmake --build --preset release "$@"
}

step_format() {
  local wrong
  wrong=$(sources "${source_patterns[@]}" | xargs -0 -r -P "$(jobs)" -n 40 "$(tool clang-format)" --dry-run -Werror 2>&1 |
    sed -n 's/^\([^: ]*\):[0-9]*:[0-9]*: error: .*/\1/p' | sort -u) || true
  if [[ -n $wrong ]]; then
    echo "not as clang-format leaves them; to repair: clang-format -i ${wrong//$'\n'/ }"
    return 1
  fi
  echo "$(sources "${source_patterns[@]}" | tr -cd '\0' | wc -c) sources are as clang-format leaves them"
}

step_headers() {
  local warnings=(-Wall -Wextra -Wpedantic -Werror -Iinclude -fsyntax-only) header standard
  for header in include/loam/*.h; do
    for standard in c99 c++17 c++20; do
      local language=c compilers=(gcc clang)
      if [[ $standard == c++* ]]; then language=c++ compilers=(g++ clang++); fi
      for compiler in "${compilers[@]}"; do
        printf '#include <loam/%s>\n' "${header##*/}" | "$compiler" -std="$standard" -x "$language" "${warnings[@]}" - ||
          die "$header does not compile alone as $standard with $compiler"
      done
    done
    echo "$header: C99, C++17, C++20"
  done
  for compiler in gcc clang; do
    "$compiler" -std=c99 "${warnings[@]}" samples/*.c
    # shellcheck disable=SC2016
    sed -n '/^```c$/,/^```$/{/^```/!p}' README.md | "$compiler" -std=c99 -x c "${warnings[@]}" -
  done
  echo "samples/*.c and the program in README.md: C99"
}

step_release() {
  build_release
  ctest --preset release
}

step_symbols() {
  build_release --target loam
  scripts/public_api.py compare-exports --library build/release/runtime/libloam.so
}

step_kernels() {
  build_release --target loam
  scripts/check_symbols.py build/release
}

step_layout() {
  build_release --target loam-tests-abi-layout
  ctest --preset release --tests-regex '^abi[.]layout$'
}

step_package() {
  local directory=$PWD/build/package-test
  build_release --target loam
  rm -rf "$directory"
  cmake --install build/release --prefix "$directory/prefix"
  cmake -G Ninja -S tests/package -B "$directory/found" -DCMAKE_PREFIX_PATH="$directory/prefix" -DCMAKE_BUILD_TYPE=Release
  cmake --build "$directory/found"
  "$directory/found/host"
  cmake -G Ninja -S tests/package -B "$directory/taken-in" -DLOAM_SOURCE="$PWD" -DLOAM_CUDA=OFF -DCMAKE_BUILD_TYPE=Release
  echo "a host builds against the installed library, and configures with the source tree"
  # Options that leave laws and cloth out: what they touch compiles without each of them.
  local left_out=() name
  for name in VON_MISES DRUCKER_PRAGER NACC HERSCHEL_BULKLEY STOMAKHIN_SNOW FLUID CLOTH; do left_out+=("-DLOAM_WITHOUT_$name"); done
  printf '%s\0' runtime/scene/material.cpp runtime/cpu/cpu_backend.cpp runtime/cpu/instruction_set_kernels.cpp |
    xargs -0 -n 1 -P "$(jobs)" g++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror -Iinclude -Iruntime -DLOAM_BUILDING \
      -DLOAM_PORTABLE_KERNELS -DLOAM_INSTRUCTION_SET=portable -DLOAM_PACK_WIDTH=4 "${left_out[@]}"
  echo "the library compiles without any law but elastic, and without cloth"
}

step_tidy() {
  # Sources that go together are looked at as one, for most of the time goes into the headers of each: their helpers must differ in name.
  mkdir -p build/tidy
  printf '%s\n' -std=c++20 "-I$PWD/include" "-I$PWD/runtime" "-I$PWD/samples/runner" -isystem /usr/include/stb -DLOAM_BUILDING \
    -Wall -Wextra -Wpedantic -Xclang -analyzer-opt-analyze-headers -Xclang -analyzer-config -Xclang max-nodes=30000 >build/tidy/compile_flags.txt
  # Of the paths through a function the first thirty thousand nodes: all of them take three times as long. The samples go without the
  # path-sensitive checks, and without the files whose libraries' headers take longest.
  together api 'runtime/api/*.cpp'
  together scene 'runtime/scene/[a-q]*.cpp'
  together solver 'runtime/scene/[r-z]*.cpp' 'runtime/schedule/*.cpp' 'runtime/solver/*.cpp'
  local reader=samples/runner/scene_reader.cpp renderer=samples/runner/picture/renderer.cpp
  together runner 'samples/*.cpp' ":!${renderer%/*}" ":!$reader"
  together picture "${renderer%/*}/*.cpp" ":!$renderer"
  together reader "$reader" "$renderer"
  local checks=--checks=-bugprone-suspicious-include
  printf "build/tidy/%s.cpp $checks%s\n" solver '' scene '' api '' runner ,-clang-analyzer-* reader ,-clang-analyzer-* picture ,-clang-analyzer-* |
    xargs -P "$(jobs)" -L 1 "$(tool clang-tidy)" -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option 2> >(without_counts >&2)
  if grep -qsF device_memory_cuda.cpp build/release/compile_commands.json; then # what it includes is not on every machine
    "$(tool clang-tidy)" -p build/release --quiet '--checks=-clang-analyzer-*' samples/runner/device_memory_cuda.cpp 2> >(without_counts >&2)
  fi
  echo "clang-tidy has no complaint"
}

# One translation unit of many.
together() {
  sources "${@:2}" | { xargs -0 grep -LE '#include <(CLI|toml|nlohmann|cuda)' || true; } | sed "s|.*|#include \"$PWD/&\"|" >"build/tidy/$1.cpp"
}
without_counts() { grep -vE '^[0-9]+ warnings? generated' || true; }

step_asan() {
  configure asan
  cmake --build --preset asan
  ctest --preset asan --label-regex '^(unit|abi|hard_cases)$'
}

step_tsan() {
  configure tsan
  cmake --build --preset tsan
  # All but those on one thread.
  ctest --preset tsan --label-regex '^(unit|determinism)$' \
    --exclude-regex '[./](Snapshot|StateHash|Origin|Torus|Stream)|SameBits[.](RunAfterRun|ForEveryInstructionSet)'
  ctest --preset tsan --tests-regex '^abi[.](JobSystem|TwoWorlds)[.]'
}

if [[ ${1:-} == --run ]]; then
  "step_$2"
  exit
fi

steps=("$@")
[[ ${#steps[@]} -gt 0 ]] || steps=("${all_steps[@]}")
for step in "${steps[@]}"; do
  declare -F "step_$step" >/dev/null || die "no step '$step'; there are: ${all_steps[*]} layout"
done

scripts/install_dependencies.sh tests

summary=()
passed=0
failed=0
for step in "${steps[@]}"; do
  say "$step"
  start=$SECONDS
  if bash scripts/test.sh --run "$step"; then
    result=passed
    passed=$((passed + 1))
  else
    result=FAILED
    failed=$((failed + 1))
  fi
  summary+=("$(printf '  %-8s %-6s %4d s' "$step" "$result" $((SECONDS - start)))")
done

say "Summary (${SECONDS} s)"
printf '%s\n' "${summary[@]}"
echo "steps: $passed passed, $failed failed"
[[ $failed -eq 0 ]]
