#!/bin/sh
# Sets up what is missing, builds, renders a built-in scene, and says where the picture and the numbers are.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh

cargo build --quiet -p aquifer
mkdir -p out
target/debug/aquifer render path_tracer --scene cornell --size 256x144 --frames 64 --time 90 \
    -o out/cornell.exr -o out/cornell.png --json >out/cornell.json

cat <<'END'

The picture:  out/cornell.png
As radiance:  out/cornell.exr   (mean, variance of the mean, and what made it)
The numbers:  out/cornell.json  (samples, seconds, adapter, time of each pass)
END
