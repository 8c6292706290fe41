#!/usr/bin/env bash
# Merges the shards of a sweep; submit.sh submits this script after the job array. If designs are
# missing, squama lists them and exits with code 1.
#SBATCH --open-mode=append
set -euo pipefail
. "$1/sweep.sh"

# Omit shards without a journal, because they have not started.
shards=()
for shard in "$1/../shards/"*"-of-$SHARDS"; do
    if [ -s "$shard/journal.jsonl" ]; then shards+=("$shard"); fi
done
exec "$SQUAMA" merge --out "$1/.." ${shards[@]+"${shards[@]}"}
