#!/usr/bin/env bash
# One shard of a sweep, an element of a job array of squama; see submit.sh.
#
# An element that is requeued goes on where it ended and appends to its log. A minute before its time
# is up it is told to end: it finishes the designs in hand and writes its tables.
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
set -euo pipefail
. "$1/sweep.sh"

# In place of this shell, which signals would end otherwise.
exec "$SQUAMA" run "$1/sweep.toml" --resume --quiet \
    --threads "${SLURM_CPUS_PER_TASK:-1}" \
    --shard "$SLURM_ARRAY_TASK_ID/$SHARDS" \
    --out "$1/../shards/$SLURM_ARRAY_TASK_ID-of-$SHARDS"
