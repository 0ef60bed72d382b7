# One row of test/results/cost.md: the drives of one campaign at one level, up to $last_seed if it is a number.
def median: map(select(. != null)) | sort | if length == 0 then null elif length % 2 == 1 then .[length / 2 | floor]
  else (.[length / 2 - 1] + .[length / 2]) / 2 end;
def mean: map(values) | if length > 0 then add / length else null end;
def shown(digits): if . == null then "-" else . * pow(10; digits) | round / pow(10; digits) | tostring end;
def percent($part; $all): if $all > 0 then 100 * $part / $all | shown(1) else "-" end;
map(select(.cell.level == $level and ($last_seed == null or .seed <= $last_seed))) as $rows | [$rows[] | select(.outcome == "goal_reached")] as $goals
| ([$rows[].duration_s // 0] | add // 0) as $time
| ["straight", "curve", "steering", "point_turn", "reverse", "waiting_for_plan", "hazard_stop"] as $causes
| [$causes[] as $c | [$rows[]["seconds.\($c)"] // 0] | add // 0] as $spent
| [$name, ($rows | length), ($goals | length),
   "\([$goals[].path_ratio] | median | shown(3)), \([$goals[].path_ratio] | max | shown(2))",
   ([$goals[].regret] | median | shown(3)), ([$rows[].progress] | median | shown(2)),
   "\([$rows[].hazard_stops] | mean | shown(1)), \([$rows[].false_stops] | mean | shown(1))",
   "\([$rows[]["map.hazards.area_ratio"]] | median | shown(2)), \([$rows[]["map.traversability.area_ratio"]] | median | shown(2))",
   ($spent[] | percent(.; $time)), percent($time - ($spent | add); $time)]
| "| \(map(tostring) | join(" | ")) |"
