#!/usr/bin/env bash
# A campaign on a real Slurm of this test's own: killed in the middle and resumed, its rows are those of GNU parallel.
. "$(dirname "$0")/lib.sh"
for program in munged slurmctld slurmd sbatch; do
  command -v $program >/dev/null || { echo "no $program: install slurm-wlm and munge"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "slurmd requires root"; exit 77; }

mkdir -p "$WORK"/slurm/{state,spool,munge}
chmod 711 "$WORK" "$WORK/slurm" "$WORK/slurm/munge"
head -c 128 /dev/urandom >"$WORK/slurm/munge/key"
chmod 400 "$WORK/slurm/munge/key"
export SLURM_CONF=$WORK/slurm/slurm.conf
# Arrays of five: the campaign takes several.
cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$PORT
SlurmdPort=$((PORT + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$WORK/slurm/munge/socket
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_interval=2
StateSaveLocation=$WORK/slurm/state
SlurmdSpoolDir=$WORK/slurm/spool
SlurmctldPidFile=$WORK/slurm/slurmctld.pid
SlurmdPidFile=$WORK/slurm/slurmd.pid
SlurmctldLogFile=$WORK/slurm/slurmctld.log
SlurmdLogFile=$WORK/slurm/slurmd.log
MaxArraySize=5
KillWait=5
ReturnToService=2
NodeName=localhost NodeAddr=127.0.0.1 CPUs=8
PartitionName=test Nodes=localhost Default=YES MaxTime=10 State=UP
CONF

stop_slurm() {
  local pid
  for pid in ${slurmd:-} ${slurmctld:-} ${munged:-}; do kill $pid 2>/dev/null || true; done
}
trap 'stop_slurm; cleanup' EXIT
munged --foreground --key-file="$WORK/slurm/munge/key" --socket="$WORK/slurm/munge/socket" --num-threads=2 \
  --pid-file="$WORK/slurm/munge/pid" --log-file="$WORK/slurm/munge/log" --seed-file="$WORK/slurm/munge/seed" &
munged=$!
wait_until "munged listens" test -S "$WORK/slurm/munge/socket"
slurmctld -D &>"$WORK/slurm/slurmctld.out" &
slurmctld=$!
slurmd -D -N localhost &>"$WORK/slurm/slurmd.out" &
slurmd=$!
is_idle() { [ "$(sinfo --noheader --format %T 2>/dev/null)" = idle ]; }
wait_until "the node is idle: $(tail -3 "$WORK"/slurm/slurm*.log 2>/dev/null)" is_idle

campaign_file "$WORK/c.yaml" 1..6
campaign "$WORK/c.yaml" --jobs 4 --out "$WORK/parallel" >/dev/null

# One worker is killed in the middle, then the campaign; its jobs in the queue are cancelled by the next one.
echo 3 >"$FAKE_DRIVE/seconds"
begin "$WORK/c.yaml" --engine slurm --out "$WORK/slurm_rows" >"$WORK/out" 2>&1
wait_until "4 rows: $(cat "$WORK/out")" has_rows "$WORK/slurm_rows" 4
workers() { workers_in "bin/rover_campaign job --dir $WORK/slurm_rows"; }
wait_until "a worker runs" eval '[ -n "$(workers)" ]'
kill -9 "$(workers | head -1)"
sleep 1
kill -9 $pid
wait $pid 2>/dev/null || true
[ "$(rows "$WORK/slurm_rows")" -lt 12 ] || fail "the campaign was over before it was killed"
[ -n "$(squeue --noheader)" ] || fail "no job is left in the queue"
[ "$(squeue --noheader --format %C | sort -u)" = 2 ] || fail "cores of a rendered drive: $(squeue --noheader --format %C)"
echo 0.5 >"$FAKE_DRIVE/seconds"
campaign "$WORK/c.yaml" --engine slurm --out "$WORK/slurm_rows" --resume >"$WORK/out" 2>&1 || fail "resume: $(cat "$WORK/out")"
cmp "$WORK/parallel/rows.jsonl" "$WORK/slurm_rows/rows.jsonl" || fail "rows of Slurm and GNU parallel differ"

# A worker that is killed is a drive that died: its second attempt makes the row.
echo 2 >"$FAKE_DRIVE/seconds"
begin "$WORK/c.yaml" --engine slurm --jobs 2 --out "$WORK/again" >"$WORK/out" 2>&1
killed_one() { kill -9 "$(workers_in "bin/rover_campaign job --dir $WORK/again" | head -1)" 2>/dev/null; }
wait_until "a worker is killed" killed_one
wait $pid || fail "a killed worker ends the campaign: $(cat "$WORK/out")"
[ "$(jq -s 'map(.attempts) | add' "$WORK/again/rows.jsonl")" = 13 ] || fail "a killed worker's drive was not repeated"
[ "$(jq -cS 'del(.attempts)' "$WORK/again/rows.jsonl")" = "$(jq -cS 'del(.attempts)' "$WORK/parallel/rows.jsonl")" ] ||
  fail "rows after a killed worker differ"

# SIGTERM cancels what is in the queue.
begin "$WORK/c.yaml" --engine slurm --out "$WORK/stopped" >"$WORK/out" 2>&1
wait_until "jobs are queued" eval '[ -n "$(squeue --noheader)" ]'
kill -TERM $pid
status=0
wait $pid || status=$?
[ $status = 1 ] || fail "stopped: exit status $status: $(cat "$WORK/out")"
[ -z "$(squeue --noheader)" ] || fail "jobs stay in the queue"
echo "Slurm: rows are those of GNU parallel"
