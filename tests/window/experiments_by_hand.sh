#!/usr/bin/env bash
# One of the experiments in a window, done by a scripted mouse and keyboard under Xvfb: begun, some trials done, left, gone on with, finished; and
# all that was done comes again to the bit.
#   $1 the program, $2 a folder to work in, $3 the experiment, $4 (optional) a folder for pictures of the screen
set -euo pipefail
pincer=$1
work=$2
task=$3
pictures=${4:-}
rm -rf "$work"
mkdir -p "$work"
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp -noreset 3> "$work/display" 2> "$work/xvfb.log" &
xvfb=$!
trap 'kill $xvfb 2> /dev/null || true' EXIT
until [[ -s $work/display ]]; do sleep 0.1; done
DISPLAY=:$(< "$work/display")
export DISPLAY
until xdotool getdisplaygeometry > /dev/null 2>&1; do sleep 0.1; done

# Two trials of one condition, after one of training.
two_trials='"staircase": {"reversals": 2, "averaged": 1, "most_trials": 2}'
case $task in
  smoothness-discrimination) study='{"participants": 1, "conditions": [{"name": "C4", '$two_trials'}]}' ;;
  backlash-discrimination) study='{"participants": 1, "conditions": [{"name": "low-curvature", '$two_trials'}]}' ;;
  delay-discrimination) study='{"participants": 1, "conditions": [{"name": "whole", '$two_trials'}]}' ;;
  repeated-localisation) study='{"participants": 1, "places": 2, "repetitions": 1}' ;;
  shape-identification) study='{"participants": 1, "runs": 1, "conditions": [{"name": "shaded"}]}' ;;
esac
options=(--devices mouse --view)
if [[ -n ${study:-} ]]; then
  echo "$study" > "$work/study.json"
  begin=("$pincer" run "$task" --study "$work/study.json" "${options[@]}" --out "$work/session")
elif [[ $task == sphere-pickup ]]; then
  begin=("$pincer" run "$task" --friction 0.9 --repetitions 1 --condition cld+force "${options[@]}" --out "$work/session")
else
  begin=("$pincer" run "$task" --repetitions 2 --condition cld+force "${options[@]}" --out "$work/session")
fi

shot=0
picture() { [[ -z $pictures ]] || ffmpeg -loglevel error -y -f x11grab -video_size 1280x720 -i "$DISPLAY" -frames:v 1 "$pictures/$task-$((++shot))-$1.png"; }
# slide STEPS DX DY   of the mouse, a step every 20 ms
slide() {
  for ((i = 0; i < $1; ++i)); do
    xdotool mousemove_relative -- "$2" "$3"
    sleep 0.02
  done
}
# What one trial takes; too much of it does no harm: keys that mean nothing at the moment are ignored.
arc_trial() {
  for _ in 1 2; do
    sleep 0.7
    slide 20 0 3
    slide 25 8 -1
    picture stroke
    slide 25 -8 1
    slide 30 0 -4
    xdotool key Return
    slide 10 0 2
    sleep 0.3
  done
  picture answer
  xdotool key 1 key Return
  sleep 0.3
}
# Along the finger, Enter every 0.2 mm of the tactor, until the ring is met.
place_trial() {
  sleep 0.7
  slide 25 0 3
  slide 30 -8 0
  picture search
  for _ in {1..110}; do
    xdotool mousemove_relative -- 4 0
    xdotool key Return
  done
  slide 30 0 -4
  sleep 0.7
  slide 30 0 4
  xdotool key Return
  sleep 0.5
  slide 25 0 -3
}
shape_trial() {
  sleep 1
  slide 40 -6 0
  picture touch
  xdotool key 4
  sleep 0.7
}
pickup_trial() {
  sleep 2.5
  slide 30 0 6
  xdotool mousedown 1
  sleep 3
  picture pinch
  slide 40 0 -7
  sleep 2
  picture lifted
  xdotool mouseup 1
  sleep 1
}
alignment_trial() {
  sleep 2.5
  picture start
  xdotool key Return
  sleep 1
}
case $task in
  smoothness-discrimination | backlash-discrimination | delay-discrimination) trial=arc_trial ;;
  repeated-localisation) trial=place_trial ;;
  shape-identification) trial=shape_trial ;;
  sphere-pickup) trial=pickup_trial ;;
  *) trial=alignment_trial ;;
esac

# started COMMAND...   in the background, until its window is there
started() {
  "$@" > "$work/out" 2>&1 &
  process=$!
  until xdotool search --name '^pincer' > /dev/null 2>&1; do
    kill -0 $process 2> /dev/null || { cat "$work/out"; exit 1; }
    sleep 0.2
  done
  sleep 1.5
  xdotool mousemove 640 300
}
responses() { sqlite_rows=$("$pincer" export "$work/session/session.db" --out "$work/csv" > /dev/null && cat "$work"/csv/{response,trial}.csv | wc -l); echo $((sqlite_rows - 2)); }

started "${begin[@]}"
picture page
xdotool key Return
$trial
[[ -n ${study:-} ]] && { picture feedback; xdotool key Return; sleep 1; xdotool key Return; $trial; }
# Left in the next trial, as by a crash.
sleep 1
kill -9 $process
wait $process 2> /dev/null || true
done_before=$(responses)

resume=("$pincer" run "$task" --resume "${options[@]}" --out "$work/session")
started "${resume[@]}"
for _ in {1..25}; do
  kill -0 $process 2> /dev/null || break
  xdotool key Return 2> /dev/null || true
  $trial 2> /dev/null || true
done
kill -0 $process 2> /dev/null && { cat "$work/out"; echo "the session never ended"; exit 1; }
wait $process || { cat "$work/out"; exit 1; }
done_after=$(responses)
((done_after > done_before && done_after >= 1)) || { cat "$work/out"; echo "$done_before rows before, $done_after after"; exit 1; }
"$pincer" replay "$work/session/session.db" | tee "$work/replay"
grep -qE 'The same to the bit: [1-9][0-9]* trials?' "$work/replay"
echo "$task: $done_before rows when killed, $done_after in the end"
