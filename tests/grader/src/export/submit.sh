#!/bin/sh
# Submits both jobs; the second one starts when all tasks of the first one have ended, however they end.
set -eu
# Slurm stops each task without a message if the folder of its log is missing.
mkdir -p {out_quoted}/{results} {out_quoted}/logs
job=$(sbatch --parsable {out_quoted}/{first})
# On some clusters the name of the cluster follows the number of the job.
job=${job%%;*}
sbatch --dependency="afterany:$job" {out_quoted}/{second}
echo "the array is job $job; squeue shows it, and {out}/logs has what the tasks print"
