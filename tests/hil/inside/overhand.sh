#!/bin/bash
# Ten seconds of the script in which the hands tie an overhand knot; both hands are on virtual CAN buses (vcan).
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
