#!/usr/bin/env bash
# Every experiment by a person at a window: under Xvfb, with a scripted mouse and keyboard, instructions are read, the training is done, and counted
# trials; then the program is killed, goes on, is left with Esc, and what was done comes again to the bit.
#   $1 the program, $2 a folder to work in (pictures of what was seen stay there), $3 ... experiments; none: all seven
set -euo pipefail
pincer=$1
work=$2
shift 2
experiments=("$@")
((${#experiments[@]})) || experiments=(smoothness-discrimination backlash-discrimination delay-discrimination repeated-localisation
  shape-identification sphere-pickup cylinder-alignment)
mkdir -p "$work"
rm -f "$work/display"
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp -noreset 3> "$work/display" 2> "$work/xvfb.log" &
xvfb=$!
trap 'kill $xvfb 2> /dev/null || true' EXIT
until [[ -s $work/display ]]; do sleep 0.1; done
DISPLAY=:$(< "$work/display")
export DISPLAY
until xdotool getdisplaygeometry > /dev/null 2>&1; do sleep 0.1; done

# picture NAME   what is on the screen, as a PNG and as the bytes of its pixels.
picture() {
  ffmpeg -loglevel error -y -f x11grab -video_size 1280x720 -i "$DISPLAY" -frames:v 1 "$work/$1.png" -frames:v 1 -f rawvideo -pix_fmt rgb24 \
    "$work/$1.rgb" < /dev/null
}
# counted SESSION   trials that are whole and no training.
counted() {
  python3 - "$1" << 'P'
import sqlite3, sys
try:
    db = sqlite3.connect(f"file:{sys.argv[1]}?mode=ro", uri=True, timeout=20)
    tables = [r[0] for r in db.execute("select name from sqlite_master where type='table'")]
    for table in ("response", "trial"):
        if table in tables:
            columns = [r[1] for r in db.execute(f"pragma table_info({table})")]
            where = " where training = 0" if "training" in columns else ""
            n = db.execute(f"select count(*) from {table}{where}").fetchone()[0]
            if n:
                break
    print(n)
except sqlite3.Error:
    print(0)
P
}
# shows_nothing NAME   true if no pixel left of the pads' panel is orange like an object or of the colour of a finger.
shows_nothing() {
  python3 - "$work/$1.rgb" << 'P'
import sys
pixels = open(sys.argv[1], "rb").read()
found = 0
for y in range(60, 720):
    row = pixels[3 * 1280 * y : 3 * (1280 * y + 1040)]
    found += sum(r > b + 60 and r > 120 for r, b in zip(row[0::3], row[2::3]))
print(found)
sys.exit(found > 50)
P
}
move() { xdotool mousemove "$1" "$2"; }
# stroke EXPERIMENT TURN   a finger: down, from turn to turn deeper, to and fro, asking all the while whether this is the place; up, and answers.
stroke() {
  local x y deep=$((372 + 16 * ($2 % 6)))
  move 641 300
  move 640 300
  for ((y = 300; y < deep; y += 8)); do
    move 640 $y
    sleep 0.02
  done
  for ((x = 640; x < 720; x += 4)); do
    move $x $deep
    xdotool key Return
    sleep 0.03
  done
  picture "$1-stroke" # while it touches
  for ((x = 720; x > 560; x -= 4)); do
    move $x $deep
    xdotool key Return
    sleep 0.03
  done
  move 640 300
  sleep 0.3
  xdotool key Return
  sleep 0.8
  xdotool key 1
  sleep 0.1
  xdotool key Return
  sleep 0.3
}
# lift   two fingers: squeeze, up, hold; and an answer, where one is asked for.
lift() {
  local y
  move 641 400
  move 640 400
  sleep 0.5
  xdotool mousedown 1
  sleep 3
  for ((y = 400; y > 150; y -= 6)); do
    move 640 $y
    sleep 0.04
  done
  picture "$1-stroke"
  sleep 2.5
  xdotool mouseup 1
  move 640 400
  xdotool key Return
  sleep 1
}
# begin EXPERIMENT OPTIONS...   starts the program and waits for its window.
begin() {
  local name=$1
  shift
  "$pincer" run "$name" --devices mouse --view --out "$work/$name" "$@" >> "$work/$name.out" 2>&1 &
  person=$!
  until xdotool search --name '^pincer' > /dev/null 2>&1; do
    kill -0 $person 2> /dev/null || { cat "$work/$name.out"; exit 1; }
    sleep 0.2
  done
  sleep 1
}
# until_counted EXPERIMENT WANTED   gestures until so many trials are counted.
until_counted() {
  local gesture=stroke turns=0
  case $1 in sphere-pickup | cylinder-alignment) gesture=lift ;; esac
  while (($(counted "$work/$1/session.db") < $2)); do
    kill -0 $person 2> /dev/null || { cat "$work/$1.out"; exit 1; }
    ((++turns < 60)) || { echo "$1: no $2 trials in $turns gestures"; exit 1; }
    $gesture "$1" $turns
  done
}
for name in "${experiments[@]}"; do
  rm -rf "${work:?}/$name"
  : > "$work/$name.out"
  begin "$name"
  picture "$name-page"
  until_counted "$name" 3
  kill -KILL $person
  wait $person 2> /dev/null || true
  before=$(counted "$work/$name/session.db")
  begin "$name" --resume
  picture "$name-resumed"
  until_counted "$name" $((before + 1))
  xdotool key Escape
  code=0
  wait $person || code=$?
  ((code == 5)) || { cat "$work/$name.out"; echo "$name: exit code $code after Esc"; exit 1; }
  "$pincer" replay "$work/$name/session.db" > "$work/$name.replay" || { cat "$work/$name.replay"; exit 1; }
  grep -q 'The same to the bit' "$work/$name.replay"
  case $name in
    sphere-pickup | cylinder-alignment) ;; # on the mouse the hand is seen, unless --blind
    *) shows_nothing "$name-stroke" || { echo "$name: object or finger is seen in a counted trial: $work/$name-stroke.png"; exit 1; } ;;
  esac
  echo "$name: $(counted "$work/$name/session.db") trials, killed after $before, resumed, left, the same to the bit"
done
