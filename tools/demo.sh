#!/bin/sh
# Sets up what is missing, builds, compares two graphs at equal time, and says where the report is.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh

cargo build --quiet -p aquifer
"${CARGO_TARGET_DIR:-target}/debug/aquifer" compare light_sampling restir_di_unbiased --scene many_lights --size 96x54 --warm-up 16 --seeds 8 \
    --reference-samples 2048 --cache out/cache -o out/demo

cat <<'END'

The report:   out/demo/report.html   (opens from disk: verdict, plots, images)
The numbers:  out/demo/report.json and results.csv
The films:    out/demo/images        (EXR: radiance; the means hold their variance)
END
