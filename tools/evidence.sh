#!/bin/sh
# The evidence tier: comparisons too long for the tests. Resumable; results go to docs/evidence/*.json with commit, adapter and date.
#
#     tools/evidence.sh external [--size 64x36|256x144] [--samples N] [SCENE:TRANSPORT …]
#
# external: the path tracer against Mitsuba 3 (tests/external). PYTHON names an interpreter that has tests/external/requirements.txt.
# Counted: 8,192 samples at 256x144 are 3·10⁸ paths, of full:4 one to three 10⁹ rays: half an hour to an hour on two cores.
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
*)
    echo "evidence: no item \`$item\`; there is: external" >&2
    exit 2
    ;;
esac
