#!/bin/bash
# Ten seconds of the script in which the hands tie an overhand knot; both hands are on virtual CAN buses (vcan).
. tests/hil/inside/rig.sh
warm chrt
run_for 10 overhand
