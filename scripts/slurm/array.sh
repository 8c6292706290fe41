#!/usr/bin/env bash
# Solves one shard of a sweep; submit.sh submits this script as a job array, with one element for
# each shard.
#
# A requeued element resumes its shard and appends to its log. A minute before the time limit Slurm
# sends SIGTERM; squama then discards the designs in progress and writes its tables.
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
set -euo pipefail
. "$1/sweep.sh"

# `exec` replaces this shell, so that squama receives the signals.
exec "$SQUAMA" run "$1/sweep.toml" --resume --quiet \
    --threads "${SLURM_CPUS_PER_TASK:-1}" \
    --shard "$SLURM_ARRAY_TASK_ID/$SHARDS" \
    --out "$1/../shards/$SLURM_ARRAY_TASK_ID-of-$SHARDS"
