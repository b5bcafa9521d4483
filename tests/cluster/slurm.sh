#!/usr/bin/env bash
# A study under a real Slurm: one node on loopback, started here and ended here.
#
#   tests/cluster/slurm.sh PROGRAM
#
# A shard's process is killed, the node is lost for ten seconds, and a job array is cancelled and submitted again; each
# time the merged results have to be those of `mbint run`, byte for byte. Needs Debian's slurm-wlm and munge, and root.
# Takes about a minute.
set -euo pipefail

program=$(realpath "$1")
place=$(mktemp -d /tmp/mbint-slurm.XXXXXX)
host=$(hostname -s)

finish() {
    local status=$?
    [ $status -eq 0 ] || { tail -n 30 "$place"/*.log "$place"/*/logs/*.log 2>/dev/null || true; }
    for daemon in slurmd slurmctld munged; do
        [ ! -s "$place/$daemon.pid" ] || kill "$(cat "$place/$daemon.pid")" 2>/dev/null || true
    done
    wait 2>/dev/null || true
    sleep 1
    rm -rf "$place"
    exit $status
}
trap finish EXIT

# within SECONDS COMMAND...: waits until the command succeeds.
within() {
    local end=$((SECONDS + $1))
    shift
    until "$@" >/dev/null 2>&1; do
        [ $SECONDS -lt $end ] || { echo "error: not in time: $*" >&2; return 1; }
        sleep 0.2
    done
}

start_slurm() {
    mkdir -p "$place/state" "$place/spool"
    # munge refuses folders that others may write to.
    mkdir -m 755 "$place/munge"
    chmod 755 "$place"
    head -c 1024 /dev/urandom >"$place/munge/key"
    chmod 400 "$place/munge/key"
    munged --key-file="$place/munge/key" --socket="$place/munge/socket" --pid-file="$place/munged.pid" \
        --log-file="$place/munged.log" --seed-file="$place/munge/seed" --force
    cat >"$place/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
# A requeued job waits until its credential expires: two minutes, unless something else is said.
AuthInfo=socket=$place/munge/socket,cred_expire=5
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmctldPort=16817
SlurmdPort=16818
SlurmctldPidFile=$place/slurmctld.pid
SlurmdPidFile=$place/slurmd.pid
SlurmctldLogFile=$place/slurmctld.log
SlurmdLogFile=$place/slurmd.log
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool
SlurmdTimeout=4
MinJobAge=60
SchedulerParameters=batch_sched_delay=0,sched_interval=1,requeue_setup_env_fail
BatchStartTimeout=4
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF="$place/slurm.conf"
    slurmctld
    slurmd
    within 60 node_is_idle
}

node_is_idle() { sinfo --noheader --format=%T | grep -qx idle; }
queue_is_empty() { [ -z "$(squeue --noheader)" ]; }
is_merged() { queue_is_empty && [ -s "$1/summary.json" ]; }

# A pendulum in air: some shards of a second or two.
model() {
    cat >"$place/pendulum.yaml" <<'YAML'
model: pendulum
parameters:
  length: { value: 1, unit: m, tolerance: 1% }
  mass: { value: 1, unit: kg, tolerance: 2% }
  damping: { value: 0.1, unit: N*s/m, tolerance: 10% }
bodies: { bob: { mass: mass, inertia: 0.01, points: { pivot: [0, length] } } }
joints: { hinge: { revolute: { between: [ground, bob.pivot] } } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  air: { drag: { on: bob, linear: damping } }
initial: { bob.angle: 1 }
outputs: { angle: bob.angle }
simulation: { duration: 2 s, step: 1e-3, output_step: 0.05 }
bounds: { scan: { points: 40 }, chebyshev: { order: 3 } }
YAML
}

plan() {
    "$program" plan "$place/pendulum.yaml" -o "$place/$1" --at-once 0.5 --shard-seconds 0.5
}

submit() {
    "$program" submit "$place/$1" --slurm --output "$place/$1/results" -- --cpus-per-task=1
}

same() {
    diff -r "$place/direct" "$place/$1/results"
    echo "ok: $1"
}

# The process of a shard of this study, where one runs. Paths of this test occur in no other command.
shard_of() { pgrep -o -f "mbint shard $place/$1 "; }
a_shard_runs() { shard_of "$1" >/dev/null; }

# Slurm's own process above a shard, and all in between.
lose_processes_of() {
    local process name
    process=$(shard_of "$1") || return 0
    while [ "${process:-1}" -gt 1 ]; do
        name=$(ps -o comm= -p "$process") || return 0
        set -- "$1" "${@:2}" "$process"
        [ "$name" != slurmstepd ] || break
        # It may have ended meanwhile.
        process=$(ps -o ppid= -p "$process" | tr -d ' ') || return 0
    done
    kill -KILL "${@:2}" || true
}

start_slurm
model
"$program" run "$place/pendulum.yaml" -o "$place/direct" --quiet --yes

plan plain
submit plain
within 120 is_merged "$place/plain/results"
same plain

# A folder whose name a shell and Slurm would read.
plan "it's 100 %j"
submit "it's 100 %j"
within 120 is_merged "$place/it's 100 %j/results"
ls "$place/it's 100 %j"/logs/round-1-merge-*.log >/dev/null
same "it's 100 %j"

# A task's process is killed: it is requeued.
plan killed
submit killed
within 60 a_shard_runs killed
kill -KILL "$(shard_of killed)"
within 120 is_merged "$place/killed/results"
grep -q Killed "$place"/killed/logs/*
same killed

# The node is lost for ten seconds, with what runs on it.
plan lost
submit lost
within 60 a_shard_runs lost
kill -KILL "$(cat "$place/slurmd.pid")"
while a_shard_runs lost; do lose_processes_of lost; done
sleep 10
slurmd
within 180 is_merged "$place/lost/results"
same lost

# The array and its merging are cancelled, and submitted again.
plan cancelled
submit cancelled
within 60 a_shard_runs cancelled
scancel --user=root
within 60 queue_is_empty
[ ! -e "$place/cancelled/results/summary.json" ]
submit cancelled
within 120 is_merged "$place/cancelled/results"
same cancelled
