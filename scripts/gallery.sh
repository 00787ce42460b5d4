#!/usr/bin/env bash
# Makes the pictures of docs/gallery.md again: simulates each scene up to the frame that is shown there, and shrinks its picture.
#   gallery.sh [--threads N] [SCENE ...]      all scenes unless some are named
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# Scene, frame, width of the picture in pixels, and the shares of it to cut away: left, top, right, bottom.
gallery=(
  "noodles 80 600 0 0 0 0"
  "candy 16 760 0 0 0 0"
  "flow_trio 30 900 0 .2 0 0"
  "falling_monsters 30 860 0 0 0 0"
  "snow_dive 30 700 0 0 0 0"
  "colliding_blocks 15 800 0 0 0 0"
  "notched_block 20 760 0 0 0 0"
  "friction_row 90 900 0 0 0 0"
)

threads=0
if [[ ${1:-} == --threads ]]; then
  threads=${2:?--threads needs a number}
  shift 2
fi

[[ -x build/release/samples/loam-run ]] || die "build it first: cmake --preset release && cmake --build --preset release --target loam-run"
for entry in "${gallery[@]}"; do
  read -r scene frame width left top right bottom <<<"$entry"
  if [[ $# -gt 0 && " $* " != *" $scene "* ]]; then continue; fi
  say "$scene, frame $frame"
  output=out/gallery/$scene
  mkdir -p "$output"
  build/release/samples/loam-run "samples/scenes/$scene/scene.toml" --out "$output" --threads "$threads" \
    --frames "$frame" --picture-every "$frame" --ply-every 0
  python3 scripts/shrink_png.py "$output/$(printf 'frame_%04d.png' "$frame")" "docs/images/$scene.png" "$width" "$left" "$top" "$right" "$bottom"
done
