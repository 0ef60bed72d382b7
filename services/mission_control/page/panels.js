// Panels: situation, limits, services, Full level, events.
const byId = (id) => document.getElementById(id);
const fixed = (value, digits, unit = "") => (Number.isFinite(value) ? value.toFixed(digits) + unit : "–");
const deg = (rad) => (rad * 180) / Math.PI;
const element = (tag, className, text) => {
  const e = document.createElement(tag);
  if (className) e.className = className;
  if (text !== undefined) e.textContent = text;
  return e;
};
const TONE = {
  DRIVING: "good", TELEOP: "good", GOAL_REACHED: "good", REPAIRING: "warn", HAZARD_STOP: "warn", PAUSED: "warn", SWEEPING: "warn",
  FAULT_STOP: "bad", SAFE: "bad",
};
const MANY_SERVICES = 13;
const WHEELS = ["FL", "FR", "ML", "MR", "RL", "RR"];
const SLAM = ["ok", "unobservable", "lost"];
const direction = (pan) => (Math.abs(pan) < .5 ? "ahead" : `${Math.abs(pan).toFixed(0)}° ${pan > 0 ? "left" : "right"}`);
const stale = (age_s) => age_s > 2;  // message time
const RED_HOLD_MS = 1500;  // minimum time that a lost service is shown red

function clock(t_s) {
  if (!Number.isFinite(t_s)) return "–";
  const m = Math.floor(t_s / 60), s = Math.floor(t_s % 60);
  return `${m}:${String(s).padStart(2, "0")}`;
}
const words = (name) => name.replaceAll("_", " ");

function createGauge(box, name, limits, unit, digits) {
  const root = element("div", "gauge none");
  const scale = element("div", "scale");
  const fill = element("div", "fill");
  const value = element("span", "value");
  const top = Number.isFinite(limits.limit) ? limits.limit * 1.15 : 1;
  scale.append(fill);
  for (const kind of ["warn", "limit"]) {
    if (!Number.isFinite(limits[kind])) continue;
    const tick = element("div", `tick ${kind}`);
    tick.style.left = `${(100 * limits[kind]) / top}%`;
    tick.title = `${kind === "warn" ? "warning" : "limit"} ${limits[kind]}${unit}`;
    scale.append(tick);
  }
  root.append(element("span", "name", name), scale, value);
  box.append(root);
  return (x) => {
    const known = Number.isFinite(x), size = Math.abs(x);
    fill.style.width = known ? `${Math.min(100, (100 * size) / top)}%` : "0";
    value.textContent = known ? `${x.toFixed(digits)}${unit}` : "–";
    const tone = !known ? "none" : size > limits.limit ? "bad" : Number.isFinite(limits.warn) && size > limits.warn ? "warn" : "";
    root.className = `gauge ${tone}`;
  };
}

