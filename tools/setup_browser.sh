#!/bin/sh
# Makes sure that there is a browser for the test of the report; sourced by tools/test.sh after tools/setup.sh. Installs Debian's Chromium
# where apt can. Without one the test is skipped, and says so; with AQUIFER_REQUIRE_BROWSER=1 it fails.

if ! aquifer_has chromium && ! aquifer_has chromium-browser && ! aquifer_has google-chrome && ! aquifer_has chrome && aquifer_has apt-get; then
    echo "setup: no Chromium found; installing it for the test of the report" >&2
    aquifer_apt_install chromium || echo "setup: the report will not be tested in a browser" >&2
fi
