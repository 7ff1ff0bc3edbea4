#!/bin/sh
# farm_slurm.sh: Slurm renders a film on this machine, while tasks and a daemon are killed, and its frames are those of one render.
# shellcheck source-path=SCRIPTDIR disable=SC2086
. "$(dirname "$0")/common.sh"
plan 6
PATH=$PATH:/usr/sbin:/sbin
for program in slurmctld slurmd munged sbatch; do
    command -v $program >/dev/null && [ "$(id -u)" -eq 0 ] && continue
    for what in "a film" "killed tasks" "frames" "a checkpoint" "going on" "cancelling"; do skip "Slurm: $what" "Slurm is not installed, or this user cannot start it"; done
    exit 0
done

# ---- Slurm, with a controller and a daemon of its own ----

host=$(hostname -s)
mkdir -p slurm/state slurm/spool slurm/munge
chmod 755 "$work" slurm
chmod 700 slurm/munge
head -c 32 /dev/urandom >slurm/munge/key
chmod 400 slurm/munge/key
port=$((20000 + $$ % 20000))
cat >slurm/slurm.conf <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/slurm/munge/socket
StateSaveLocation=$work/slurm/state
SlurmdSpoolDir=$work/slurm/spool
SlurmctldPidFile=$work/slurm/controller.pid
SlurmdPidFile=$work/slurm/daemon.pid
SlurmctldLogFile=$work/slurm/controller.log
SlurmdLogFile=$work/slurm/daemon.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
MpiDefault=none
SlurmdTimeout=10
NodeName=$host NodeAddr=127.0.0.1 CPUs=3 State=UNKNOWN
PartitionName=short Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF="$work/slurm/slurm.conf"
stop() {
    scancel --state=PENDING --state=RUNNING -u root 2>/dev/null
    for pid in slurm/daemon.pid slurm/controller.pid slurm/munge/pid; do
        kill "$(cat "$work/$pid")" 2>/dev/null
    done
    rm -rf "$work"
}
trap stop EXIT
munged --force --key-file="$work/slurm/munge/key" --socket="$work/slurm/munge/socket" --pid-file="$work/slurm/munge/pid" \
    --log-file="$work/slurm/munge/log" --seed-file="$work/slurm/munge/seed" 2>slurm/said
slurmctld
slurmd -N "$host"

# Waits until nothing is queued, for two minutes of it at most.
wait_for_slurm() {
    tries=0
    while [ -n "$(squeue -h 2>&1)" ] && [ $tries -lt 1200 ]; do
        tries=$((tries + 1))
        sleep 0.1
        "$@"
    done
}

# ---- the film ----

export XDG_CACHE_HOME="$work/caches"
cat >ball.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }
show sphere(0.6).move([0, 0.6 + 0.3 * sin(9 * time), 0]).paint(#ffcc66);
show plane([0, 1, 0], 0).paint(#888888);
END
how="--frames 0..9 --size 62x46 --samples 6 --rays kernels --integrator path"
run render ball.krs $how --quiet -o 'one-%d.exr'
run farm submit ball.krs $how --tiles 2x1 --slurm short -o 'film-%d.exr'
ended 0 "a film is submitted to Slurm"

# Kills the render of some pieces, and the daemon once.
killed=0
disturb() {
    [ $((tries % 7)) -eq 0 ] && [ $killed -lt 6 ] && pkill -9 -n -f "ball.farm/scene.krsz.*--crop" && killed=$((killed + 1))
    if [ $tries -eq 30 ]; then
        kill -9 "$(cat slurm/daemon.pid)"
        sleep 0.5
        slurmd -N "$host"
    fi
    # Slurm lets two minutes pass before it runs tasks of a daemon that was lost again.
    [ $((tries % 20)) -eq 0 ] && squeue -h -t PENDING -r -o '%i %r' | while read -r task reason; do
        [ "$reason" = BeginTime ] && scontrol update "JobId=$task" StartTime=now
    done
}
wait_for_slurm disturb
echo "$killed killed" >out
squeue >>out
tail -n 5 slurm/*.log >>out 2>/dev/null
[ $killed -gt 0 ] && [ -z "$(squeue -h)" ]
result $? "all tasks end, though some are killed"
same=0
for frame in 0 1 2 3 4 5 6 7 8 9; do
    cmp -s film-$frame.exr one-$frame.exr && same=$((same + 1))
done
"$krs" farm status ball.farm >out 2>err
[ $same -eq 10 ]
result $? "frames are those of one render"

# A task that is told that its time is over.
long="--size 96x64 --samples 1500 --rays kernels --integrator path"
export KRS_TEST_CHECKPOINT=0.1
run farm submit ball.krs $long --slurm short --job long.farm -o long.exr
task="$(head -n 1 long.farm/slurm.jobs)_0" tries=0
until [ -e long.farm/parts/0-000000.exr.part ] || [ $tries -gt 600 ]; do
    tries=$((tries + 1))
    sleep 0.1
done
scancel --batch --signal=USR1 "$task"
again() {
    scontrol show job "$task" >again 2>&1
    ! grep -q 'Reason=BeginTime' again || scontrol update "JobId=$task" StartTime=now
}
wait_for_slurm again
scontrol show job "$task" >out
grep -q 'Restarts=[1-9]' out
result $? "a task whose time is over leaves a checkpoint, and is queued again"
run render ball.krs $long --quiet -o one.exr
cmp -s one.exr long.exr
result $? "it goes on to the same picture"

run farm submit ball.krs $how --slurm short --job many.farm -o 'more-%d.exr'
run farm cancel many.farm
wait_for_slurm true
[ "$status" -eq 0 ] && [ -z "$(squeue -h)" ] && [ ! -e more-9.exr ]
result $? "what is cancelled leaves the queue"
