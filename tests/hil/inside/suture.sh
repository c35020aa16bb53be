#!/bin/bash
# The script that ties an overhand knot in a suture, for ten seconds; recorded with its shapes, so that the knot can be
# named.
. tests/hil/inside/rig.sh
warm chrt
scene=scenes/suture-3-0.toml script=scenes/operators/suture-overhand.csv
hands_priority=75
"$LIGATURE_BIN/ligature-host" record --out /run/suture.lcmlog --flight-folder /run --quiet > /run/record.log 2>&1 &
record_pid=$!
run_for "${1:-10}" suture "${@:2}"
gone "$record_pid"
cp /run/suture.lcmlog /run/record.log /hil/suture/
