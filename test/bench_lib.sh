# Of several benches.

# The commit of the programs that a bench runs, with a hash of changes since; tables of results are no part of them.
program_commit() {
  local commit changes
  commit=$(git describe --always --abbrev=12)
  changes=$(git diff HEAD -- . ':(exclude)test/results')
  [ -z "$changes" ] || commit+="-dirty-$(sha1sum <<<"$changes" | cut -c1-8)"
  echo "$commit"
}

# FOLDER ARGS...: without --resume a campaign begins anew; rover_campaign refuses the folder of one that runs.
begin_campaign() {
  case " ${*:2} " in *" --resume "*) return ;; esac
  [ ! -e "$1/lock" ] || flock -n "$1/lock" rm -rf "$1" || true
}
