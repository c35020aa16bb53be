#!/bin/bash
# Tests of the socket back ends, `doctor` on a PREEMPT_RT kernel, and --rt=enforce where it must refuse to run.
. tests/hil/inside/rig.sh
echo "machine: back end on vcan"
"$LIGATURE_TESTS/test_socketcan" > /hil/socketcan.log 2>&1 || { cat /hil/socketcan.log; exit 1; }
echo "machine: doctor"
doctor="$LIGATURE_BIN/ligature-firmware doctor"
if [ -e "${fair_server}1/runtime" ]; then
  echo 50000000 > "${fair_server}1/runtime"
  $doctor --seconds 0 > /hil/fair_server.log 2>&1 || true
  echo 0 > "${fair_server}1/runtime"
fi
mount -t tracefs tracefs /sys/kernel/tracing
ip link set can0 up txqueuelen 8 type can bitrate 1000000 sample-point 0.8
$doctor --can vcan0 --can can0 --seconds 2 --report /hil/doctor.json > /hil/doctor.log 2>&1 && code=0 || code=$?
echo "$code" > /hil/doctor.code
"$LIGATURE_BIN/ligature-firmware" admit --scene scenes/paper.toml --seconds 0.1 --budget 100 --can vcan0 --can can0 > /hil/admit.log 2>&1 || true
echo "machine: a real-time rig for nobody"
chmod 777 /run
hand left vcan0; hand right vcan1
setpriv --reuid 65534 --clear-groups --bounding-set -all "$LIGATURE_BIN/ligature-firmware" run --scene scenes/paper.toml --left socketcan:vcan0 \
  --right socketcan:vcan1 --force --rt=enforce --recorder none --duration 0.2 --watchdog-ms 10000 > /hil/enforce.log 2>&1 && code=0 || code=$?
echo "$code" > /hil/enforce.code
gone "$left_pid"; gone "$right_pid"
