#!/usr/bin/env bash
# Experiments that take too long for the tests. Builds what is missing, shows how far it is, and ends with 0 if what was measured is in its bounds.
#   study.sh rest [--solver gauss_seidel|jacobi] [--seconds S] [--settling S] [--threads N]    a heap of sand for ten minutes: creep, energy
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

what=${1:-}
case $what in
  rest) ;;
  *) die "unknown study '$what'; there is: rest" ;;
esac
shift

if [[ ! -f build/release/CMakeCache.txt ]]; then configure release; fi
cmake --build --preset release --target "loam-study-$what"
exec "build/release/tests/studies/loam-study-$what" "$@"
