// Trends of the last two minutes, and the slope profile of a drawn path.
const Chart = window.Chart;
const WINDOW_S = 120;
const STEP_S = .5;
const clock = (t) => `${Math.floor(t / 60)}:${String(Math.round(t % 60)).padStart(2, "0")}`;
const deg = (rad) => (Number.isFinite(rad) ? (rad * 180) / Math.PI : NaN);

Chart.defaults.color = "#8696a8";
Chart.defaults.borderColor = "#222c37";
Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
Chart.defaults.font.size = 10;
Chart.defaults.animation = false;

const line = (label, color, axis = "y") => ({
  label, data: [], yAxisID: axis, borderColor: color, backgroundColor: color, borderWidth: 1.6, pointRadius: 0, tension: .2, spanGaps: false,
});
const axis = (extra) => ({ grid: { drawTicks: false }, ticks: { maxTicksLimit: 5, padding: 4 }, ...extra });

function chart(id, datasets, scales) {
  return new Chart(document.getElementById(id), {
    type: "line",
    data: { datasets },
    options: {
      responsive: true, maintainAspectRatio: false, parsing: false, normalized: true, interaction: { mode: "index", intersect: false },
      plugins: { legend: { align: "end", labels: { boxWidth: 14, boxHeight: 2, padding: 8 } }, tooltip: { enabled: false } },
      scales: { x: axis({ type: "linear", ticks: { includeBounds: false, stepSize: 30, padding: 4, maxRotation: 0, callback: (t) => clock(t) } }), ...scales },
    },
  });
}

export function createCharts(setup) {
  const v = setup.vehicle.top_speed_mps;
  const speed = chart("trend-speed", [line("speed m/s", "#ffb454"), line("slip", "#5cc8ff", "slip")], {
    y: axis({ suggestedMin: 0, suggestedMax: 1.25 * v }), slip: axis({ position: "right", min: -1, max: 1, grid: { display: false } }),
  });
  const tilt = chart("trend-tilt", [line("roll °", "#9de9c3"), line("pitch °", "#e48bff")], { y: axis({ suggestedMin: -6, suggestedMax: 6 }) });
  let profile = null;
  let newest = -Infinity;

  function push(graph, t, values, draw = true) {
    graph.data.datasets.forEach((set, i) => {
      set.data.push({ x: t, y: values[i] });
      while (set.data.length && set.data[0].x < t - WINDOW_S) set.data.shift();
    });
    graph.options.scales.x.min = Math.max(0, t - WINDOW_S);
    graph.options.scales.x.max = Math.max(t, 10);
    if (draw) graph.update("none");
  }

  return {
    // One row per second: time, speed, slip, roll, pitch.
    setTrend(rows) {
      for (const graph of [speed, tilt]) for (const set of graph.data.datasets) set.data = [];
      const y = (value) => value ?? NaN;
      for (const [t, v_, slip, roll, pitch] of rows) {
        push(speed, t, [y(v_), y(slip)], false);
        push(tilt, t, [deg(roll), deg(pitch)], false);
        newest = t;
      }
      for (const graph of [speed, tilt]) graph.update("none");
    },
    show(view) {
      if (!Number.isFinite(view.t_s) || Math.abs(view.t_s - newest) < STEP_S) return;
      if (view.t_s < newest) for (const graph of [speed, tilt]) for (const set of graph.data.datasets) set.data = [];
      newest = view.t_s;
      push(speed, view.t_s, [view.pose.speed_mps ?? NaN, view.motion.slip ?? NaN]);
      push(tilt, view.t_s, [deg(view.pose.roll), deg(view.pose.pitch)]);
    },
    // Null shows the trends again.
    showProfile(check) {
      for (const id of ["trend-speed-box", "trend-tilt-box"]) document.getElementById(id).hidden = check !== null;
      document.getElementById("profile-box").hidden = check === null;
      if (check === null) return;
      profile ??= chart("profile", [line("slope °", "#5cc8ff"), line("limit", "#f0616d"), line("warning", "#f2b84b")], { y: axis({ min: 0, suggestedMax: 1.2 * setup.path.max_slope_deg }) });
      const end = check.distance_m.at(-1) ?? 1;
      const level = (y) => [{ x: 0, y }, { x: end, y }];
      profile.data.datasets[0].data = check.distance_m.map((x, i) => ({ x, y: check.slope_deg[i] }));
      profile.data.datasets[1].data = level(setup.path.max_slope_deg);
      profile.data.datasets[2].data = level(setup.path.steep_slope_deg);
      profile.options.scales.x.max = end;
      Object.assign(profile.options.scales.x.ticks, { stepSize: undefined, maxTicksLimit: 8, callback: (d) => `${+d.toFixed(1)} m` });
      profile.update("none");
    },
  };
}
