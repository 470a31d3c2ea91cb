#!/usr/bin/env bash
# A study on all cores of this machine, or with GNU parallel on those of others (--sshloginfile): parallel.sh PLAN.toml SHARDS PARTS
set -euo pipefail
plan=$1 shards=$2 parts=$3 clatter=${CLATTER_COMMAND:-clatter}
mkdir -p "$parts"
export RAYON_NUM_THREADS=1
if command -v parallel > /dev/null; then
  seq "$shards" | parallel --retries 3 "$clatter" study "$plan" --shard={}/"$shards" -o "$parts"/{}.parquet >&2
else
  seq "$shards" | xargs -P "$(nproc)" -I{} "$clatter" study "$plan" --shard={}/"$shards" -o "$parts"/{}.parquet >&2
fi
"$clatter" study merge "$parts"/*.parquet --format=json
