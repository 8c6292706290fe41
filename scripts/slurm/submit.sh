#!/usr/bin/env bash
# Submits the shards of a sweep as a job array, and the merger for when the last of them has ended.
# `squama slurm` writes this script; its arguments go to sbatch:
#
#     submit.sh --partition=long --time=24:00:00 --cpus-per-task=8
#
# Run it again when shards have failed: each goes on where it ended, and the merger adds what has
# come.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/sweep.sh"

mkdir -p "$here/log"
# Slurm puts numbers in the place of what follows a per cent sign in the name of a log.
log=${here//%/%%}/log
# The count stands in sweep.sh: within an array, Slurm only tells how many elements were submitted.
array=$(sbatch --parsable --job-name="$NAME" --array="1-$SHARDS" \
    --output="$log/%A_%a.txt" "$@" "$here/array.sh" "$here")
# After any end: `afterok` would wait forever for a shard that has failed.
merger=$(sbatch --parsable --job-name="$NAME merge" --dependency="afterany:${array%%;*}" \
    --output="$log/%j_merge.txt" "$@" "$here/merge.sh" "$here")
echo "$NAME: shards ${array%%;*}, merger ${merger%%;*}, logs in $here/log"
