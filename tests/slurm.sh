#!/usr/bin/env bash
# Runs the job script of docs/cluster under a real Slurm, and compares what its jobs leave with unbroken runs.
#
#   sudo tests/slurm.sh            # about ten minutes; not part of test.sh
#
# Needs root, debootstrap and a network the first time. Debian's slurm-wlm and munge are installed into a
# folder of their own, and their daemons run in namespaces of their own: nothing of this computer is changed,
# and nothing goes on after the script. ALEWIFE_BIN is the program (target/release/alewife if unset),
# ALEWIFE_SLURM_ROOT a folder in which the installation is kept for the next time, ALEWIFE_SLURM_END the end of the
# longer runs: 60 is a bit more than a minute of CPU time, so that limits of a minute come before it.
set -euo pipefail

suite=bookworm
packages=slurm-wlm,munge,iproute2

outside() {
    local here binary root
    here=$(cd "$(dirname "$0")" && pwd)
    binary=${ALEWIFE_BIN:-$here/../target/release/alewife}
    [ "$(id -u)" = 0 ] || { echo "error: run it as root" >&2; exit 2; }
    [ -x "$binary" ] || { echo "error: no program $binary; build it, or set ALEWIFE_BIN" >&2; exit 2; }
    place=$(mktemp -d "${TMPDIR:-/tmp}/alewife-slurm.XXXXXX")
    # The namespaces take all mounts and processes with them
    child=
    trap '[ -z "$child" ] || kill -9 $child 2>/dev/null || true; rm -rf --one-file-system "$place"' EXIT
    trap 'exit 130' INT TERM
    root=${ALEWIFE_SLURM_ROOT:-$place/root}
    if [ ! -x "$root/usr/sbin/slurmctld-wlm" ]; then
        command -v debootstrap >/dev/null || { echo "error: debootstrap is not installed" >&2; exit 2; }
        echo "installing Slurm into $root ..."
        debootstrap --variant=minbase --include="$packages" "$suite" "$root" >"$place/install.log" 2>&1 ||
            { tail -5 "$place/install.log" >&2; exit 2; }
    fi
    mkdir -p "$place/job"
    cp "$binary" "$place/job/alewife"
    cp "$here/../docs/cluster/slurm.sh" "$place/job/job.sh"
    cp "$0" "$place/job/test.sh"
    cp "$here/batch.sh" "$place/job/"
    mkdir -p "$root/job"
    unshare --mount --pid --fork --net --uts --kill-child bash -c "
        set -e
        hostname node
        mount --make-rprivate /
        mount --bind '$place/job' '$root/job'
        mount -t proc proc '$root/proc'
        mount -t sysfs -o ro sysfs '$root/sys'
        mount -t tmpfs tmpfs '$root/sys/fs/cgroup'
        mount -t tmpfs tmpfs '$root/tmp'
        mount -t tmpfs tmpfs '$root/run'
        for device in null zero random urandom; do
            touch '$root/dev/'\$device; mount --bind /dev/\$device '$root/dev/'\$device
        done
        exec chroot '$root' /bin/bash /job/test.sh inside" &
    child=$!
    wait $child
}

# --- Inside ---------------------------------------------------------------------------------------