export function createPanels(setup, commands) {
  const g = setup.gauges, gauges = byId("gauges");
  const slip = createGauge(gauges, "slip", g.slip, "", 2);
  const roll = createGauge(gauges, "roll", g.roll_deg, "°", 1);
  const pitch = createGauge(gauges, "pitch", g.pitch_deg, "°", 1);
  const currents = WHEELS.map((name) => createGauge(gauges, `motor ${name}`, g.current_a, " A", 1));
  const rows = new Map();
  const redUntil = new Map();
  document.querySelector("th.inject").hidden = !setup.injection;

  function situation(view) {
    const s = view.state, pose = stale(view.pose.age_s) ? {} : view.pose, state = byId("state");
    state.textContent = !s.name ? "waiting" : stale(s.age_s) ? `no state for ${clock(s.age_s)}` : words(s.name);
    state.className = `chip state ${stale(s.age_s) ? "bad" : TONE[s.name] || ""}`;
    byId("level").textContent = s.level ? words(s.level) + (view.book.forced ? " · forced" : "") : "–";
    byId("permit").textContent = view.permit.granted ? `permit ${fixed(view.permit.max_speed_mps, 2)} m/s` : "no permit";
    byId("time").textContent = Number.isFinite(view.t_s)
      ? `${clock(view.t_s)}${Number.isFinite(view.rate) ? ` · ×${view.rate.toFixed(1)}` : ""}` : "–";
    const reason = byId("reason");
    reason.replaceChildren();
    if (s.name) {
      reason.append(element("b", "", words(s.cause || "")), ` ${clock(s.since_s)} ago`);
      if (s.quantity && Number.isFinite(s.value)) {
        const limit = Number.isFinite(s.threshold) ? `, limit ${+s.threshold.toPrecision(3)}` : "";
        reason.append(element("br"), `${words(s.quantity)} ${+s.value.toPrecision(3)}${limit}`);
      } else if (view.planner.text) {
        reason.append(element("br"), view.planner.text);
      }
    } else {
      reason.textContent = "Waiting for the rover.";
    }
    const toGoal = view.planner.goal_distance_m, whole = view.book.path_length_m;
    const fraction = s.name === "GOAL_REACHED" ? 1 : Number.isFinite(toGoal) && whole > 0 ? 1 - toGoal / whole : 0;
    byId("bar").style.width = `${100 * Math.max(0, Math.min(1, fraction))}%`;
    byId("togo").textContent = fixed(toGoal, 1, " m");
    byId("driven").textContent = fixed(pose.travelled_m, 1, " m");
    byId("speed").textContent = fixed(pose.speed_mps, 2, " m/s");
    byId("repairs").textContent = view.planner.replans;
    byId("stops").textContent = s.hazard_stops;
    byId("sigma").textContent = fixed(pose.sigma_m, 2, " m");
  }

  let shownFaults = "";
  function faults(view) {
    const list = view.state.faults, key = JSON.stringify(list.map((f) => [f.id, f.value]));
    if (key === shownFaults) return;
    shownFaults = key;
    byId("faults").replaceChildren(...list.map((fault) => {
      const item = element("li", ["LOG", "SLOW"].includes(fault.response) ? "minor" : "");
      const value = Number.isFinite(fault.value) ? ` ${+fault.value.toPrecision(3)}` : "";
      const limit = Number.isFinite(fault.limit) ? ` / ${+fault.limit.toPrecision(3)}` : "";
      const text = element("span", "", words(fault.id) + value + limit);
      text.title = `${fault.id}: ${words(fault.response).toLowerCase()}`;
      const clear = element("button", "", "Clear");
      clear.onclick = () => commands.send({ command: "clear_fault", fault: fault.id });
      item.append(text, clear);
      return item;
    }));
  }

  function row(name) {
    const tr = element("tr");
    tr.dataset.service = name;
    const dot = element("td");
    dot.append(element("span", "dot"));
    const cells = ["name", "age", "cpu", "restarts"].map((kind) => element("td", kind));
    cells[0].textContent = words(name);
    tr.append(dot, ...cells);
    if (setup.injection) {
      const inject = element("td", "inject");
      for (const kind of ["kill", "hang"]) {
        const button = element("button", "", kind);
        button.onclick = () => commands.send({ command: kind, service: name });
        inject.append(button);
      }
      tr.append(inject);
    }
    byId("services").append(tr);
    rows.set(name, { tr, cells });
    byId("services").classList.toggle("many", rows.size > MANY_SERVICES);
    return rows.get(name);
  }

  function services(view) {
    const now = performance.now();
    for (const service of view.services) {
      const { tr, cells } = rows.get(service.name) || row(service.name);
      if (service.health === "lost") redUntil.set(service.name, now + RED_HOLD_MS);
      const health = redUntil.get(service.name) > now ? "lost" : service.health;
      tr.className = health;
      tr.title = service.text || ({ lost: "no heartbeat", stopped: "stopped: this level does not need it" }[health] ?? "");
      cells[1].textContent = fixed(service.age_s, 1, " s");
      cells[2].textContent = fixed(service.cpu, 0, " %");
      cells[3].textContent = service.restarts ?? "–";
    }
  }

  // Hidden until the Full level publishes data.
  function mapping(view) {
    const { terrain, slam, correction, pan_tilt: unit, grids } = view;
    byId("mapping").hidden = view.state.level !== "FULL" && !(terrain || slam || correction || grids.elevation);
    if (byId("mapping").hidden) return;
    byId("difficulty").textContent = terrain ? fixed(terrain.difficulty, 2) : "–";
    byId("known").textContent = terrain ? fixed(100 * terrain.known, 0, " %") : "–";
    byId("map-age").textContent = grids.elevation ? fixed(grids.elevation.age_s, 1, " s") : "–";
    byId("navcam-at").textContent = unit && Number.isFinite(unit.pan) ? direction(deg(unit.pan)) : "–";
    byId("slam").textContent = slam ? SLAM[slam.status] || "?" : "–";
    byId("slam").title = slam ? `${slam.particles} particles, information ${fixed(slam.information, 2)}` : "";
    byId("correction").textContent = !correction ? "–" : correction.accepted ? fixed(correction.moved_m, 2, " m") : "rejected";
    byId("correction").title = correction ? `${clock(correction.age_s)} ago, score ${fixed(correction.score, 2)}` : "not yet matched to the orbital map";
    const why = correction && !correction.accepted ? `Not matched to the orbital map: ${words(correction.reason)}` : "";
    byId("correction-why").hidden = !why;
    byId("correction-why").textContent = byId("correction-why").title = why;
  }

  function eventItem(event) {
    const item = element("li", event.tone);
    item.append(element("time", "", clock(event.t_s)), element("i"), element("span", "", words(event.text)));
    return item;
  }

  return {
    show(view) {
      situation(view);
      faults(view);
      slip(view.motion.slip);
      roll(deg(view.pose.roll));
      pitch(deg(view.pose.pitch));
      if (view.motion.currents_a.some(Number.isFinite)) currents.forEach((set, i) => set(view.motion.currents_a[i]));
      mapping(view);
      services(view);
    },
    setEvents(events) { byId("events").replaceChildren(...events.toReversed().map(eventItem)); },
    addEvents(events) {
      for (const event of events) byId("events").prepend(eventItem(event));
      while (byId("events").childElementCount > 400) byId("events").lastElementChild.remove();
    },
  };
}
