#!/usr/bin/env bash
# Experiments that take too long for the tests. Builds what is missing, shows how far it is, and ends with 0 if what was measured is in its bounds.
#   study.sh rest [--solver gauss_seidel|jacobi] [--seconds S] [--settling S] [--threads N]    a heap of sand for ten minutes: creep, energy
#   study.sh bag [--seconds S] [--height H] [--kernel-radius R] [--threads N]    a bag of cloth full of sand that falls: does it leak?
#   study.sh budget [--milliseconds MS] [--particles N] [--frames N] [--threads N]    sand that doubles, in steps to a budget: is it kept?
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

what=${1:-}
case $what in
  rest | bag | budget) ;;
  *) die "unknown study '$what'; there are: rest, bag, budget" ;;
esac
shift

if [[ ! -f build/release/CMakeCache.txt ]]; then configure release; fi
cmake --build --preset release --target "loam-study-$what"
exec "build/release/tests/studies/loam-study-$what" "$@"
