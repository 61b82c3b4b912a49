#!/bin/sh
# Renders the pictures of README and docs/restir_gi.md that show graphs: docs/images/{restir_di,restir_gi,jacobian,shadow_edges}.jpg.
#
#     tools/figures.sh [FRAMES]
#
# FRAMES are those of the last two; 256 take some minutes on two cores. What lies in out/figures already is not rendered again. Pictures are put
# side by side by ImageMagick's `convert`.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
many=${1:-256}
command -v convert >/dev/null || {
    echo "figures: needs ImageMagick's convert (apt install imagemagick)" >&2
    exit 1
}
cargo build --quiet -p aquifer
out=out/figures
mkdir -p "$out" docs/images

# render NAME GRAPH SCENE TRANSPORT SIZE FRAMES [SETTING …]: their mean, as NAME.exr and NAME.png; of frames A..B the last by itself, as NAME.png.
render() {
    name=$1 graph=$2 scene=$3 transport=$4 size=$5 frames=$6
    shift 6
    settings=
    for setting in "$@"; do settings="$settings --set $setting"; done
    [ ! -e "$out/$name.png" ] || return 0
    case $frames in
    *..*) files="-o $out/$name-####.png" ;;
    *) files="-o $out/$name.exr -o $out/$name.png" ;;
    esac
    # shellcheck disable=SC2086 # settings and files are words
    "${CARGO_TARGET_DIR:-target}/debug/aquifer" render "$graph" --scene "$scene" --transport "$transport" --size "$size" --frames "$frames" $settings $files
    case $frames in
    *..*) mv "$(find "$out" -name "$name-*.png" | sort | tail -1)" "$out/$name.png" && rm -f "$out/$name"-*.png ;;
    esac
}

# beside PERCENT PICTURE …: side by side, so much enlarged, as one row.
beside() {
    percent=$1
    shift
    convert "$@" -filter point -resize "$percent%" -bordercolor white -border 2 +append miff:-
}

# README: direct light of many lights, mean of twelve frames.
for graph in light_sampling restir_di restir_di_unbiased; do
    render "many_$graph" "$graph" many_lights direct 384x216 12
done
beside 100 "$out/many_light_sampling.png" "$out/many_restir_di.png" "$out/many_restir_di_unbiased.png" |
    convert miff:- -quality 88 docs/images/restir_di.jpg

# The 33rd frame of ReSTIR GI, between path tracing of three samples a pixel, about its time, and of many.
for scene in cornell sunlit_wall; do
    render "${scene}_three" path_tracer_indirect "$scene" indirect:2 160x90 0..1 path_tracer.samples=3
    render "${scene}_frame" restir_gi_unbiased "$scene" indirect:2 160x90 0..33
    render "${scene}_truth" path_tracer_indirect "$scene" indirect:2 160x90 "$many" path_tracer.samples=8
    beside 200 "$out/${scene}_three.png" "$out/${scene}_frame.png" "$out/${scene}_truth.png" >"$out/$scene.miff"
done
convert "$out/cornell.miff" "$out/sunlit_wall.miff" -append -quality 90 docs/images/restir_gi.jpg

# Ouyang et al. 2021, figure 7: the Jacobian of reconnection.
render wall_on restir_gi_unbiased sunlit_wall indirect:2 160x90 "$many"
render wall_off restir_gi_unbiased sunlit_wall indirect:2 160x90 "$many" spatial.jacobian=off temporal.jacobian=off
render wall_inverted restir_gi_unbiased sunlit_wall indirect:2 160x90 "$many" spatial.jacobian=inverted temporal.jacobian=inverted

# Figure 9: bias at shadow edges.
render box_unbiased restir_gi_unbiased cornell indirect:2 160x90 "$many"
render box_tuned restir_gi_tuned cornell indirect:2 160x90 "$many"
render box_biased restir_gi cornell indirect:2 160x90 "$many"

# Relative differences of luminance from path tracing, means of 4×4 pixels: blue too dark, red too bright.
for name in wall_on wall_off wall_inverted box_unbiased box_tuned box_biased; do
    case $name in
    wall_*) truth=sunlit_wall_truth ;;
    box_*) truth=cornell_truth ;;
    esac
    "${CARGO_TARGET_DIR:-target}/debug/aquifer" diff "$out/$name.exr" "$out/$truth.exr" --heat "$out/$name-difference.png" --heat-of difference >"$out/$name.txt"
    convert "$out/$name-difference.png" -filter box -resize 25% -filter point -resize 400% "$out/$name-bias.png"
done
beside 180 "$out/sunlit_wall_truth.png" "$out/wall_on-bias.png" "$out/wall_off-bias.png" "$out/wall_inverted-bias.png" |
    convert miff:- -quality 90 docs/images/jacobian.jpg
beside 180 "$out/cornell_truth.png" "$out/box_unbiased-bias.png" "$out/box_tuned-bias.png" "$out/box_biased-bias.png" |
    convert miff:- -quality 90 docs/images/shadow_edges.jpg
grep -H "pixels, mean" "$out"/*.txt
