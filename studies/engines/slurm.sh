#!/usr/bin/env bash
# A study as an array of Slurm, a shard a task:
#
#   sbatch --array=1-64 slurm.sh plan.toml 64 parts
#   sbatch --dependency=afterok:JOB --wrap='clatter study merge parts/*.parquet'
#
# If tasks failed, run the same line again: existing parts are kept.
#SBATCH --job-name=clatter-study
#SBATCH --cpus-per-task=1
#SBATCH --mem=1G
#SBATCH --requeue
set -euo pipefail
plan=$1 shards=$2 parts=$3
mkdir -p "$parts"
export RAYON_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}
exec "${CLATTER_COMMAND:-clatter}" study "$plan" --shard="$SLURM_ARRAY_TASK_ID/$shards" -o "$parts/$SLURM_ARRAY_TASK_ID.parquet"
