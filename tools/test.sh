#!/bin/sh
# Sets up what is missing and runs every test. Further arguments go to the test runner.
#
# Tests that need a graphics adapter are skipped, and say so, where none is found. With AQUIFER_REQUIRE_ADAPTER=1 they fail instead.
# The same goes for the test that needs a browser, and AQUIFER_REQUIRE_BROWSER=1.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
. tools/setup_browser.sh

started=$(date +%s)
status=0
if cargo nextest --version >/dev/null 2>&1; then
    cargo nextest run --workspace "$@" || status=$?
    # nextest does not run the examples in documentation.
    [ "$status" -ne 0 ] || cargo test --quiet --workspace --doc || status=$?
else
    cargo test --workspace "$@" || status=$?
fi

seconds=$(($(date +%s) - started))
if [ "$status" -eq 0 ]; then
    echo "test: all tests passed in $seconds s"
else
    echo "test: FAILED after $seconds s" >&2
fi
exit "$status"
