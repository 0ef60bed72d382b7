# Table of ./rover bench full. Input: an array of metrics.json with commit, level and exit_status.
def r(n): if . == null then "-" else (. * pow(10; n) | round) / pow(10; n) | tostring end;
def sum(f): map(f // 0) | add // 0;
def yes(c): if c then "yes" else "**no**" end;
def is(s; l): map(select(.scenario == s and .level == l));
def reached: map(select(.outcome == "goal_reached")) | length;
def lowest(f): [.[] | f | values] | min;
def highest(f): [.[] | f | values] | max;
def requirement(what; measured; met): "| \(what) | \(measured) | \(yes(met)) |";
def levels_used: .levels.EFFICIENT.travelled_m > 1 and .levels.FULL.travelled_m > 1;
def explained: all(.level_switches[]; (.reason // "") != "");
def per_100_m: if sum(.driven_length_m) > 0 then 100 * sum(.hazard_stops) / sum(.driven_length_m) else null end;
def growth: [.services | to_entries[] | {name: .key, mb: (.value.rss_mb - .value.rss_first_half_mb), ok: (.value.rss_mb <= ([1.05 * .value.rss_first_half_mb, .value.rss_first_half_mb + 2] | max))}] | (max_by(.mb) // {}) + {ok: (length > 0 and all(.ok))};
def by_cause: [.[] | .seconds // {} | to_entries[]] | group_by(.key) | map({name: (.[0].key | gsub("_"; " ")), s: (map(.value) | add)}) | (map(.s) | add // 0) as $all
  | if $all > 0 then map(select(.s >= 0.0005 * $all)) | sort_by(-.s) | map("\(.name) \(100 * .s / $all | r(1))") | join(", ") else "-" end;
def corrections: [.global_corrections[] | select(.accepted)];

is("full_hard"; "auto") as $full | is("full_hard"; "efficient") as $plain | is("combined_500"; "auto") as $long
| is("long_drift"; "full") as $drift | ($drift + $long) as $fixed
| [$full[].seed] as $seeds | ($plain | map(select(.seed as $s | $seeds | index($s) != null))) as $same
| "| requirement | measured | met |", "|---|---|---|",
requirement("`full_hard`: every seed reaches its goal"; "\($full | reached) of \($full | length)"; ($full | length) > 0 and ($full | reached) == ($full | length)),
requirement("no collision"; "\($full | sum(.collisions))"; ($full | length) > 0 and ($full | sum(.collisions)) == 0),
requirement("hazard stops at most a quarter of those of the Efficient level alone on the same seeds"; "\($full | sum(.hazard_stops)) against \($same | sum(.hazard_stops))"; ($full | length) > 0 and ($same | length) == ($full | length) and 4 * ($full | sum(.hazard_stops)) <= ($same | sum(.hazard_stops))),
requirement("duty at least 0.75"; "minimum \($full | lowest(.duty) | r(2))"; ($full | lowest(.duty) // 0) >= 0.75),
requirement("`combined_500`: both seeds reach the goal"; "\($long | reached) of \($long | length)"; ($long | reached) == 2),
requirement("no collision"; "\($long | sum(.collisions))"; ($long | length) == 2 and ($long | sum(.collisions)) == 0),
requirement("true error after the first correction at most 1 m"; "maximum \($long | highest(.corrected_error_max_m) | r(2)) m"; ($long | length) == 2 and ($long | map(.corrected_error_max_m // 9) | max) <= 1),
requirement("both levels used, each switch explained"; "\($long | map(select(levels_used and explained)) | length) of \($long | length)"; ($long | length) == 2 and ($long | all(levels_used and explained))),
requirement("duty at least 0.75"; "minimum \($long | lowest(.duty) | r(2))"; ($long | lowest(.duty) // 0) >= 0.75),
requirement("at least 1.5 times real time"; "minimum \($long | lowest(.realtime_factor) | r(2))"; ($long | lowest(.realtime_factor) // 0) >= 1.5),
requirement("error after each correction in `long_drift` and `combined_500` below one cell of the orbital map (1 m)"; "\($fixed | map(corrections | length) | add // 0) corrections, estimate at most \([$fixed[] | corrections[].after_m] | max | r(2)) m off, correction itself \([$fixed[] | corrections[].correction_error_m] | max | r(2)) m"; ($fixed | map(corrections | length) | add // 0) > 0 and ([$fixed[] | corrections[] | .after_m, .correction_error_m] | max) < 1),
requirement("memory of each service constant over `combined_500`: at most 5 % or 2 MB above the maximum of the first half of the drive"; "maximum growth \($long | highest(growth.mb) | r(1)) MB (\($long | map(growth) | max_by(.mb) | .name // "-"))"; ($long | length) == 2 and ($long | all(growth.ok))),
"",
"Efficient alone reaches \($same | reached) of \($same | length) goals of `full_hard`\(if ($same | reached) < ($same | length) then ", so its stops are those until it failed" else "" end). Hazard stops per 100 m driven: \($full | per_100_m | r(1)) at the Full level, \($same | per_100_m | r(1)) at the Efficient one.",
"",
"Progress (planned length, or its part made good, over top speed x time) at the Full level of `full_hard`: \($full | lowest(.progress) | r(2)) to \($full | highest(.progress) | r(2)); of `combined_500` at least \($long | lowest(.progress) | r(2)). Time by cause [%], `full_hard`: \($full | by_cause); `combined_500`: \($long | by_cause).",
"",
"Azkarate et al. 2020: SLAM drift 0.8 %, correction to less than one cell of a map of 0.5 m; 16 repairs on 148.2 m at the Efficient level. Both levels combined were proposed there, not driven.",
"",
"| scenario | level | seed | outcome | driven / planned [m] | oracle [m], regret | time [s] | progress | duty | time by cause [%] | hazard stops | repairs, plans | collisions | minimum clearance [m] | true distance to goal [m] | drift: odometry, SLAM [%] | error: maximum, after a correction [m] | corrections accepted / tried | switches | times real time |",
"|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|",
(sort_by(.scenario, .level, .seed)[] | "| \(.scenario) | \(.level) | \(.seed) | \(.outcome) | \(.driven_length_m | r(1)) / \(.planned_length_m | r(1)) | \(.oracle_m | r(1)), \(.regret | r(2)) | \(.duration_s | r(0)) | \(.progress | r(2)) | \(.duty | r(2)) | \([.] | by_cause) | \(.hazard_stops) | \(.replans) | \(.collisions) | \(.min_clearance_m | r(2)) | \(.final_error_m | r(2)) | \(.odometry_drift_percent | r(2)), \(.slam_drift_percent | r(2)) | \(.estimate_error_max_m | r(2)), \(.corrected_error_max_m | r(2)) | \(corrections | length) / \(.global_corrections | length) | \(.level_switches | length) | \(.realtime_factor | r(2)) |"),
"",
"CPU seconds per metre of each service at each level, mean over all runs:",
"",
"| service | Efficient | Full | memory over `combined_500`: first half, whole [MB] |", "|---|---|---|---|",
(def mean(f): [.[] | f | values] | if length == 0 then null else add / length end;
 . as $rows | ($rows | map(.services | keys) | add // [] | unique)[] | . as $name
 | "| \($name) | \($rows | mean(.services[$name].cpu_s_per_m_efficient) | r(3)) | \($rows | mean(.services[$name].cpu_s_per_m_full) | r(3)) | \($long | highest(.services[$name].rss_first_half_mb) | r(1)), \($long | highest(.services[$name].rss_mb) | r(1)) |"),
"",
"Reasons of the level changes:",
"",
"| scenario | seed | at [m] | to | reason |", "|---|---|---|---|---|",
(sort_by(.scenario, .level, .seed)[] | . as $run | .level_switches[] | "| \($run.scenario) | \($run.seed) | \(.at_m | r(1)) | \(.to) | \(.reason)\(if .quantity then ": \(.quantity) \(.value | r(2)), threshold \(.threshold | r(2))" else "" end) |")
