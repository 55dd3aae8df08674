#!/usr/bin/env bash
# What `pincer export --bids` ($1: the program, $2: a directory of its own) writes has names that the validator of BIDS accepts, of a study with one finger
# and of one with two.
set -euo pipefail
pincer=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
for study in "repeated-localisation" "sphere-pickup --repetitions 1 --friction 0.9"; do
  # shellcheck disable=SC2086
  "$pincer" run $study --participants 2 --seed 1 --no-report --out "$work/session" > /dev/null
  "$pincer" export "$work/session/session.db" --bids "$work/bids" > /dev/null
  /usr/bin/python3 - "$work/bids" << 'PYTHON'
import os, sys
from bids_validator import BIDSValidator

root, validator, subjects = sys.argv[1], BIDSValidator(), set()
assert not validator.is_bids('/sub-01/beh/sub-01_beh.json.tsv'), 'the validator accepts anything'
for directory, _, files in os.walk(root):
    for name in files:
        path = os.path.join(directory, name)[len(root):]
        assert validator.is_bids(path), f'{path} is no name of BIDS'
        if path.endswith('_beh.tsv'):
            subjects.add(path.split('/')[1])
assert subjects == {'sub-01', 'sub-02'}, subjects
PYTHON
  rm -r "$work/session" "$work/bids"
done
