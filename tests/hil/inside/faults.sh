#!/bin/bash
# What befalls a rig in force, once each: a rig of its own, the blow half a second into full force, 0.6 s to see the end.
. tests/hil/inside/rig.sh
warm chrt candump cansend ip grep
ip link set can0 up type can bitrate 1000000 sample-point 0.8
ip link set can1 up type can bitrate 1000000 sample-point 0.8

chosen=$*  # names, or all
# run NAME LEFT-INTERFACE-OF-THE-FIRMWARE LEFT-INTERFACE-OF-THE-HAND COMMAND...
run() {
  local name=$1 ours=$2 theirs=$3
  shift 3
  [[ " $chosen " == *" $name "* || -z $chosen ]] || return 0
  echo "faults: $name"
  ip link set can0 up; ip link set can1 up  # the row before may have pulled one
  listen "$ours" vcan1
  hand left "$theirs"; hand right vcan1
  sleep 0.5
  firmware "$ours" vcan1
  in_force
  "$@"
  sleep 0.6
  if kill -0 "$firmware_pid" 2>/dev/null; then gone "$firmware_pid"; fi
  gone "$left_pid"; gone "$right_pid"
  gone "$candump_pid"
  keep "$name"
}

killed() { kill -KILL "$left_pid"; }
emergency() { cansend vcan0 082#5082110000000000; }             # of the shoulder, as its drive would send it
stranger() { cansend vcan0 000#8002; }                           # an NMT command: shoulder to pre-operational
bus_off() { cansend vcan0 20000040#0000000000000000; }           # the error frame of a driver
silent() { kill -STOP "$firmware_pid"; sleep 0.1; kill -CONT "$firmware_pid"; }
clock_step() { date -s '+1 day' > /dev/null; sleep 0.3; date -s '-2 days' > /dev/null; }
pulled() { ip link set can0 down; }
pulled_and_back() {
  ip link set can0 down
  sleep 0.2
  ip link set can0 up
  sleep 0.5                                                      # nothing happens by itself
  "$LIGATURE_BIN/ligature-host" send reset-fault > /run/send.log 2>&1
  sleep 0.5                                                      # enabled again, not armed
  "$LIGATURE_BIN/ligature-host" send arm >> /run/send.log 2>&1
  sleep 0.8
}

run hand-killed vcan0 vcan0 killed
run emergency vcan0 vcan0 emergency
run stranger vcan0 vcan0 stranger
run bus-off vcan0 vcan0 bus_off
run controller-stopped vcan0 vcan0 silent
run clock-step vcan0 vcan0 clock_step
run sja1000-pulled can0 can1 pulled
run sja1000-pulled-and-back can0 can1 pulled_and_back
