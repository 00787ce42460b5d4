#!/usr/bin/env bash
# Installs what is missing to build Loam on Debian 12, as root or through sudo. Does nothing, at once, where nothing is missing.
#   install_dependencies.sh [demo|tests|fuzz|docs]  demo: the library and the sample programs; tests (default): that and every check;
#                                                  fuzz: what libFuzzer needs; docs: what measures for the pages and draws their plots
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

group=${1:-tests}
packages=(g++ cmake ninja-build libtbb-dev libhwy-dev
  nlohmann-json3-dev libtomlplusplus-dev libstb-dev libfmt-dev libcli11-dev libembree-dev)
case $group in
  demo) ;;
  tests) packages+=(git python3 binutils clang clang-format clang-tidy libeigen3-dev libgtest-dev libbenchmark-dev) ;;
  fuzz) packages+=(clang libclang-rt-14-dev) ;;
  docs) packages+=(python3 python3-matplotlib libeigen3-dev libgtest-dev libbenchmark-dev) ;;
  *) die "unknown group '$group': demo, tests, fuzz or docs" ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "This is not a Debian system; install what these Debian packages hold: ${packages[*]}"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  case $package in
    # A tool that is there by other means will do.
    g++ | cmake | git | python3 | clang | clang-format | clang-tidy) command -v "$package" >/dev/null && continue ;;
    ninja-build) command -v ninja >/dev/null && continue ;;
    binutils) command -v nm >/dev/null && continue ;;
  esac
  if [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
    missing+=("$package")
  fi
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "dependencies ($group): all installed"
  exit 0
fi

say "Installing ${#missing[@]} packages: ${missing[*]}"
as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || die "installing needs root or sudo: apt-get install ${missing[*]}"
  as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 -o Dpkg::Use-Pty=0)
"${apt[@]}" update -q
"${apt[@]}" install -q -y --no-install-recommends "${missing[@]}"