begin_slurm() {
    export PATH=/job:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
    ip link set lo up
    # Names are looked up only where there is an address besides 127.0.0.1
    ip address add 10.0.0.1/32 dev lo
    echo "127.0.0.1 node localhost" >/etc/hosts
    mkdir -p /run/munge /var/lib/slurm/slurmctld /var/spool/slurmd /var/log/slurm
    rm -rf /var/lib/slurm/slurmctld/* /var/spool/slurmd/* /var/log/slurm/*
    chown munge:munge /run/munge
    echo CgroupPlugin=cgroup/v1 >/etc/slurm/cgroup.conf
    cat >/etc/slurm/slurm.conf <<'CONF'
ClusterName=test
SlurmctldHost=node(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
# How long a job that is put back waits before it starts again
AuthInfo=cred_expire=5
StateSaveLocation=/var/lib/slurm/slurmctld
SlurmdSpoolDir=/var/spool/slurmd
SlurmctldPidFile=/run/slurmctld.pid
SlurmdPidFile=/run/slurmd.pid
SlurmctldLogFile=/var/log/slurm/slurmctld.log
SlurmdLogFile=/var/log/slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=2,bf_interval=2
# More than the computer may have: jobs wait for the clock rather than for each other
SlurmdParameters=config_overrides
ReturnToService=2
MpiDefault=none
KillWait=5
MinJobAge=7200
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
NodeName=node NodeAddr=127.0.0.1 CPUs=8 RealMemory=16000 State=UNKNOWN
PartitionName=low Nodes=ALL Default=YES MaxTime=60 State=UP PriorityTier=1 PreemptMode=REQUEUE GraceTime=10
PartitionName=high Nodes=ALL MaxTime=60 State=UP PriorityTier=10 PreemptMode=OFF
CONF
    runuser -u munge -- munged --force
    slurmctld
    sleep 2
    slurmd
    wait_for 30 node_is_idle || { tail -20 /var/log/slurm/*.log; exit 1; }
}

node_is_idle() { sinfo -h -o %T | grep -q idle; }

# Waits up to so many seconds for a command to succeed.
wait_for() {
    local patience=$1 waited=0
    shift
    until "$@" >/dev/null 2>&1; do
        [ "$waited" -lt "$patience" ] || return 1
        sleep 1
        waited=$((waited + 1))
    done
}

# NAME: a value of a job's description, such as JobState.
field() { scontrol show job -o "$1" | head -1 | grep -o " $2=[^ ]*" | head -1 | cut -d= -f2; }

has_ended() { case $(field "$1" JobState) in COMPLETED | FAILED | CANCELLED | TIMEOUT) ;; *) false ;; esac; }
has_run_twice() { [ "$(field "$1" Restarts)" -ge 1 ] && [ "$(field "$1" JobState)" = RUNNING ]; }
has_checkpoint() { compgen -G "runs/$1/checkpoints/*.state"; }

# Submits the job script of the documentation with less of everything.
submit() { sbatch --parsable --cpus-per-task=1 --mem=500M --time=30 "$@"; }

n_resumed() { grep -c '"resumed"' "runs/$1/log.jsonl" || true; }

inside() {
    cd /job
    . ./batch.sh
    begin_slurm
    echo "Slurm $(sinfo --version | cut -d' ' -f2), $(alewife --version)"
    case_file short.toml 2.0 "$accurate"
    case_file long.toml "${ALEWIFE_SLURM_END:-60.0}" "$accurate"
    case_file diverging.toml 2.0 '{ tolerance = 1e-9, smallest = 0.004 }'
    for name in a b d; do cp short.toml $name.toml; done
    for name in preempted killed limited unwarned cancelled; do cp long.toml $name.toml; done
    cp diverging.toml c.toml
    alewife run short.toml --out whole/short --threads 1 --quiet >/dev/null
    alewife run long.toml --out whole/long --threads 1 --quiet >/dev/null &
    local whole=$!
    array
    preemption
    the_rest
    wait $whole
    for name in preempted killed limited unwarned; do compare "$name: bits of the unbroken run" runs/$name whole/long; done
    tell_failures
}

array() {
    local job
    job=$(submit --array=0-3 job.sh a.toml b.toml c.toml d.toml)
    wait_for 120 array_has_ended "$job" || row "array: ends" 1
    local states
    states=$(for index in 0 1 2 3; do echo -n "$(field "${job}_$index" JobState) "; done)
    [ "$states" = "COMPLETED COMPLETED FAILED COMPLETED " ] && row "array: one of four diverges, the others end" 0 "$states" ||
        row "array: one of four diverges, the others end" 1 "$states"
    local code
    code=$(field "${job}_2" ExitCode)
    [ "$code" = 10:0 ] && row "array: its exit code is that of the program" 0 "$code" ||
        row "array: its exit code is that of the program" 1 "$code"
    for name in a b d; do compare "array, $name: bits of the unbroken run" runs/$name whole/short; done
}

array_has_ended() { for index in 0 1 2 3; do has_ended "$1_$index" || return 1; done; }

preemption() {
    local job urgent
    job=$(submit --partition=low job.sh preempted.toml)
    wait_for 60 has_checkpoint preempted || row "preemption: a first checkpoint" 1
    urgent=$(sbatch --parsable --partition=high --exclusive --wrap "sleep 5")
    wait_for 60 has_ended "$urgent" || row "preemption: the urgent job ends" 1
    wait_for 240 has_run_twice "$job" || row "preemption: starts again" 1 "$(field "$job" JobState)"
    wait_for 400 has_ended "$job" || row "preemption: ends" 1
    local told
    told="$(field "$job" JobState), $(field "$job" Restarts) restarts, resumed $(n_resumed preempted) times"
    [ "$(field "$job" JobState)" = COMPLETED ] && [ "$(n_resumed preempted)" -ge 1 ] && row "preempted: goes on and ends" 0 "$told" ||
        row "preempted: goes on and ends" 1 "$told"
}

# Jobs that do not disturb each other, side by side.
the_rest() {
    local killed limited unwarned cancelled told
    killed=$(submit job.sh killed.toml)
    limited=$(submit --time=1 --signal=USR1@30 job.sh limited.toml)
    # Without a signal before it, the end of the job is all there is
    sed '/--signal/d' job.sh >plain.sh
    unwarned=$(submit --time=1 plain.sh unwarned.toml)
    cancelled=$(submit job.sh cancelled.toml)
    for name in killed unwarned cancelled; do
        wait_for 60 has_checkpoint $name || row "$name: a first checkpoint" 1
    done

    kill -9 "$(grep -o '"pid": [0-9]*' runs/killed/status.json | cut -d' ' -f2)"
    wait_for 60 has_ended "$killed" || true
    told="$(field "$killed" JobState) $(field "$killed" ExitCode)"
    [ "$(field "$killed" JobState)" = FAILED ] && row "kill -9: the job fails" 0 "$told" || row "kill -9: the job fails" 1 "$told"
    killed=$(submit job.sh killed.toml)

    scancel "$cancelled"
    wait_for 60 has_ended "$cancelled" || true
    sleep 15
    told="$(field "$cancelled" JobState), $(field "$cancelled" Restarts) restarts, $(status_of cancelled)"
    [ "$(field "$cancelled" JobState)" = CANCELLED ] && [ "$(status_of cancelled)" = stopped ] &&
        row "scancel: stopped with a checkpoint, and stays so" 0 "$told" ||
        row "scancel: stopped with a checkpoint, and stays so" 1 "$told"

    wait_for 200 has_ended "$unwarned" || true
    told="$(field "$unwarned" JobState), $(status_of unwarned)"
    case $told in
    "TIMEOUT, stopped" | "COMPLETED, finished") row "time limit without a signal: leaves a checkpoint" 0 "$told" ;;
    *) row "time limit without a signal: leaves a checkpoint" 1 "$told" ;;
    esac
    unwarned=$(submit plain.sh unwarned.toml)
    for job in "$killed" "$unwarned" "$limited"; do wait_for 600 has_ended "$job" || row "job $job ends" 1; done
    told="$(field "$killed" JobState), resumed $(n_resumed killed) times"
    [ "$(field "$killed" JobState)" = COMPLETED ] && [ "$(n_resumed killed)" -ge 1 ] && row "killed: goes on and ends" 0 "$told" ||
        row "killed: goes on and ends" 1 "$told"
    told="$(field "$unwarned" JobState), resumed $(n_resumed unwarned) times"
    [ "$(field "$unwarned" JobState)" = COMPLETED ] && row "unwarned: goes on and ends" 0 "$told" ||
        row "unwarned: goes on and ends" 1 "$told"
    told="$(field "$limited" JobState), $(field "$limited" Restarts) restarts, resumed $(n_resumed limited) times"
    [ "$(field "$limited" JobState)" = COMPLETED ] && [ "$(field "$limited" Restarts)" -ge 1 ] &&
        row "time limit with USR1: back into the queue until it ends" 0 "$told" ||
        row "time limit with USR1: back into the queue until it ends" 1 "$told"
}

status_of() { grep -o '"state": "[a-z]*"' "runs/$1/status.json" | cut -d'"' -f4; }

if [ "${1:-}" = inside ]; then inside; else outside; fi
