#!/usr/bin/env bash
# Runs the simulation of the queue links over a million seeds (or as many as named), in parts, and stops at the first
# violation.   run_million.sh BUILD_DIRECTORY [SEEDS [FIRST [JOBS]]]
set -euo pipefail
program=$1/bin/link_simulation
seeds=${2:-1000000}
first=${3:-1}
jobs=${4:-2}
part=50000
for ((done = 0; done < seeds; done += part)); do
    count=$((seeds - done < part ? seeds - done : part))
    "$program" --first $((first + done)) --seeds "$count" --jobs "$jobs" >/tmp/link_simulation.$$ || {
        cat /tmp/link_simulation.$$
        exit 1
    }
    head -1 /tmp/link_simulation.$$
done
rm -f /tmp/link_simulation.$$
echo "no violation in $seeds seeds from $first"
