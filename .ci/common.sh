# Read by the scripts beside it: settings, and what several of them use.
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# modules become bytecode when they are first imported, which most never are, and once for all
export PIP_COMPILE=0
unset PYTHONDONTWRITEBYTECODE
# jobs run beside one another: threads of linear algebra would only wait for each other's cores
export OMP_NUM_THREADS=1
started=$SECONDS
step() { printf '\n== %s (after %s s)\n' "$*" "$((SECONDS - started))"; }

# Runs the command in each line, two at a time, in this order; fails, when all have ended, if one has.
two_at_a_time() {
    xargs -P 2 -d '\n' -n 1 bash -euo pipefail -c \
        'eval "$0"; printf "done after %4s s: %.80s\n" "$SECONDS" "$0"'
}
