#!/usr/bin/env bash
# Submits the shards of a sweep as a job array, and a job that merges them after the last has ended.
# `squama slurm` writes this script; its arguments are passed to sbatch:
#
#     submit.sh --partition=long --time=24:00:00 --cpus-per-task=8
#
# Run it again if shards have failed: each shard resumes, and the merger adds the new designs.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/sweep.sh"

mkdir -p "$here/log"
# Double each per cent sign, because Slurm replaces %A, %a and %j in the name of a log by numbers.
log=${here//%/%%}/log
# SHARDS comes from sweep.sh, because SLURM_ARRAY_TASK_COUNT only counts the submitted elements.
array=$(sbatch --parsable --job-name="$NAME" --array="1-$SHARDS" \
    --output="$log/%A_%a.txt" "$@" "$here/array.sh" "$here")
# `afterany`, because `afterok` would wait forever for a shard that has failed.
merger=$(sbatch --parsable --job-name="$NAME merge" --dependency="afterany:${array%%;*}" \
    --output="$log/%j_merge.txt" "$@" "$here/merge.sh" "$here")
echo "$NAME: shards ${array%%;*}, merger ${merger%%;*}, logs in $here/log"
