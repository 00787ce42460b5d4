#!/usr/bin/env bash
# Fills .carry/ (ignored by git) with the libraries that Loam builds against, taken from this machine's Debian packages, for a machine where
# nothing can be installed. scripts/gpu-check.sh looks there. Embree is left out for its size: on such a machine the runner makes no pictures.
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(libtbb-dev libtbb12 libtbbmalloc2 libhwy-dev libhwy1 nlohmann-json3-dev libtomlplusplus-dev libtomlplusplus3
  libstb-dev libstb0 libfmt-dev libfmt9 libcli11-dev libtinyobjloader-dev libtinyobjloader2rc10
  libeigen3-dev libgtest-dev libgmock-dev libbenchmark-dev libbenchmark1debian)
limit_mib=40

rm -rf .carry
mkdir -p .carry
for package in "${packages[@]}"; do
  dpkg-query --listfiles "$package" >/dev/null 2>&1 || die "$package is not installed: scripts/install_dependencies.sh tests"
  dpkg-query --listfiles "$package" | grep -E '^/usr/(include|lib|share/(cmake|eigen3|pkgconfig))/' |
    grep -vE '/(unsupported|docs?|examples)/' |
    while IFS= read -r path; do
      if [[ -L $path || -f $path ]]; then
        mkdir -p ".carry${path%/*}"
        cp -a "$path" ".carry$path"
      fi
    done
done

size=$(du -sm .carry | cut -f1)
[[ $size -le $limit_mib ]] || die ".carry has grown to $size MiB; the limit is $limit_mib"
echo ".carry: $size MiB from ${#packages[@]} packages"
