#!/bin/bash
# Faults of a rig that renders force. Each has a new rig, occurs half a second after full force, and is observed for 0.6 s.
. tests/hil/inside/rig.sh
warm chrt candump cansend ip grep pgrep
ip link set can0 up type can bitrate 1000000 sample-point 0.8
ip link set can1 up type can bitrate 1000000 sample-point 0.8

chosen=$*  # names of the faults to run; empty: all
right=vcan1
also=      # further interface whose frames are recorded; empty: none
# Runs one fault: run NAME LEFT-INTERFACE-OF-THE-FIRMWARE LEFT-INTERFACE-OF-THE-HAND COMMAND-THAT-CAUSES-THE-FAULT...
run() {
  local name=$1 ours=$2 theirs=$3
  shift 3
  [[ " $chosen " == *" $name "* || -z $chosen ]] || return 0
  echo "faults: $name"
  ip link set can0 up; ip link set can1 up  # the previous fault may have taken one down
  listen "$ours,0:0,#FFFFFFFF" "$right" $also
  hand left "$theirs"; hand right "$right"
  sleep 0.5
  firmware "$ours" "$right"
  in_force
  "$@"
  sleep 0.6
  if kill -0 "$firmware_pid" 2>/dev/null; then gone "$firmware_pid"; fi
  gone "$left_pid"; gone "$right_pid"
  gone "$candump_pid"
  keep "$name"
}

killed() { kill -KILL "$left_pid"; }
emergency() { cansend vcan0 082#5082110000000000; }             # EMCY as from the shoulder's drive
stranger() { cansend vcan0 000#8002; }                           # an NMT command: shoulder to pre-operational
foreign_rpdo() { cansend vcan0 201#0F00B80B; }                    # another node commands 3000 per mille
bus_off() { cansend vcan0 20000040#0000000000000000; }           # the error frame of a driver
silent() { kill -STOP "$firmware_pid"; sleep 0.1; kill -CONT "$firmware_pid"; }
clock_step() { date -s '+1 day' > /dev/null; sleep 0.3; date -s '-2 days' > /dev/null; }
pulled() { ip link set can0 down; }
pulled_and_back() {
  ip link set can0 down
  sleep 0.2
  ip link set can0 up
  by_order
}
by_order() {
  sleep 0.5                                                      # the controller must stay in state FAULT
  "$LIGATURE_BIN/ligature-host" send reset-fault > /run/send.log 2>&1
  sleep 0.5                                                      # drives enabled again, no force allowed yet
  "$LIGATURE_BIN/ligature-host" send arm >> /run/send.log 2>&1
  sleep 0.8
}
# slcan0 is a serial adapter between the controller and wire0; its driver has the states of a CAN controller. wire0 and
# wire1 are vcans under other names, so no transmission time is simulated on them; handling the serial line takes the
# CPU about that time. The adapter has a higher priority than the loop, like the interrupts of a real one.
adapter() {
  [[ -z $chosen || " $chosen " == *" slcan-bus-off "* ]] || return 0
  for i in 0 1; do ip link add dev wire$i type vcan; ip link set wire$i up; done
  chrt -f 85 "$LIGATURE_TESTS/slcan-adapter" wire0 > /run/slcan.name 2> /run/slcan.log &
  adapter_pid=$!
  until [ -s /run/slcan.name ]; do sleep 0.01; done
  ip link set "$(cat /run/slcan.name)" name slcan0 txqueuelen 64
  ip link set slcan0 up type can bitrate 1000000
  for work in $(pgrep 'kworker/|ksoftirqd/'); do chrt -f -p 84 "$work" 2> /dev/null || true; done
}
controller_off_and_back() {
  ip -details link show slcan0 > /run/slcan-before.log
  kill -USR1 "$adapter_pid"                                      # error counter 256: bus-off
  sleep 0.2
  ip -details link show slcan0 > /run/slcan-after.log
  kill -USR2 "$adapter_pid"                                      # the controller recovers
  sleep 0.2
  ip link set slcan0 down
  ip link set slcan0 up
  by_order
}

run hand-killed vcan0 vcan0 killed
run emergency vcan0 vcan0 emergency
run stranger vcan0 vcan0 stranger
run foreign-rpdo vcan0 vcan0 foreign_rpdo
run bus-off vcan0 vcan0 bus_off
run controller-stopped vcan0 vcan0 silent
run clock-step vcan0 vcan0 clock_step
run sja1000-pulled can0 can1 pulled
run sja1000-pulled-and-back can0 can1 pulled_and_back
adapter
right=wire1 also=wire0
run slcan-bus-off slcan0 wire0 controller_off_and_back
