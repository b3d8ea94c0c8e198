"""A sweep on the workers of a SLURM cluster, which come and go as there is room. Usage: slurm_dask.py CASES SCENE DIRECTORY

Start it where it may run as long as the sweep: it hands out the cases and keeps their rows. The same command goes on after an end.
Needs dask-jobqueue, and the same version of roulement for the workers: they start from the same environment on a shared disc.
"""

import sys

from dask_jobqueue import SLURMCluster

# A job: four workers of one thread. The queue's name, memory and time are those of the cluster.
JOB = {"queue": "batch", "cores": 4, "processes": 4, "memory": "2 GB", "walltime": "02:00:00"}


def main(cases, scene, directory, jobs=64):
    from distributed import Client
    from roulement import sweep

    # Workers end themselves before their time is over, and others are started for them.
    with SLURMCluster(**JOB, worker_extra_args=["--lifetime", "110m", "--lifetime-stagger", "5m"]) as cluster:
        cluster.adapt(minimum_jobs=0, maximum_jobs=jobs)
        with Client(cluster) as client:
            table = sweep.run(cases, scene, directory, scheduler=client, progress=True)
    print(table)


if __name__ == "__main__":
    main(*sys.argv[1:])
