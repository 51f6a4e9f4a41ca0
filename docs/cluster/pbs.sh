#!/bin/bash
# One run:   qsub -v CASE=my.toml pbs.sh
#PBS -N alewife
#PBS -l select=1:ncpus=4:mem=4gb
#PBS -l walltime=04:00:00
#PBS -r y

cd "$PBS_O_WORKDIR" || exit 1
alewife run "${CASE:?no case file}" --threads "${NCPUS:-4}" --max-walltime "235 min"
code=$?

# 75: stopped with a checkpoint before its end. A job of the same kind continues it.
if [ "$code" -eq 75 ]; then
    qsub -v CASE="$CASE" pbs.sh && exit 0
fi
exit "$code"
