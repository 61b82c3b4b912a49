#!/bin/sh
# Renders figures of docs/restir_gi.md into docs/images: jacobian.jpg, shadow_edges.jpg.
#
#     tools/figures.sh [FRAMES]
#
# Some minutes on two cores. Pictures are put side by side by ImageMagick's `convert`.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
frames=${1:-256}
command -v convert >/dev/null || {
    echo "figures: needs ImageMagick's convert (apt install imagemagick)" >&2
    exit 1
}
cargo build --quiet -p aquifer
out=out/figures
mkdir -p "$out" docs/images

# render NAME GRAPH SCENE [SETTING …]: the mean over the frames, as NAME.exr and NAME.png.
render() {
    name=$1 graph=$2 scene=$3
    shift 3
    settings=
    for setting in "$@"; do settings="$settings --set $setting"; done
    [ ! -e "$out/$name.exr" ] || return 0
    # shellcheck disable=SC2086 # settings are words
    target/debug/aquifer render "$graph" --scene "$scene" --transport indirect:2 --size 192x108 --frames "$frames" $settings \
        -o "$out/$name.png" -o "$out/$name.exr"
}

# beside NAME PICTURE …: twice as large, side by side.
beside() {
    name=$1
    shift
    convert "$@" -filter point -resize 200% -bordercolor white -border 2 +append -quality 90 "docs/images/$name.jpg"
}

# Ouyang et al. 2021, figure 7: the Jacobian of reconnection.
render wall_truth path_tracer_indirect sunlit_wall path_tracer.samples=8
render wall_on restir_gi_unbiased sunlit_wall
render wall_off restir_gi_unbiased sunlit_wall spatial.jacobian=off temporal.jacobian=off
render wall_inverted restir_gi_unbiased sunlit_wall spatial.jacobian=inverted temporal.jacobian=inverted
beside jacobian "$out/wall_truth.png" "$out/wall_on.png" "$out/wall_off.png" "$out/wall_inverted.png"

# Figure 9: bias at shadow edges, as the relative difference of luminance from path tracing: blue too dark, red too bright.
render box_truth path_tracer_indirect cornell path_tracer.samples=8
render box_unbiased restir_gi_unbiased cornell
render box_untested restir_gi_unbiased cornell slots.visibility=untested
for name in box_unbiased box_untested; do
    target/debug/aquifer diff "$out/$name.exr" "$out/box_truth.exr" --heat "$out/$name-difference.png" --heat-of difference >"$out/$name.txt"
done
beside shadow_edges "$out/box_truth.png" "$out/box_unbiased-difference.png" "$out/box_untested-difference.png"
for name in wall_on wall_off wall_inverted; do
    target/debug/aquifer diff "$out/$name.exr" "$out/wall_truth.exr" >"$out/$name.txt"
done
grep -H -i mean "$out"/*.txt
