#!/usr/bin/env bash
# Merges the shards of a sweep of squama; see submit.sh. Fails and names the missing designs until all
# are solved.
#SBATCH --open-mode=append
set -euo pipefail
. "$1/sweep.sh"

# Shards that have not begun have no journal.
shards=()
for shard in "$1/../shards/"*"-of-$SHARDS"; do
    if [ -s "$shard/journal.jsonl" ]; then shards+=("$shard"); fi
done
exec "$SQUAMA" merge --out "$1/.." ${shards[@]+"${shards[@]}"}
