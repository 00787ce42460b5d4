#!/usr/bin/env bash
# Looks for input that breaks the library or the scene runner's readers, for as long as asked. Installs what is missing and builds.
#   fuzz.sh [obj|scene|snapshot|random] [SECONDS]    obj, scene, snapshot: libFuzzer on the reader; random: random scenes under sanitizers; none named: all
#
# What a fuzzer finds is left in build/fuzz/findings; a file that broke a reader belongs into tests/fuzz/corpus once the reader is repaired, where
# the tests replay it. New files of the corpus are kept in build/fuzz/corpus; `fuzz.sh merge` takes those into the tree that reach code of their own.
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

what=${1:-all}
seconds=${2:-600}

build_targets() {
  scripts/install_dependencies.sh fuzz
  configure fuzz
  cmake --build --preset fuzz
}

run_target() {
  local new=build/fuzz/corpus/$1 dictionary=()
  if [[ -f tests/fuzz/$1.dict ]]; then dictionary=("-dict=tests/fuzz/$1.dict"); fi
  mkdir -p "$new" build/fuzz/findings
  "build/fuzz/tests/fuzz/fuzz_$1" -max_total_time="$seconds" -max_len=8192 -timeout=60 -rss_limit_mb=2048 -print_final_stats=1 \
    "${dictionary[@]}" -artifact_prefix="build/fuzz/findings/$1-" "$new" "tests/fuzz/corpus/$1"
}

merge_target() {
  "build/fuzz/tests/fuzz/fuzz_$1" -merge=1 -max_len=2048 "tests/fuzz/corpus/$1" "build/fuzz/corpus/$1"
}

run_random() {
  scripts/install_dependencies.sh tests
  configure asan
  cmake --build --preset asan --target random_scenes
  build/asan/tests/fuzz/random_scenes --seed "${SEED:-$(date +%s)}" --seconds "$seconds"
}

case $what in
  obj | scene | snapshot) build_targets && run_target "$what" ;;
  random) run_random ;;
  merge) build_targets && merge_target obj && merge_target scene && merge_target snapshot ;;
  all) build_targets && run_target obj && run_target scene && run_target snapshot && run_random ;;
  *) die "unknown target '$what': obj, scene, snapshot, random or merge" ;;
esac
