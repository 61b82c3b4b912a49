#!/bin/sh
# The evidence tier: comparisons too long for the tests. Resumable; results go to docs/evidence/*.json with commit, adapter and date.
#
#     tools/evidence.sh external [--size 64x36|256x144] [--minutes N] [SCENE:TRANSPORT …]
#     tools/evidence.sh held_out [SCENE …]
#     tools/evidence.sh restir_di [MINUTES] [SCENE …]
#     tools/evidence.sh restir_di_cost
#     tools/evidence.sh restir_gi [MINUTES] [SCENE …]
#
# external: the path tracer against Mitsuba 3 (tests/external), until each case is resolved; held_out: the same for small unusual glTF files.
# PYTHON names an interpreter that has tests/external/requirements.txt. The program must be built from a commit, without changes.
# Counted: a case wants some 700 to 40,000 samples a pixel, of 3 to 11 rays: at 64x36 and 10⁶ rays/s, seconds to ten minutes; at 256x144, 16 times.
# restir_di, restir_gi: unbiased reuse against the path tracer, still and moving, by every unbiased rule, until each row is resolved or the time is
# over. A row wants some 10⁹ rays.
# restir_di_cost: passes of ReSTIR DI over light counts, with the machine to itself.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
item=${1:-external}
[ $# -eq 0 ] || shift
case $item in
external)
    cargo build --quiet -p aquifer
    "${PYTHON:-python3}" tests/external/evidence.py target/debug/aquifer out/evidence "$@"
    ;;
held_out)
    cargo build --quiet -p aquifer
    "${PYTHON:-python3}" tests/external/held_out.py target/debug/aquifer out/evidence/held_out "$@"
    ;;
restir_di | restir_gi)
    minutes=${1:-600}
    [ $# -eq 0 ] || shift
    cargo run --quiet -p aquifer-tests --example unbiased_reuse -- "${item#restir_}" "docs/evidence/$item.json" "out/evidence/$item" \
        "$(git rev-parse HEAD)" "$(date -u +%F)" "$minutes" "$@"
    ;;
restir_di_cost)
    cargo run --quiet -p aquifer-tests --example restir_di_cost -- docs/evidence/restir_di_cost.json "$(git rev-parse HEAD)" "$(date +%F)"
    ;;
*)
    echo "evidence: no item \`$item\`; there are: external, held_out, restir_di, restir_di_cost, restir_gi" >&2
    exit 2
    ;;
esac
