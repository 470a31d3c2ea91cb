"""A study on a cluster of Ray: python with_ray.py PLAN.toml SHARDS PARTS [ADDRESS]

Without the address of a cluster, on the cores of this machine. PARTS is a directory that all workers see.
"""

import contextlib
import os
import subprocess
import sys

import ray

CLATTER = os.environ.get("CLATTER_COMMAND", "clatter")


@ray.remote(num_cpus=1, max_retries=3)  # a task whose worker is lost goes to another one
def shard(plan, i, shards, parts):
    """Makes a part, on one core; if it exists already, nothing is done."""
    part = f"{parts}/{i}.parquet"
    command = [CLATTER, "study", plan, f"--shard={i}/{shards}", "-o", part]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    return part


def main(plan, shards, parts, address=None):
    os.makedirs(parts, exist_ok=True)
    with contextlib.redirect_stdout(sys.stderr):  # where Ray tells of lost workers
        ray.init(address=address, include_dashboard=False, log_to_driver=False)
        made = ray.get([shard.remote(plan, i, shards, parts) for i in range(1, shards + 1)])
        ray.shutdown()
    subprocess.run([CLATTER, "study", "merge", *made, "--format=json"], check=True)


if __name__ == "__main__":
    plan, shards, parts, *address = sys.argv[1:]
    main(os.path.abspath(plan), int(shards), os.path.abspath(parts), *address)
