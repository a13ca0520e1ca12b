# cluster.sh - a Slurm cluster of two nodes on this machine, for the test that sources it: munged, slurmctld and two slurmd
# in the folder $work, on ports of their own. All ends with the test, whatever happens.

# missing SENTENCE: skips the test, or fails where all tests are required.
missing() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}

# needs PACKAGE PROGRAM...
needs() {
    package=$1
    shift
    for program; do
        command -v "$program" >/dev/null 2>&1 || missing "$program (package $package) is not installed"
    done
}

# own_processes: runs the test again in a process namespace of its own, where that is allowed: when its first process ends,
# even by kill -9, the kernel ends the others.
own_processes() {
    [ -z "${FARM_TEST_INSIDE-}" ] || return 0
    export FARM_TEST_INSIDE=1
    if unshare --pid --fork --kill-child=KILL --mount --mount-proc true 2>/dev/null; then
        exec unshare --pid --fork --kill-child=KILL --mount --mount-proc "$@"
    fi
}

# processes PATTERN FILE: ids of the processes whose /proc entry FILE (cmdline, environ) matches.
processes() {
    for entry in /proc/[0-9]*; do
        if tr '\0' '\n' 2>/dev/null <"$entry/$2" | grep -q -- "$1"; then
            echo "${entry#/proc/}"
        fi
    done
}

# The settings differ from a real cluster's in that a lost node is noticed after 3 s, not 300, and a requeued element waits
# 6 s (cred_expire), not 120.
write_configuration() {
    host=$(uname -n)
    host=${host%%.*}
    port=$((20000 + $(od -An -N2 -tu2 /dev/urandom) % 20000))
    mkdir -p "$work/state" "$work/spool_n1" "$work/spool_n2" "$work/daemons"
    # slurmd opens the control groups even if nothing uses them, and they are absent in some containers
    mkdir -p "$work/cgroup"
    printf 'CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s\n' "$work/cgroup" >"$work/cgroup.conf"
    cat >"$work/slurm.conf" <<END
ClusterName=facet
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$work/munge.socket,cred_expire=5
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd_%n.pid
SlurmdSpoolDir=$work/spool_%n
StateSaveLocation=$work/state
SlurmctldLogFile=$work/daemons/slurmctld.log
SlurmdLogFile=$work/daemons/slurmd_%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1
SwitchType=switch/none
MpiDefault=none
MailProg=/bin/true
SlurmdTimeout=3
SlurmctldTimeout=3
KillWait=3
MessageTimeout=5
TCPTimeout=1
CompleteWait=0
ReturnToService=2
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
END
}

# wait_for SECONDS WHAT COMMAND...: until the command succeeds.
wait_for() {
    limit=$(($(date +%s) + $1))
    what=$2
    shift 2
    until "$@"; do
        if [ "$(date +%s)" -ge $limit ]; then
            echo "FAILED: $what"
            squeue -r 2>/dev/null || true
            tail -n 20 "$work"/daemons/*.log
            exit 1
        fi
        sleep 0.2
    done
}

nodes_are_idle() {
    [ "$(sinfo -h -t idle -o %D 2>/dev/null)" = 2 ]
}

cluster_start() {
    write_configuration
    export SLURM_CONF="$work/slurm.conf"
    (umask 077 && dd if=/dev/urandom of="$work/munge.key" bs=1 count=128 2>/dev/null)
    munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
        --log-file="$work/daemons/munged.log" --seed-file="$work/munge.seed" >/dev/null 2>&1 &
    daemons=$!
    wait_for 10 "munged did not start" test -S "$work/munge.socket"
    slurmctld -D -c >/dev/null 2>&1 &
    daemons="$daemons $!"
    for node in n1 n2; do
        slurmd -D -N $node >/dev/null 2>&1 &
        daemons="$daemons $!"
    done
    wait_for 30 "the nodes did not start" nodes_are_idle
}

# kill_node NAME: as a power failure: the daemon, its steps and their processes at once.
kill_node() {
    steps=
    for job in $(squeue -h -w "$1" -o %A); do
        steps="$steps $(processes "^slurmstepd: \\[$job\\." cmdline)"
    done
    kill -9 "$(cat "$work/slurmd_$1.pid")" $steps $(processes "^SLURMD_NODENAME=$1\$" environ) 2>/dev/null || true
}

cluster_stop() {
    [ -n "${daemons-}" ] || return 0
    kill -9 $daemons $(processes "^SLURM_CONF=$work/slurm.conf\$" environ | grep -vx $$) 2>/dev/null || true
    daemons=
}
