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
grep -qx 'low-curvature: large cylinder; edge: edge' guide.txt
pincer export out/pilot/session.db --bids bids > /dev/null
# Every column of every table is described, in both exports; the conditions are those of the study.
/usr/bin/python3 - << 'PYTHON'
import json, pathlib, pandas
columns = pandas.read_csv("out/pilot/csv/columns.csv")
for file in pathlib.Path("out/pilot/csv").glob("*.csv"):
    if file.stem != "columns":
        described = columns[columns.table == file.stem]
        assert list(pandas.read_csv(file, nrows=1).columns) == list(described.column), file
        assert described.description.str.len().min() > 6, file
labels = {"low-curvature": "large cylinder", "edge": "edge"}
tables = list(pathlib.Path("bids").glob("sub-*/beh/*.tsv"))
assert tables
for file in tables:
    data, sidecar = pandas.read_csv(file, sep="\t"), json.loads(file.with_suffix(".json").read_text())
    assert set(data.columns) <= set(sidecar), set(data.columns) - set(sidecar)
    assert sidecar["condition"]["Levels"] == labels
    assert set(data.condition) == set(labels) and data.trial.min() == 1 and data.participant.iloc[0] in file.name
assert json.load(open("bids/participants.json"))["first_condition"]["Levels"] == labels
PYTHON
# Given to another experiment it says so, and what to do.
! pincer run delay-discrimination --study docs/examples/own_study.json --print-study 2> wrong.txt
grep -q 'Give the file to `pincer run backlash-discrimination`' wrong.txt
