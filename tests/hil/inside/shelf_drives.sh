#!/bin/bash
# Rigs with simulated ODrives (classic frames) and moteus controllers (CAN-FD frames) on vcan: two seconds each, and a
# second run in which the firmware is killed while it renders force.
. tests/hil/inside/rig.sh
warm chrt grep ip
hands_priority=75
for i in 0 1; do ip link set vcan$i down; ip link set vcan$i mtu 72; ip link set vcan$i up; done
for drives in odrive moteus; do
  echo "shelf drives: $drives"
  record=scenes/devices/$drives.toml
  accept=
  [ "$drives" = odrive ] || accept=--accept-no-drive-watchdog  # a moteus damps after its watchdog, it does not let go
  run_for 2 "$drives" $accept
  hand left vcan0; hand right vcan1
  sleep 0.5
  firmware vcan0 vcan1 $accept
  in_force
  kill -KILL "$firmware_pid"
  sleep 0.3
  gone "$left_pid"; gone "$right_pid"
  keep "$drives-killed"
done
