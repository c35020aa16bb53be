#!/bin/bash
# Ten seconds of the overhand script, with both hands on vcan.
. tests/hil/inside/rig.sh
warm chrt
hand left vcan0; hand right vcan1
sleep 0.5
firmware vcan0 vcan1 --duration 10
wait "$firmware_pid" && code=0 || code=$?
gone "$left_pid"; gone "$right_pid"
cat /run/firmware.log
keep overhand
exit "$code"
