#!/bin/bash
# One run:   sbatch slurm.sh my.toml
# An array:  sbatch --array=0-3 slurm.sh a.toml b.toml c.toml d.toml
#SBATCH --job-name=alewife
#SBATCH --time=04:00:00
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --signal=USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append

cases=("$@")
case=${cases[${SLURM_ARRAY_TASK_ID:-0}]:?no case file for this job}

srun --cpus-per-task="$SLURM_CPUS_PER_TASK" alewife run "$case"
code=$?

# 75: stopped with a checkpoint before its end. Back into the queue.
job=${SLURM_ARRAY_JOB_ID:+${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID}
job=${job:-$SLURM_JOB_ID}
if [ "$code" -eq 75 ]; then
    scontrol requeue "$job" && exit 0
fi
exit "$code"
