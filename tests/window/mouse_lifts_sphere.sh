#!/usr/bin/env bash
# A newcomer's first minute, in a real window: under Xvfb, with synthetic mouse input, pinches the sphere of the pick-up scene and lifts it.
#   $1 the program, $2 a folder to work in
set -euo pipefail
pincer=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp -noreset 3> "$work/display" 2> "$work/xvfb.log" &
xvfb=$!
trap 'kill $xvfb 2> /dev/null || true' EXIT
until [[ -s $work/display ]]; do sleep 0.1; done
DISPLAY=:$(< "$work/display")
export DISPLAY
until xdotool getdisplaygeometry > /dev/null 2>&1; do sleep 0.1; done
# waitForWindow PROCESS OUTPUT   fails with the output if the process ends without one.
waitForWindow() {
  until xdotool search --name '^pincer' > /dev/null 2>&1; do
    kill -0 "$1" || { cat "$2"; exit 1; }
    sleep 0.2
  done
}
"$pincer" sim pickup --view --devices mouse --screenshot "$work/end.png" > "$work/out" 2>&1 &
viewer=$!
waitForWindow $viewer "$work/out"
sleep 1
xdotool mousemove 640 560
sleep 1
xdotool mousedown 1
sleep 4 # the fingers close at 0.1 m/s; a busy machine skips ticks
for _ in {1..40}; do
  xdotool mousemove_relative -- 0 -7
  sleep 0.05
done
sleep 2
xdotool key Escape
wait $viewer
cat "$work/out"
lifted=$(sed -nE 's/^Lifted by up to ([0-9]+)\..*/\1/p' "$work/out")
((lifted >= 20)) || { echo "the sphere wasn't lifted"; exit 1; }
# A session with the mouse, left with Esc in its first trial, is done again to the bit from what the hand did.
"$pincer" run sphere-pickup --devices mouse --view --friction 0.9 --condition cld+force --out "$work/session" > "$work/session.out" 2>&1 &
session=$!
waitForWindow $session "$work/session.out"
sleep 3
xdotool mousemove 640 400 mousedown 1
sleep 3
for _ in {1..20}; do
  xdotool mousemove_relative -- 1 -7
  sleep 0.05
done
xdotool key Escape
code=0
wait $session || code=$?
((code == 5)) || { cat "$work/session.out"; exit 1; }
"$pincer" replay "$work/session/session.db" | tee "$work/replay"
grep -qE 'The same to the bit: 0 trials and 1 that was cut short, [0-9]{3,} samples, [0-9]{4,} ticks of a person' "$work/replay"
# And where there is no display the program says so, with the exit code of a missing device.
unset DISPLAY
code=0
env -u WAYLAND_DISPLAY "$pincer" sim pickup --view > "$work/no_display" 2>&1 || code=$?
((code == 4)) && grep -q -- '--screenshot' "$work/no_display"
