# Sourced by the tests of campaigns: a campaign of fake drives.
. "$(dirname "${BASH_SOURCE[0]}")/../integration/lib.sh"
export FAKE_DRIVE=$WORK/fake
mkdir -p "$FAKE_DRIVE"
echo 0.1 >"$FAKE_DRIVE/seconds"

# campaign_file FILE SEEDS: two cells.
campaign_file() {
  printf 'scenario: %s\nseeds: %s\naxes: {rock_area: [0.05, 0.1]}\n' "$SOURCE/config/scenarios/flat.yaml" "$2" >"$1"
}
# begin ARGUMENTS...: in the background, with its process id in $pid.
begin() {
  "$BUILD/bin/rover_campaign" --drive-program "$SOURCE/test/campaign/fake_drive.sh" "$@" &
  pid=$!
}
campaign() { "$BUILD/bin/rover_campaign" --drive-program "$SOURCE/test/campaign/fake_drive.sh" "$@"; }
# Rows in the store; read only, because sqlite3 would make a file in a folder that has none yet.
rows() { sqlite3 -readonly -cmd '.timeout 5000' "$1/campaign.sqlite" 'SELECT count(*) FROM rows' 2>/dev/null || echo 0; }
# wait_until WHAT COMMAND...
wait_until() {
  local what=$1 i
  shift
  for ((i = 0; i < 300; i++)); do
    "$@" && return
    sleep 0.1
  done
  fail "not within 30 s: $what"
}
has_rows() { [ "$(rows "$1")" -ge "$2" ]; }
# Processes that work in a folder; $$ is this script.
workers_in() { pgrep -f -- "$1" | grep -vx -e "$$" -e "$BASHPID" || true; }
no_workers_in() { [ -z "$(workers_in "$1/work-")" ]; }
# said NAME PATTERN [FILE]: the command said one line on its error output, which is in FILE.
said() {
  local file=${3:-$WORK/said}
  [ "$(wc -l <"$file")" = 1 ] || fail "$1: not one line: $(cat "$file")"
  grep -qE -- "$2" "$file" || fail "$1: said: $(cat "$file")"
}
# refused STATUS NAME PATTERN ARGUMENTS...
refused() {
  local expected=$1 name=$2 pattern=$3 status=0
  shift 3
  campaign "$@" >"$WORK/out" 2>"$WORK/said" || status=$?
  [ $status = "$expected" ] || fail "$name: exit status $status: $(cat "$WORK/out" "$WORK/said")"
  said "$name" "$pattern"
}
