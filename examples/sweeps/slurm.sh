#!/usr/bin/env bash
# A sweep as a job array of SLURM, without Python: each task runs its shard of the cases on the cores that it gets, into a folder of its own on the
# disc that all machines share. SLURM starts tasks whenever there is room; a task that it ends or puts back into the queue goes on where it was.
#
#   sbatch examples/sweeps/slurm.sh CASES SCENE DIRECTORY
#   roulement sweep CASES --scene SCENE -o DIRECTORY --collect        # after the last task; at any time for what is there
#
#SBATCH --job-name=roulement
#SBATCH --array=1-64
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=500M
#SBATCH --time=02:00:00
# The program gets SIGTERM a minute before its time is over. It keeps what is done, and ends with 130.
#SBATCH --signal=TERM@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=sweep-%A-%a.log
set -euo pipefail

cases=$1
scene=$2
directory=$3
shard="$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"

# In the place of this shell, so that the signal comes to the program.
exec "${ROULEMENT:-roulement}" sweep "$cases" --scene "$scene" -o "$directory" \
    --shard "$shard" --threads "${SLURM_CPUS_PER_TASK:-1}"
