#!/usr/bin/env bash
#SBATCH --job-name=pinhole
#SBATCH --cpus-per-task=8
# Renders one of several bands of a picture, as a task of a Slurm job array:
#
#     sbatch --array=1-N render.sh SCENE N FOLDER [OPTION...]
#
# The band goes to FOLDER, and OPTIONs are those of `pinhole render`, such as `--set`. A band that
# is there already is not rendered again. Files are written completely or not at all, so that a
# task that was killed leaves nothing that looks like a band.
set -euo pipefail

if [ $# -lt 3 ] || [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then
  printf 'usage: sbatch --array=1-N %s SCENE N FOLDER [OPTION...]\n' "${0##*/}" >&2
  exit 2
fi
scene=$1 count=$2 folder=$3
shift 3

band=$(printf '%s/%04d-of-%04d.png' "$folder" "$SLURM_ARRAY_TASK_ID" "$count")
if [ -e "$band" ]; then
  printf '%s is there already\n' "$band"
  exit
fi
mkdir -p "$folder"
pinhole render "$scene" --shard "$SLURM_ARRAY_TASK_ID/$count" -o "$band" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
printf '%s is rendered\n' "$band"
