#!/usr/bin/env bash
# Puts the shards of a sweep together; see submit.sh. Fails, and names them, while designs are missing.
#SBATCH --open-mode=append
set -euo pipefail
. "$1/sweep.sh"

# Shards that have not begun have no journal.
shards=()
for shard in "$1/../shards/"*"-of-$SHARDS"; do
    if [ -s "$shard/journal.jsonl" ]; then shards+=("$shard"); fi
done
exec "$SQUAMA" merge --out "$1/.." ${shards[@]+"${shards[@]}"}
