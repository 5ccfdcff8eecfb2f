# shellcheck shell=sh
# Sourced by the other scripts: where the tree is, how to say what is going on, and Open MPI on any machine.
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root" || exit
started=$(date +%s)

# One line per phase, with the seconds since the script began.
say() {
  printf '[%4d s] %s\n' "$(($(date +%s) - started))" "$*"
}

# Runs a command with its output in a log, which is shown only if the command fails.
quietly() {
  quiet_log=$(mktemp)
  if "$@" >"$quiet_log" 2>&1; then
    rm -f "$quiet_log"
  else
    quiet_code=$?
    cat "$quiet_log" >&2
    rm -f "$quiet_log"
    printf '%s: failed: %s\n' "$0" "$*" >&2
    return "$quiet_code"
  fi
}

# Root may start ranks (containers), more ranks than cores are no error, one thread a rank, no writable /dev/shm and no
# /sys are needed.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
export OMPI_MCA_btl_vader_single_copy_mechanism=none
export OMPI_MCA_sharedfp=^sm HWLOC_HIDE_ERRORS=2
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
