// Sends the operator's commands and shows the replies.
const byId = (id) => document.getElementById(id);
const words = (name) => name.replaceAll("_", " ");
const describe = (c) => [words(c.command), c.level && c.command === "force_level" ? c.level : "", c.service || c.fault || (c.within_m ? `within ${c.within_m} m` : "")].filter(Boolean).join(" ");

const REPLY_MS = 8000;  // the server answers within 3 s
const UNDECIDED = [0, 503, 504];  // no reply, not sent yet, not acknowledged: the rover may do it all the same

async function post(url, body) {
  const response = await fetch(url, {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body), signal: AbortSignal.timeout(REPLY_MS),
  });
  return { status: response.status, ...(await response.json()) };
}

function toast(text, good) {
  const box = document.createElement("div");
  box.className = `toast ${good ? "" : "bad"}`;
  box.textContent = text;
  byId("toasts").append(box);
  setTimeout(() => box.remove(), 4500);
}

// Waypoints from GeoJSON (all its lines), a JSON list or lines "x, y", in map coordinates [m]. The coordinates of a planet
// map's plan are degrees; map_xy_m has the metres.
export function readWaypoints(text) {
  const numbers = (list) => list.map((p) => [Number(p[0]), Number(p[1])]);
  const find = (node) => {
    if (Array.isArray(node)) return numbers(node);
    if (node.type === "FeatureCollection")
      return node.features.filter((f) => f.geometry?.type === "LineString").flatMap(find)
        .filter((p, i, all) => i === 0 || p[0] !== all[i - 1][0] || p[1] !== all[i - 1][1]);
    if (node.type === "Feature") return find(node.properties?.map_xy_m || node.geometry);
    if (node.type === "LineString") return numbers(node.coordinates);
    if (node.points) return numbers(node.points);
    if (node.x_m) return node.x_m.map((x, i) => [Number(x), Number(node.y_m[i])]);
    return [];
  };
  const points = /^\s*[[{]/.test(text) ? find(JSON.parse(text))
    : numbers(text.split("\n").map((row) => row.trim().split(/[,;\s]+/)).filter((row) => row.length >= 2 && !Number.isNaN(Number(row[0]))));
  if (points.length < 2 || !points.flat().every(Number.isFinite)) throw new Error("at least two waypoints x, y are required");
  return points;
}

// Polygons of GeoJSON in map coordinates [m]; property kind: keep_out (also without one) or keep_in.
export function readZones(text, name) {
  const root = JSON.parse(text);
  const features = root.type === "FeatureCollection" ? root.features : root.type === "Feature" ? [root] : [{ geometry: root, properties: {} }];
  if (features.some((f) => f.geometry?.type === "MultiPolygon" || (f.geometry?.type === "Polygon" && f.geometry.coordinates.length !== 1)))
    throw new Error("only polygons of one ring can be zones");
  const zones = features.filter((f) => f.geometry?.type === "Polygon").map((f, i) => {
    const ring = (f.properties?.map_xy_m || f.geometry.coordinates[0]).map((p) => [Number(p[0]), Number(p[1])]);
    const closed = ring.length > 1 && ring[0][0] === ring.at(-1)[0] && ring[0][1] === ring.at(-1)[1];
    return { name: String(f.properties?.name || `${name} ${i + 1}`), kind: f.properties?.kind === "keep_in" ? "keep_in" : "keep_out", points: closed ? ring.slice(0, -1) : ring };
  });
  if (!zones.length) throw new Error("a GeoJSON polygon is required");
  return zones;
}

export function createCommands(setup, map, charts) {
  async function send(command) {
    const what = describe(command);
    const note = byId("answer");
    note.className = "note";
    note.textContent = `${what} …`;
    let result;
    try {
      result = await post("/api/command", command);
    } catch {
      result = { status: 0, accepted: false, reason: "no reply; the rover may have received it" };
    }
    const reason = words(result.reason || "no reason given");
    const text = `${what}: ${result.accepted ? "accepted" : UNDECIDED.includes(result.status) ? reason : `refused, ${reason}`}`;
    note.textContent = text;
    note.className = `note ${result.accepted ? "good" : "bad"}`;
    toast(text, result.accepted);
    return result;
  }

  for (const button of document.querySelectorAll("[data-command]"))
    button.addEventListener("click", () => send({ command: button.dataset.command }));
  byId("levels").addEventListener("click", ({ target }) => {
    if (target.dataset.level) send({ command: "force_level", level: target.dataset.level });
  });

  byId("locate").onclick = () => send({ command: "locate", within_m: 500 });

  // Path drawing.
  const tools = { draw: byId("draw"), load: byId("load"), undo: byId("undo"), send: byId("send"), cancel: byId("cancel") };
  const info = byId("path-info");
  let checked = 0;

  function drawing(on) {
    tools.draw.hidden = tools.load.hidden = on;
    tools.undo.hidden = tools.send.hidden = tools.cancel.hidden = info.hidden = !on;
    tools.send.disabled = true;
    if (!on) {
      map.sketch.end();
      charts.showProfile(null);
    }
  }
  function say(text, tone) {
    info.textContent = text;
    info.className = `note ${tone || ""}`;
  }

  async function check() {
    const number = ++checked, points = map.sketch.points();
    tools.send.disabled = true;
    if (points.length < 2) return say("Click waypoints on the map.");
    const found = await post("/api/check", { points });
    if (number !== checked) return;
    map.sketch.draw(found);
    if (found.inside === undefined) return say(words(found.reason), "bad");
    if (!found.inside) return say("The path leaves the map.", "bad");
    charts.showProfile(found);
    const figures = `${found.length_m.toFixed(1)} m, slope up to ${found.max_slope_deg.toFixed(1)}°`;
    if (!found.passable) return say(`${figures}: the limit is ${setup.path.max_slope_deg}°.`, "bad");
    tools.send.disabled = false;
    say(figures, found.max_slope_deg > setup.path.steep_slope_deg ? "warn" : "good");
  }

  tools.draw.onclick = () => { drawing(true); map.sketch.begin(check); say("Click waypoints on the map."); };
  tools.undo.onclick = () => map.sketch.undo();
  tools.cancel.onclick = () => drawing(false);
  tools.send.onclick = async () => {
    const result = await send({ command: "path", points: map.sketch.points() });
    if (result.accepted) drawing(false);
  };
  tools.load.onclick = () => byId("file").click();
  byId("file").onchange = async ({ target }) => {
    const file = target.files[0];
    target.value = "";
    if (!file) return;
    try {
      const points = readWaypoints(await file.text());
      drawing(true);
      map.sketch.load(points, check);
    } catch (error) {
      toast(`${file.name}: ${error.message}`, false);
    }
  };

  // Zones: those that the rover has, and the one being drawn.
  const zoneTools = { undo: byId("zone-undo"), send: byId("zone-send"), cancel: byId("zone-cancel"), name: byId("zone-name") };
  const zoneStart = [byId("zone-out"), byId("zone-in"), byId("zone-load")];
  let zones = [], zoneKind = null;

  function drawingZone(kind) {
    zoneKind = kind;
    for (const button of zoneStart) button.hidden = kind !== null;
    for (const tool of Object.values(zoneTools)) tool.hidden = kind === null;
    byId("path-tools").hidden = kind !== null;
    info.hidden = kind === null;
    zoneTools.send.disabled = true;
    if (kind === null) return map.sketch.end();
    let number = 1;
    while (zones.some((zone) => zone.name === `${words(kind)} ${number}`)) number++;
    zoneTools.name.value = `${words(kind)} ${number}`;
    say("Click the corners on the map.");
    return map.sketch.begin(() => { zoneTools.send.disabled = map.sketch.points().length < 3; }, kind);
  }
  byId("zone-out").onclick = () => drawingZone("keep_out");
  byId("zone-in").onclick = () => drawingZone("keep_in");
  zoneTools.undo.onclick = () => map.sketch.undo();
  zoneTools.cancel.onclick = () => drawingZone(null);
  zoneTools.send.onclick = async () => {
    const zone = { name: zoneTools.name.value.trim(), kind: zoneKind, points: map.sketch.points() };
    const result = await send({ command: "zones", zones: [...zones, zone] });
    if (result.accepted) drawingZone(null);
  };
  byId("zone-load").onclick = () => byId("zone-file").click();
  byId("zone-file").onchange = async ({ target }) => {
    const file = target.files[0];
    target.value = "";
    if (!file) return;
    try {
      await send({ command: "zones", zones: [...zones, ...readZones(await file.text(), file.name.replace(/\.[^.]*$/, ""))] });
    } catch (error) {
      toast(`${file.name}: ${error.message}`, false);
    }
  };
  function showZones(found) {
    zones = found;
    byId("zones").replaceChildren(...zones.map((zone) => {
      const item = document.createElement("li");
      item.className = zone.kind;
      item.textContent = zone.name;
      const remove = document.createElement("button");
      remove.textContent = "×";
      remove.title = `Delete ${zone.name}`;
      remove.onclick = () => send({ command: "zones", zones: zones.filter((other) => other !== zone) });
      item.append(remove);
      return item;
    }));
  }

  return {
    send,
    showZones,
    show(view) {
      byId("clear-safe").hidden = view.state.name !== "SAFE";
      byId("locate").hidden = view.state.level !== "FULL" || view.state.name === "DRIVING";
      const forced = (view.book.forced || "auto").toLowerCase();
      for (const button of byId("levels").children) button.classList.toggle("on", button.dataset.level === forced);
    },
  };
}
