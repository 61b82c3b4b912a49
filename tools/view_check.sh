#!/bin/sh
# The viewer in a real window, without anyone before it: opens it under Xvfb, works it with keys and mouse, keeps screenshots.
#
#     tools/view_check.sh [FOLDER]        default: out/view_check
#
# Fails where the window does not open, a picture does not come in time, or a key changes nothing on the screen.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
folder=${1:-out/view_check}
mkdir -p "$folder"
for program in Xvfb xdotool import compare; do
    aquifer_has "$program" || aquifer_apt_install xvfb xdotool imagemagick || aquifer_setup_fail "needed: xvfb, xdotool, imagemagick"
done
cargo build --quiet -p aquifer --features viewer

display=:$((90 + $$ % 100))
Xvfb "$display" -screen 0 1280x800x24 -nolisten tcp >/dev/null 2>&1 &
server=$!
viewer=
trap 'kill $viewer $server 2>/dev/null || true' EXIT INT TERM
sleep 2

# Without a display, the message names what works without one.
if env -u DISPLAY -u WAYLAND_DISPLAY "${CARGO_TARGET_DIR:-target}/debug/aquifer" view 2>"$folder/no_display.txt"; then
    echo "view_check: no display, and no failure" >&2
    exit 1
fi
grep -q 'aquifer compare' "$folder/no_display.txt"

export DISPLAY="$display"
"${CARGO_TARGET_DIR:-target}/debug/aquifer" -v view path_tracer restir_di --scene cornell --transport direct >"$folder/log.txt" 2>&1 &
viewer=$!

# Waits for a line of the log: seconds, words.
wait_for() {
    left=$(($1 * 10))
    while ! grep -q "$2" "$folder/log.txt"; do
        kill -0 "$viewer" 2>/dev/null || { cat "$folder/log.txt" >&2; exit 1; }
        left=$((left - 1))
        [ "$left" -gt 0 ] || { echo "view_check: not in $1 s: $2" >&2; cat "$folder/log.txt" >&2; exit 1; }
        sleep 0.1
    done
}
shot() {
    import -window root "$folder/$1.png"
}
# A picture must differ from another in so many pixels.
differ() {
    pixels=$(compare -metric AE -fuzz 5% "$folder/$1.png" "$folder/$2.png" null: 2>&1 || true)
    [ "${pixels%%[!0-9]*}" -ge "$3" ] || { echo "view_check: $1 and $2 differ in $pixels pixels" >&2; exit 1; }
}

wait_for 60 'first picture of A'
wait_for 60 'first picture of B'
grep 'first picture' "$folder/log.txt"
window=$(xdotool search --sync --onlyvisible --name '^Aquifer$' | head -1)
xdotool windowsize --sync "$window" 1280 800 windowmove "$window" 0 0 windowfocus "$window" || true
sleep 12
shot split
xdotool mousemove 460 400 key h
sleep 1
xdotool key 3
sleep 1
shot a
xdotool key space
sleep 1
shot b
differ a b 20000
xdotool key h
# Slowly: press, move and release within one picture of the window are a click.
xdotool mousedown 1 sleep 0.5 mousemove_relative --sync 60 15 sleep 0.5 mousemove_relative --sync 60 15 sleep 0.5 mouseup 1
sleep 6
shot orbited
differ b orbited 20000
xdotool key Home key 1
xdotool key i mousemove 300 500 click 1
sleep 10
shot inspector
xdotool key 2
sleep 5
shot beside
kill "$viewer"
wait "$viewer" 2>/dev/null || true
echo "view_check: screenshots in $folder"
