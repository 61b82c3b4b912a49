#!/bin/sh
# The evidence tier: comparisons too long for the tests. Resumable; results go to docs/evidence/*.json with commit, adapter and date.
#
#     tools/evidence.sh external [--size 64x36|256x144] [--minutes N] [SCENE:TRANSPORT …]
#     tools/evidence.sh held_out [SCENE …]
#     tools/evidence.sh compare_aa
#     tools/evidence.sh restir_di [MINUTES] [+SEEDS] [SCENE[:RULE] …]
#     tools/evidence.sh restir_gi [MINUTES] [+SEEDS] [SCENE[:RULE] …]
#     tools/evidence.sh equal_time di|gi [WxH] [SCENE …]
#     tools/evidence.sh restir_di_cost
#     tools/evidence.sh restir_gi_cost
#     tools/evidence.sh indirect_figures
#     tools/evidence.sh light_change
#     tools/evidence.sh moving_bias
#     tools/evidence.sh error_parts|gi_choices [SCENE …]
#     tools/evidence.sh stress [CASE[:GRAPH]|:GRAPH …]
#     tools/evidence.sh long [GRAPH …]
#     tools/evidence.sh leaving_out [MINUTES] [GRAPH@SCENE …]
#     tools/evidence.sh viewer [MINUTES]
#
# external: the path tracer against Mitsuba 3 (tests/external), until each case is resolved; held_out: the same for small unusual glTF files.
# PYTHON names an interpreter that has tests/external/requirements.txt. The program must be built from a commit, without changes.
# compare_aa: twenty comparisons of graphs with themselves, some minutes; at 5 % one in twenty gives a verdict by chance.
# Counted: a case wants some 700 to 40,000 samples a pixel, of 3 to 11 rays: at 64x36 and 10⁶ rays/s, seconds to ten minutes; at 256x144, 16 times.
# restir_di, restir_gi: unbiased reuse against the path tracer, still and moving, by every unbiased rule, until each row is resolved or the time is
# over; +SEEDS asks for at least so many, also of rows that passed with fewer. A row wants some 10⁸ to 10⁹ rays. References and seeds so far are kept
# beside the tables, with a hash of the shaders, so that another machine goes on where one stopped, and no seeds of other code count as theirs. Rows that
# are settled stay, of whichever commit: who changes what their graphs do deletes them.
# equal_time: a frame of resampling against path tracing in the same time, with the machine to itself; pages are in out/evidence/equal_time.
# restir_di_cost, restir_gi_cost: time, rays and bytes of every pass, over light counts and over bounces, with the machine to itself.
# indirect_figures: two figures of the paper of ReSTIR GI as numbers: where initial directions come from, what the second bounce brings.
# light_change: error of ReSTIR GI by frame after the sun goes out but for a tenth. moving_bias: bias by frame where all moves. error_parts: what the error of ReSTIR GI is made of, and for how many rays.
# gi_choices: the same error without each of our choices in restir_gi_unbiased.
# stress: every graph on every case of `aquifer stress`, some ten minutes a case; long: 10,000 frames of three graphs, of which lavapipe keeps some GB.
# leaving_out: every graph on every scene with and without what the scene does not need, and what that saves (with the machine to itself); some ten
# seconds a pair, most of it the driver's compiler.
# viewer: first pictures and pictures a second (with the machine to itself); memory over so many minutes of switching graphs, and a fifth as many without.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
item=${1:-external}
[ $# -eq 0 ] || shift
case $item in
external)
    cargo build --quiet -p aquifer
    "${PYTHON:-python3}" tests/external/evidence.py "${CARGO_TARGET_DIR:-target}/debug/aquifer" out/evidence "$@"
    ;;
held_out)
    cargo build --quiet -p aquifer
    "${PYTHON:-python3}" tests/external/held_out.py "${CARGO_TARGET_DIR:-target}/debug/aquifer" out/evidence/held_out "$@"
    ;;
compare_aa)
    cargo build --quiet -p aquifer
    tools/evidence/compare_aa.sh "${CARGO_TARGET_DIR:-target}/debug/aquifer" docs/evidence/compare_aa.json "$(git rev-parse HEAD)" "$(date -u +%F)"
    ;;
viewer)
    for what in pace "memory ${1:-30}"; do
        # shellcheck disable=SC2086 # memory and its minutes are two words
        cargo run --quiet -p aquifer-viewer --example viewer_evidence -- docs/evidence/viewer.json "$(git rev-parse HEAD)" "$(date -u +%F)" $what
    done
    ;;
restir_di | restir_gi)
    minutes=${1:-600}
    [ $# -eq 0 ] || shift
    cargo run --quiet -p aquifer-tests --example unbiased_reuse -- "${item#restir_}" "docs/evidence/$item.json" "docs/evidence/$item" \
        "$(git rev-parse HEAD)" "$(date -u +%F)" "$minutes" "$@"
    ;;
equal_time)
    kind=${1:?usage: tools/evidence.sh equal_time di|gi [WxH] [SCENE …]}
    size=${2:-$([ "$kind" = di ] && echo 256x144 || echo 64x36)}
    shift $(($# < 2 ? $# : 2))
    cargo build --quiet -p aquifer
    cargo run --quiet -p aquifer-tests --example equal_time -- "${CARGO_TARGET_DIR:-target}/debug/aquifer" docs/evidence/equal_time.json \
        out/evidence/equal_time "$(git rev-parse HEAD)" "$(date -u +%F)" "$kind" "$size" "$@"
    ;;
restir_di_cost | restir_gi_cost)
    subject=${item#restir_}
    cargo run --quiet -p aquifer-tests --example restir_cost -- "${subject%_cost}" "docs/evidence/$item.json" "$(git rev-parse HEAD)" "$(date -u +%F)"
    ;;
indirect_figures | light_change | moving_bias | error_parts | gi_choices)
    cargo run --quiet -p aquifer-tests --example "$item" -- "docs/evidence/$item.json" "$(git rev-parse HEAD)" "$(date -u +%F)" "$@"
    ;;
leaving_out)
    cargo run --quiet -p aquifer-tests --example leaving_out -- costs docs/evidence/leaving_out_cost.json "$(git rev-parse HEAD)" "$(date -u +%F)" 10
    minutes=${1:-120}
    [ $# -eq 0 ] || shift
    cargo run --quiet -p aquifer-tests --example leaving_out -- pairs docs/evidence/leaving_out.json "$(git rev-parse HEAD)" "$(date -u +%F)" "$minutes" "$@"
    ;;
stress | long)
    cargo build --quiet -p aquifer
    cargo run --quiet -p aquifer-tests --example stress_evidence -- "$item" "${CARGO_TARGET_DIR:-target}/debug/aquifer" "docs/evidence/$item.json" \
        "$(git rev-parse HEAD)" "$(date -u +%F)" "$@"
    ;;
*)
    echo "evidence: no item \`$item\`; there are: external, held_out, compare_aa, restir_di, restir_gi, equal_time, restir_di_cost, restir_gi_cost," \
        "indirect_figures, light_change, moving_bias, error_parts, gi_choices, leaving_out, stress, long, viewer" >&2
    exit 2
    ;;
esac
