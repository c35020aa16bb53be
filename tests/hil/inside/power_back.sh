#!/bin/bash
# The same disk with power again: ext4 replays its journal, and the recorder's file is what it is.
. tests/hil/inside/rig.sh
mkdir /run/disk
mount /dev/vda /run/disk
flight=/run/disk/flight.rec
keep power-back
umount /run/disk
