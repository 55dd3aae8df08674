#!/usr/bin/env bash
# A simulated session that somebody watches, on a machine that stalls: stopped for 60 ms again and again, it loses no trial, and what comes out is
# the same to the bit as unwatched.
#   $1 the program, $2 a folder to work in
set -euo pipefail
pincer=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
run() { "$pincer" run sphere-pickup --repetitions 1 --friction 0.9 --condition cld+force --no-report --sample-rate 1000 --seed 5 --out "$work/$1" "${@:2}"; }
run alone > "$work/alone.out"
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp -noreset 3> "$work/display" 2> "$work/xvfb.log" &
xvfb=$!
trap 'kill $xvfb 2> /dev/null || true' EXIT
until [[ -s $work/display ]]; do sleep 0.1; done
DISPLAY=:$(< "$work/display")
export DISPLAY
"$pincer" run sphere-pickup --repetitions 1 --friction 0.9 --condition cld+force --no-report --sample-rate 1000 --seed 5 --out "$work/watched" --view \
  > "$work/watched.out" 2>&1 &
watched=$!
stops=0
while kill -0 $watched 2> /dev/null; do
  sleep 0.25
  kill -STOP $watched 2> /dev/null || break
  sleep 0.06
  kill -CONT $watched 2> /dev/null || break  # it had ended before it was stopped
  stops=$((stops + 1))
done
wait $watched || { cat "$work/watched.out"; echo "the watched session ended with exit code $?, after $stops stalls"; exit 1; }
for session in alone watched; do "$pincer" export "$work/$session/session.db" --out "$work/$session/csv" > /dev/null; done
# without_times TABLE   the table without its columns of computing time, counted from the right: a quoted field further left may hold commas.
without_times() {
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^tick_.*us$/) drop[NF - i] = 1 }
           { for (i = 1; i <= NF; i++) printf "%s,", (NF - i) in drop ? "" : $i; print "" }' "$1"
}
for table in trial sample event reading; do
  diff <(without_times "$work/alone/csv/$table.csv") <(without_times "$work/watched/csv/$table.csv") > "$work/diff" ||
    { head -4 "$work/diff" | cut -c1-300; echo "$table.csv differs when somebody watches"; exit 1; }
done
rows=$(wc -l < "$work/watched/csv/sample.csv")
((rows > 3000 && stops > 4)) || { echo "only $rows samples and $stops stalls"; exit 1; }
echo "$rows samples the same to the bit, through $stops stalls"
