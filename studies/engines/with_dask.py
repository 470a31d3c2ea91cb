"""A study on a cluster of Dask: python with_dask.py PLAN.toml SHARDS PARTS [SCHEDULER]

Without the address of a scheduler, on the cores of this machine. PARTS is a directory that all workers see.
"""

import os
import subprocess
import sys

from dask.distributed import Client

CLATTER = os.environ.get("CLATTER_COMMAND", "clatter")


def shard(plan, i, shards, parts):
    """Makes a part, on one core; if it exists already, nothing is done."""
    part = f"{parts}/{i}.parquet"
    command = [CLATTER, "study", plan, f"--shard={i}/{shards}", "-o", part]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    return part


def main(plan, shards, parts, scheduler=None):
    os.makedirs(parts, exist_ok=True)
    where = {"address": scheduler} if scheduler else {"n_workers": os.cpu_count(), "threads_per_worker": 1}
    with Client(**where, dashboard_address=None) as client:
        # A task whose worker is lost goes to another one.
        tasks = [client.submit(shard, plan, i, shards, parts, retries=3, pure=False) for i in range(1, shards + 1)]
        made = client.gather(tasks)
    subprocess.run([CLATTER, "study", "merge", *made, "--format=json"], check=True)


if __name__ == "__main__":  # workers import this file
    plan, shards, parts, *scheduler = sys.argv[1:]
    main(os.path.abspath(plan), int(shards), os.path.abspath(parts), *scheduler)
