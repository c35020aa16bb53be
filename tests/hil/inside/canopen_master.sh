#!/bin/bash
# python-canopen as the CANopen master of a simulated hand, over vcan.
. tests/hil/inside/rig.sh
export LIGATURE_HAND_CAN=vcan0 LIGATURE_DEVICE=$LIGATURE_BIN/ligature-device LIGATURE_DESCRIBE=$LIGATURE_BIN/ligature-can-describe
exec "$LIGATURE_VENV" -u tests/integration/can_readers/test_canopen_master.py Hand
