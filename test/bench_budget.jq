# Table of ./rover bench budget. Inputs: $e, $f, $t, the metrics.json of the drives at the Efficient and the Full level and
# in real time.
def r(n): if . == null then "-" else (. * pow(10; n) | round) / pow(10; n) | tostring end;
def ms: if . == 0 then "-" else r(1) end;  # 0: a service without a main step of its own
def services: .services | to_entries | map(select(.key != "recorder"));
def per_m(field): [services[].value[field] | values] | add;
$e[0] as $e | $f[0] as $f | $t[0] as $t
| "Seed traverse 2, seed 1, at the Efficient level with the services of the Full level on demand, and at the Full level; `default`",
"at the Full level in real time with a core loaded. Without simulator; sums without recorder.",
"",
"| | Efficient | Full | Full, real time |", "|---|---|---|---|",
"| drive | \($e.outcome), \($e.driven_length_m | r(1)) m in \($e.sim_s | r(0)) s | \($f.outcome), \($f.driven_length_m | r(1)) m in \($f.sim_s | r(0)) s | \($t.outcome), \($t.realtime_factor | r(2)) times real time |",
"| progress | \($e.progress | r(2)) | \($f.progress | r(2)) | \($t.progress | r(2)) |",
"| hazard stops | \($e.hazard_stops) | \($f.hazard_stops) | \($t.hazard_stops) |",
"| CPU s per metre | \($e | per_m("cpu_s_per_m_efficient") | r(2)) | \($f | per_m("cpu_s_per_m_full") | r(2)) | \($t | per_m("cpu_s_per_m_full") | r(2)) |",
"| CPU, part of a core in real time | \(100 * ([$e | services[].value.cpu_s] | add) / $e.sim_s | r(1)) % | \(100 * ([$f | services[].value.cpu_s] | add) / $f.sim_s | r(1)) % | \(100 * ([$t | services[].value.cpu_s] | add) / $t.sim_s | r(1)) % |",
"| memory of all services, largest [MB] | \([$e | services[].value.rss_mb] | add | r(0)) | \([$f | services[].value.rss_mb] | add | r(0)) | \([$t | services[].value.rss_mb] | add | r(0)) |",
"| messages per second | \($e.bus.messages / $e.sim_s | r(0)) | \($f.bus.messages / $f.sim_s | r(0)) | \($t.bus.messages / $t.sim_s | r(0)) |",
"| recorded bytes per second [MB/s] | \($e.bus.bytes / $e.sim_s / 1e6 | r(2)) | \($f.bus.bytes / $f.sim_s / 1e6 | r(2)) | \($t.bus.bytes / $t.sim_s / 1e6 | r(2)) |",
"| messages lost | \($e.bus.lost) | \($f.bus.lost) | \($t.bus.lost) |",
"",
"| service | CPU s per metre: Efficient | Full | memory [MB]: Efficient | Full | main step in real time [ms]: p50 | p99 |",
"|---|---|---|---|---|---|---|",
($f.services | to_entries | sort_by(-.value.cpu_s_per_m_full)[] | .key as $s
 | "| \($s) | \($e.services[$s].cpu_s_per_m_efficient | r(3)) | \(.value.cpu_s_per_m_full | r(3)) | \($e.services[$s].rss_mb | r(0)) | \(.value.rss_mb | r(0)) | \($t.services[$s].p50_ms | ms) | \($t.services[$s].p99_ms | ms) |")
