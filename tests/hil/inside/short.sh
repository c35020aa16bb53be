#!/bin/bash
# What CI asks at each change: ten seconds without a missed deadline, and three blows to a rig in force.
set -eu
bash tests/hil/inside/overhand.sh
exec bash tests/hil/inside/faults.sh hand-killed emergency bus-off
