#!/usr/bin/env bash
# The guide to a study of one's own, docs/own-study.md, as typed: its file is the example, its commands run, and its Python reads what comes out.
#   $1 the program, $2 a folder to work in
set -euo pipefail
pincer=$1
work=$2
root=$(cd "$(dirname "$0")/../.." && pwd)
rm -rf "$work"
mkdir -p "$work/docs/examples" "$work/bin"
cp "$root/docs/examples/own_study.json" "$work/docs/examples/"
ln -s "$pincer" "$work/bin/pincer"
cd "$work"
export PATH=$work/bin:$PATH
guide=$root/docs/own-study.md
# block PATTERN   the indented block of the guide whose first line matches, without its indentation.
block() {
  awk -v want="$1" '/^    /{line = substr($0, 5); if (!inside) { inside = 1; shown = line ~ want } if (shown) print line; next}
                    /^$/{if (inside && shown) print ""; next} {inside = 0; shown = 0}' "$guide"
}
block '^{' | python3 -c '
import json, sys
guide = json.load(sys.stdin)
example = json.load(open("docs/examples/own_study.json"))
assert guide == example, "the guide shows another study file than docs/examples/own_study.json"'
# The commands that need no person: those that print the study and run its pilot.
n=0
mapfile -t commands < <(grep -E '^    pincer run .*(--print-study|--out out/pilot)$' "$guide")
((${#commands[@]} == 2)) || { echo "the guide has ${#commands[@]} commands to run, not 2"; exit 1; }
for command in "${commands[@]}"; do
  n=$((n + 1))
  bash -euo pipefail -c "$command" > "out-$n.txt"
done
grep -q '"low-curvature"' out-1.txt
[[ -s out/pilot/report.html ]]
pincer replay out/pilot/session.db > replay.txt
grep -q 'The same to the bit' replay.txt
pincer export out/pilot/session.db > /dev/null
block '^import pandas' > guide.py
[[ -s guide.py ]]
/usr/bin/python3 guide.py | tee guide.txt
grep -q 'level_si' guide.txt   # described beside the data
grep -qE '^low-curvature +[0-9]' guide.txt && grep -qE '^edge +[0-9]' guide.txt
pincer export out/pilot/session.db --bids bids > /dev/null
[[ -d bids ]]
