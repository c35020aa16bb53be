#!/bin/bash
# A rig in force that records to a disk of its own, and then no power. What the recorder had written is copied from the
# kernel's memory first: for that the controller is killed, and nothing but itself may bring its pages to the disk.
. tests/hil/inside/rig.sh
warm chrt grep
mkfs.ext4 -q /dev/vda
mkdir /run/disk
mount -o noatime,commit=600 /dev/vda /run/disk
echo 0 > /proc/sys/vm/dirty_writeback_centisecs
flight=/run/disk/flight.rec
hand left vcan0; hand right vcan1
sleep 0.5
firmware vcan0 vcan1
in_force
kill -KILL "$firmware_pid"
keep power-cut
echo "HIL-EXIT 0" > /dev/ttyS0
echo b > /proc/sysrq-trigger                                     # at once: nothing is synced, nothing unmounted
