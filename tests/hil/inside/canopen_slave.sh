#!/bin/bash
# python-canopen as the three drives of the left hand, controlled by the firmware; the right hand is ligature-device.
. tests/hil/inside/rig.sh
warm chrt "$LIGATURE_VENV"
for node in 1 2 3; do "$LIGATURE_BIN/ligature-can-describe" eds "$node" > "/run/node-$node.eds"; done
hand right vcan1
"$LIGATURE_VENV" tests/hil/inside/canopen_hand.py > /run/left.log 2>&1 &
slave_pid=$!
until grep -q ready /run/left.log; do sleep 0.1; done
firmware vcan0 vcan1 --watchdog-ms 10000
wait "$slave_pid" || true
gone "$firmware_pid"; gone "$right_pid"
keep canopen-slave
cat /run/left.log
