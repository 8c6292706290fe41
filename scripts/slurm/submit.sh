#!/usr/bin/env bash
# Submits the shards of a sweep as a job array, and a job that merges all shards after the array has
# ended. `squama slurm` writes this script. Its arguments are passed to sbatch, for example:
#
#     submit.sh --partition=long --time=24:00:00 --cpus-per-task=8
#
# If shards have failed, run the script again: each shard resumes, and the merge adds new designs.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/sweep.sh"

mkdir -p "$here/log"
# Double each per cent sign in the path, because Slurm replaces %A, %a and %j in the name of a log.
log=${here//%/%%}/log
# The number of shards is in sweep.sh: SLURM_ARRAY_TASK_COUNT counts only the submitted elements.
array=$(sbatch --parsable --job-name="$NAME" --array="1-$SHARDS" \
    --output="$log/%A_%a.txt" "$@" "$here/array.sh" "$here")
# Use `afterany`: with `afterok` the merge would wait forever if a shard fails.
merger=$(sbatch --parsable --job-name="$NAME merge" --dependency="afterany:${array%%;*}" \
    --output="$log/%j_merge.txt" "$@" "$here/merge.sh" "$here")
echo "$NAME: shards ${array%%;*}, merger ${merger%%;*}, logs in $here/log"
