#!/usr/bin/env bash
# Makes the pictures of docs/gallery.md again: simulates each scene up to the frame that is shown there, and shrinks its picture.
#   gallery.sh [--threads N] [SCENE ...]      all scenes unless some are named
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# Scene, frame, width of the picture in pixels, and the shares of it to cut away: left, top, right, bottom.
gallery=(
  "noodles 80 560 .1 .05 .1 0"
  "candy 15 700 0 0 0 0"
  "flow_trio 30 860 0 .25 0 .05"
  "falling_monsters 20 720 .15 .28 .08 .12"
  "snow_dive 30 600 .08 .2 .12 .05"
  "colliding_blocks 15 660 .1 0 .05 .08"
  "notched_block 20 620 .15 .25 .15 .12"
  "friction_row 60 900 0 .15 0 .1"
  "wrist 80 640 .1 .1 .1 .05"
  "pouring_sauce 75 560 .05 .05 .05 0"
  "water_wheel 100 600 0 0 .15 0"
  "poured_cup 200 640 .25 .1 .05 .1"
  "torn_hammock 120 600 .05 .12 .1 .2"
  "paint_on_cloth 120 600 .1 0 .1 0"
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
