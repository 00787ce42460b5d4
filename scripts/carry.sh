#!/usr/bin/env bash
# Packs the libraries that Loam builds against, from this machine's Debian packages, into .carry/ (ignored by git), for a machine with a GPU
# where nothing can be installed. scripts/gpu-check.sh unpacks it there.
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 libhwy-dev libhwy1 nlohmann-json3-dev libtomlplusplus-dev libtomlplusplus3
  libstb-dev libstb0 libfmt-dev libfmt9 libcli11-dev libembree-dev libembree3-3
  libeigen3-dev libgtest-dev libgmock-dev libbenchmark-dev libbenchmark1debian)
limit_mib=40

for package in "${packages[@]}"; do
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
    die "$package is not installed: scripts/install_dependencies.sh tests"
done
rm -rf .carry
mkdir -p .carry
dpkg-query --listfiles "${packages[@]}" | grep -E '^/usr/(include|lib|share/(cmake|eigen3|pkgconfig))/' | sort -u |
  while IFS= read -r path; do
    if [[ -L $path || -f $path ]]; then printf '%s\n' "${path#/}"; fi
  done | tar --create --gzip --file .carry/libraries.tar.gz --directory / --no-recursion --files-from -

size=$(du -sm .carry | cut -f1)
[[ $size -le $limit_mib ]] || die ".carry has grown to $size MiB; the limit is $limit_mib"
echo ".carry: $size MiB from ${#packages[@]} packages"
