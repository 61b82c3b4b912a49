#!/bin/sh
# Fuzzing with cargo-fuzz (cargo install cargo-fuzz) and a nightly toolchain (NIGHTLY names it; default: nightly).
#
#     tools/fuzz.sh TARGET [SECONDS]     fuzzes, then merges what reached anything new into out/fuzz/TARGET/smallest
#
# Targets: graph, scene; film, report, measured (these build wgpu too). SANITIZER=address looks for errors of memory as well, at half the speed.
# A crash ends the run, its input is in out/fuzz/TARGET/artifacts. Small files of general interest are kept in fuzz/corpus, which tests read
# without a fuzzer.
set -eu
cd "$(dirname "$0")/.."
target=${1:?usage: tools/fuzz.sh TARGET [SECONDS]}
seconds=${2:-600}
found=out/fuzz/$target
mkdir -p "$found/corpus" "$found/artifacts"
features=
case $target in
graph) cp framework/graph/tests/cases/*.toml "$found/corpus/" ;;
scene) ;;
film | report | measured) features=--features=lab ;;
*)
    echo "fuzz: no target \`$target\`; there are: graph, scene, film, report, measured" >&2
    exit 2
    ;;
esac
[ ! -d "fuzz/corpus/$target" ] || cp "fuzz/corpus/$target/"* "$found/corpus/"
fuzz() {
    cargo "+${NIGHTLY:-nightly}" fuzz run --fuzz-dir fuzz --sanitizer "${SANITIZER:-none}" ${features:+"$features"} "$target" "$@" \
        -timeout=10 -rss_limit_mb=2048 -max_len=16384
}
fuzz "$found/corpus" -- -max_total_time="$seconds" -artifact_prefix="$found/artifacts/" -print_final_stats=1
rm -rf "$found/smallest"
mkdir "$found/smallest"
fuzz "$found/smallest" "$found/corpus" -- -merge=1
echo "$(find "$found/smallest" -type f | wc -l) files in $found/smallest"
