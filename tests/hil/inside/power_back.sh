#!/bin/bash
# Boot after the power cut, with the same disk: ext4 replays its journal, and the recorder's file is kept as it then is.
. tests/hil/inside/rig.sh
mkdir /run/disk
mount /dev/vda /run/disk
flight=/run/disk/flight.rec
keep power-back
umount /run/disk
