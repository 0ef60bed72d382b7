// Map in metres: orbital layers, paths, tracks, the rover to scale and its grids.
const L = window.L;
const at = (x, y) => L.latLng(y, x);
const compose = (a, b) => {
  const c = Math.cos(a[2]), s = Math.sin(a[2]);
  return [a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]];
};
const apply = (pose, x, y) => {
  const c = Math.cos(pose[2]), s = Math.sin(pose[2]);
  return [pose[0] + c * x - s * y, pose[1] + s * x + c * y];
};
const NAVCAM_RANGE_M = 8;
const OLD_MAP_S = 10;
const finite = (...values) => values.every((v) => Number.isFinite(v));

// Image of a grid; the grid may be rotated in the map.
const GridLayer = L.Layer.extend({
  initialize(name) { this.name = name; this.seq = 0; },
  onAdd(map) {
    this.image = L.DomUtil.create("img", "grid-layer", map.getPane("grids"));
    this.image.alt = "";
    map.on("zoom viewreset", this.place, this);
    this.seq = 0;
    if (this.latest) this.set(...this.latest);
  },
  onRemove(map) {
    this.image.remove();
    this.image = null;
    map.off("zoom viewreset", this.place, this);
  },
  // Fades an outdated map of the Full level.
  fade(old) { if (this.image) this.image.classList.toggle("old", old); },
  // Image and pose change together.
  set(grid, mapOdom) {
    this.latest = [grid, mapOdom];
    if (!this.image || grid.seq === this.seq || this.loading) return;
    const picture = new Image();
    this.loading = true;
    picture.onload = () => {
      this.loading = false;
      if (!this.image) return;
      this.seq = grid.seq;
      this.placed = [grid, mapOdom];
      this.image.src = picture.src;
      this.place();
    };
    picture.onerror = () => { this.loading = false; };
    picture.src = `/layer/${this.name}.png?seq=${grid.seq}`;
  },
  place() {
    if (!this.placed || !this.image) return;
    const [g, mapOdom] = this.placed;
    if (!finite(...mapOdom, ...g.odom)) return;
    const pose = compose(mapOdom, g.odom);
    const point = (u, v) => {
      const [x, y] = apply(pose, g.x_m + u * g.cell_m, g.y_m + (g.ny - v) * g.cell_m);
      return this._map.project(at(x, y)).subtract(this._map.getPixelOrigin());
    };
    const o = point(0, 0), u = point(g.nx, 0), v = point(0, g.ny);
    this.image.style.width = `${g.nx}px`;
    this.image.style.height = `${g.ny}px`;
    this.image.style.transform = `matrix(${(u.x - o.x) / g.nx},${(u.y - o.y) / g.nx},${(v.x - o.x) / g.ny},${(v.y - o.y) / g.ny},${o.x},${o.y})`;
  },
});

// Body and wheels to scale; an arrow of constant size if they are too small to see.
class Rover {
  constructor(map, vehicle, style) {
    this.map = map;
    this.vehicle = vehicle;
    const polygon = (options) => L.polygon([], { interactive: false, ...options });
    this.body = polygon({ color: style.line, weight: 1.5, fillColor: style.fill, fillOpacity: style.opacity, dashArray: style.dash });
    this.wheels = vehicle.wheel_x_m.map(() => polygon({ color: "#0b0e13", weight: .8, fillColor: style.wheel, fillOpacity: style.opacity }));
    this.nose = L.polyline([], { color: style.nose, weight: 2.5, interactive: false });
    this.arrow = polygon({ color: "#0b0e13", weight: 1, fillColor: style.fill, fillOpacity: .95 });
    this.group = L.layerGroup([this.body, ...this.wheels, this.nose, this.arrow]);
    map.on("zoomend", () => this.draw());
  }
  set(pose, steer) {
    this.pose = pose;
    this.steer = steer;
    this.draw();
  }
  outline(points) { return points.map(([x, y]) => at(...apply(this.pose, x, y))); }
  draw() {
    if (!this.pose || !finite(...this.pose)) return;
    const v = this.vehicle, l = v.half_length_m, w = v.half_width_m;
    this.body.setLatLngs(this.outline([[l, w], [l, -w], [-l, -w], [-l, w]]));
    this.nose.setLatLngs(this.outline([[l * .1, 0], [l * .9, 0]]));
    this.wheels.forEach((wheel, i) => {
      const steered = v.steered.indexOf(i);
      const turn = steered >= 0 && this.steer ? this.steer[steered] || 0 : 0;
      const hub = [v.wheel_x_m[i], v.wheel_y_m[i], turn];
      const r = v.wheel_radius_m, h = v.wheel_width_m / 2;
      wheel.setLatLngs(this.outline([[r, h], [r, -h], [-r, -h], [-r, h]].map(([x, y]) => apply(hub, x, y))));
    });
    const scale = 2 ** this.map.getZoom();
    const k = 2 * l * scale < 26 ? 13 / scale : 0;
    this.arrow.setLatLngs(k ? this.outline([[k, 0], [-.8 * k, .7 * k], [-.4 * k, 0], [-.8 * k, -.7 * k]]) : []);
  }
}

export function createMap(setup, { onTruth }) {
  const map = L.map("map", {
    crs: L.CRS.Simple, attributionControl: false, zoomAnimation: false, fadeAnimation: false, preferCanvas: true,
    minZoom: -1, maxZoom: 8, zoomSnap: .25, zoomDelta: .5, wheelPxPerZoomLevel: 100,
  });
  map.createPane("ground").style.zIndex = 250;
  map.createPane("grids").style.zIndex = 350;
  map.setView(at(0, 0), 3);
  const size = setup.map ? [[0, 0], [setup.map.height_m, setup.map.width_m]] : [[-50, -50], [50, 50]];
  if (setup.map) map.setMaxBounds(L.latLngBounds(size).pad(.3));
  map.fitBounds(size);
  L.control.scale({ imperial: false, maxWidth: 90, position: "bottomright" }).addTo(map);

  const picture = (name, options) => L.imageOverlay(`/map/${name}`, size, { className: name, pane: "ground", ...options });
  const line = (color, weight, extra) => L.polyline([], { color, weight, interactive: false, ...extra });
  const layers = {
    relief: picture("relief", {}), slope: picture("slope", { opacity: .75, zIndex: 2 }), difficulty: picture("difficulty", { opacity: .75, zIndex: 2 }),
    elevation: new GridLayer("elevation"), traversability: new GridLayer("traversability"), hazards: new GridLayer("hazards"),
    navcam: L.polygon([], { color: "#dbe2ea", weight: 1, opacity: .55, fillColor: "#dbe2ea", fillOpacity: .1, interactive: false }),
    global: L.layerGroup(), zones: L.layerGroup(), local: line("#5cc8ff", 3.5), track: line("#ffb454", 3), truth: L.layerGroup(),
  };
  const planned = line("#ffffff", 2.5, { dashArray: "7 6", opacity: .9 });
  const corridor = line("#ffffff", 1, { opacity: .1, lineCap: "butt" });
  const goal = L.circle(at(0, 0), { radius: .5, color: "#4cc38a", weight: 2, fillOpacity: .2, interactive: false });
  const trueTrack = line("#e48bff", 2, { dashArray: "3 5" });
  const vehicle = setup.vehicle;
  const rover = new Rover(map, vehicle, { line: "#0b0e13", fill: "#ffb454", wheel: "#dbe2ea", nose: "#3a2506", opacity: .95 });
  const trueRover = new Rover(map, vehicle, { line: "#e48bff", fill: "#e48bff", wheel: "#e48bff", nose: "#e48bff", opacity: .25, dash: "4 3" });
  layers.global.addLayer(corridor).addLayer(planned).addLayer(goal);
  layers.truth.addLayer(trueTrack).addLayer(trueRover.group);

  if (setup.map) layers.relief.addTo(map);
  for (const name of ["elevation", "traversability", "hazards", "navcam", "global", "zones", "track", "local"]) layers[name].addTo(map);
  rover.group.addTo(map);

  const control = L.control.layers(null, {}, { collapsed: true }).addTo(map);
  const names = {
    relief: "Relief", slope: "Slope", difficulty: "Difficulty", elevation: "Elevation map", traversability: "Traversability",
    hazards: "Hazards", navcam: "NavCam field of view", global: "Global path", zones: "Zones", local: "Local path", track: "Driven track", truth: "True pose (simulation)",
  };
  for (const [key, name] of Object.entries(names))
    if (key === "navcam" ? setup.navcam : setup.map || !["relief", "slope", "difficulty"].includes(key)) control.addOverlay(layers[key], name);
  map.on("overlayadd overlayremove", ({ layer }) => { if (layer === layers.truth) onTruth(map.hasLayer(layers.truth)); });

  const legend = L.control({ position: "bottomleft" });
  legend.onAdd = () => {
    const box = L.DomUtil.create("div", "map-legend");
    box.innerHTML = `<span><i class="dash" style="color:#fff"></i>global path</span><span><i style="color:#5cc8ff"></i>local path</span>
      <span><i style="color:#ffb454"></i>driven</span><span class="zone-key" hidden><i style="color:#f0616d"></i>keep-out</span><span class="terrain-key" hidden><i class="ramp cost"></i>cost</span><span class="terrain-key" hidden><i class="ramp height"></i>height</span>
      <span class="truth-key" hidden><i class="dash" style="color:#e48bff"></i>true</span>`;
    return box;
  };
  legend.addTo(map);

  let following = true;
  const tools = L.control({ position: "topleft" });
  tools.onAdd = () => {
    const bar = L.DomUtil.create("div", "leaflet-bar");
    const button = (text, title, act) => {
      const a = L.DomUtil.create("a", "", bar);
      a.href = "#"; a.title = title; a.textContent = text; a.setAttribute("role", "button");
      L.DomEvent.disableClickPropagation(a).on(a, "click", (e) => { L.DomEvent.preventDefault(e); act(); });
      return a;
    };
    tools.follow = button("◎", "Follow the rover", () => setFollowing(!following));
    button("⤢", "Whole path", () => { setFollowing(false); fitPath(); });
    return bar;
  };
  tools.addTo(map);
  const setFollowing = (on) => {
    following = on;
    tools.follow.classList.toggle("on", on);
    if (on && rover.pose) map.panTo(at(rover.pose[0], rover.pose[1]), { animate: false });
  };
  setFollowing(true);
  map.on("dragstart", () => setFollowing(false));

  let globalPath = null;
  let centred = false;  // the view has been centred on the rover
  const trackEnd = { x: NaN, y: NaN };
  let mapOdom = [NaN, NaN, NaN];
  let localPath = null;

  function fitPath() {
    const bounds = L.latLngBounds(globalPath ? globalPath.x_m.map((x, i) => at(x, globalPath.y_m[i])) : size);
    if (rover.pose && finite(...rover.pose)) bounds.extend(at(rover.pose[0], rover.pose[1]));
    map.fitBounds(bounds, { padding: [46, 46], maxZoom: 6 });
  }
  const widths = () => { if (globalPath) corridor.setStyle({ weight: Math.max(1, 2 * globalPath.corridor_half_width_m * 2 ** map.getZoom()) }); };
  map.on("zoomend", widths);

  // Field of view of the NavCam, up to its useful range.
  function drawNavCam(view) {
    const n = setup.navcam, p = view.pose, unit = view.pan_tilt;
    const visible = n && unit && view.state.level === "FULL" && finite(p.x_m, p.y_m, p.yaw, unit.pan);
    if (!visible) return layers.navcam.setLatLngs([]);
    const eye = compose([p.x_m, p.y_m, p.yaw], [n.x_m, n.y_m, unit.pan]), points = [apply(eye, 0, 0)], steps = 6;
    for (let i = -steps; i <= steps; i++) {
      const a = (n.half_width * i) / steps;
      points.push(apply(eye, NAVCAM_RANGE_M * Math.cos(a), NAVCAM_RANGE_M * Math.sin(a)));
    }
    return layers.navcam.setLatLngs(points.map(([x, y]) => at(x, y)));
  }

  const drawLocal = () => {
    if (!localPath || !finite(...mapOdom)) return;
    layers.local.setLatLngs(localPath.x_m.map((x, i) => at(...apply(mapOdom, x, localPath.y_m[i]))));
  };

  let zones = [];
  const zoneStyle = { keep_out: { color: "#f0616d", weight: 2, fillOpacity: .22 }, keep_in: { color: "#4cc38a", weight: 2, dashArray: "6 5", fill: false } };
  function drawZones() {
    layers.zones.clearLayers();
    for (const zone of zones) {
      const name = document.createElement("span");
      name.textContent = zone.name;
      L.polygon(zone.points.map(([x, y]) => at(x, y)), zoneStyle[zone.kind]).bindTooltip(name, { sticky: true }).addTo(layers.zones);
    }
    document.querySelector(".zone-key").hidden = !zones.some((zone) => zone.kind === "keep_out");
  }

  // Drawing: waypoints by clicks; the first segment starts at the rover. Of a zone: its corners.
  const sketch = { points: [], on: false, changed: () => {} };
  const sketchLine = L.layerGroup().addTo(map);
  const slopeColour = (deg) => (deg > setup.path.max_slope_deg ? "#f0616d" : deg > setup.path.steep_slope_deg ? "#f2b84b" : "#4cc38a");
  function drawSketch(check) {
    sketchLine.clearLayers();
    const line_ = (points, color) => L.polyline(points, { color, weight: 4, interactive: false }).addTo(sketchLine);
    const whole = waypoints();
    if (sketch.zone) {
      L.polygon(whole.map(([x, y]) => at(x, y)), { ...zoneStyle[sketch.zone], interactive: false }).addTo(sketchLine);
    } else if (check && check.inside && check.distance_m.length > 1) {
      const along = pointsAlong(whole, check.distance_m);
      for (let i = 1; i < along.length; i++) line_([along[i - 1], along[i]], slopeColour(Math.max(check.slope_deg[i], check.slope_deg[i - 1])));
    } else if (whole.length > 1) {
      line_(whole.map(([x, y]) => at(x, y)), "#dbe2ea");
    }
    for (const [x, y] of sketch.points)
      L.circleMarker(at(x, y), { radius: 5, color: "#0b0e13", weight: 1.5, fillColor: "#fff", fillOpacity: 1, interactive: false }).addTo(sketchLine);
  }
  function pointsAlong(points, distances) {
    const out = [];
    let segment = 0, before = 0, length = Math.hypot(points[1][0] - points[0][0], points[1][1] - points[0][1]);
    for (const d of distances) {
      while (d > before + length && segment + 2 < points.length) {
        before += length; segment++;
        length = Math.hypot(points[segment + 1][0] - points[segment][0], points[segment + 1][1] - points[segment][1]);
      }
      const u = length > 0 ? Math.min(1, (d - before) / length) : 0;
      out.push(at(points[segment][0] + u * (points[segment + 1][0] - points[segment][0]), points[segment][1] + u * (points[segment + 1][1] - points[segment][1])));
    }
    return out;
  }
  const waypoints = () => {
    const own = sketch.points;
    if (!sketch.fromRover || !own.length || !rover.pose || !finite(...rover.pose)) return own;
    return [[rover.pose[0], rover.pose[1]], ...own];
  };
  map.on("click", (event) => {
    if (!sketch.on) return;
    sketch.points.push([event.latlng.lng, event.latlng.lat]);
    drawSketch();
    sketch.changed();
  });

  new ResizeObserver(() => map.invalidateSize({ animate: false })).observe(document.getElementById("map"));

  return {
    leaflet: map,
    setTrack(track) {
      const points = [];
      for (let i = 0; i + 1 < track.length; i += 2) points.push(at(track[i], track[i + 1]));
      layers.track.setLatLngs(points);
      trackEnd.x = points.length ? points.at(-1).lng : NaN;
      trackEnd.y = points.length ? points.at(-1).lat : NaN;
    },
    setPaths(found) {
      globalPath = found.global.x_m.length ? found.global : null;
      if (globalPath) {
        const points = globalPath.x_m.map((x, i) => at(x, globalPath.y_m[i]));
        planned.setLatLngs(points);
        corridor.setLatLngs(points);
        goal.setLatLng(points.at(-1)).setRadius(globalPath.goal_tolerance_m);
        widths();
      }
      zones = found.global.zones;
      drawZones();
      localPath = found.local.x_m.length ? found.local : null;
      drawLocal();
    },
    show(view) {
      const p = view.pose;
      if (finite(p.x_m, p.y_m, p.yaw) && p.status !== 3) {
        rover.set([p.x_m, p.y_m, p.yaw], view.motion.steer);
        if (!(Math.hypot(p.x_m - trackEnd.x, p.y_m - trackEnd.y) < .1)) {
          const jump = Math.hypot(p.x_m - trackEnd.x, p.y_m - trackEnd.y) > 20;
          if (!jump) layers.track.addLatLng(at(p.x_m, p.y_m));
          trackEnd.x = p.x_m; trackEnd.y = p.y_m;
        }
        if (!centred) {
          centred = true;
          map.setView(at(p.x_m, p.y_m), map.getSize().x > 600 ? 5 : 4.5, { animate: false });
        } else if (following && !sketch.on) map.panTo(at(p.x_m, p.y_m), { animate: false });
      }
      if (p.odom.some((v, i) => v !== mapOdom[i])) { mapOdom = p.odom; drawLocal(); }
      drawNavCam(view);
      for (const name of ["hazards", "traversability", "elevation"])
        if (view.grids[name]) layers[name].set(view.grids[name], p.odom);
      for (const name of ["traversability", "elevation"])
        layers[name].fade(view.state.level !== "FULL" && view.grids[name]?.age_s > OLD_MAP_S);
      if (view.grids.elevation || view.grids.traversability)
        for (const key of document.querySelectorAll(".terrain-key")) key.hidden = false;
    },
    showTruth(truth) {
      trueRover.set([truth.x_m, truth.y_m, truth.yaw], null);
      trueTrack.addLatLng(at(truth.x_m, truth.y_m));
      document.querySelector(".truth-key").hidden = false;
    },
    sketch: {
      begin(changed, zone = null) {
        Object.assign(sketch, { on: true, points: [], fromRover: !zone, zone, changed });
        document.getElementById("map").classList.add("drawing");
        map.doubleClickZoom.disable();
      },
      load(points, changed) {
        Object.assign(sketch, { on: true, points, fromRover: false, zone: null, changed });
        map.fitBounds(L.latLngBounds(points.map(([x, y]) => at(x, y))), { padding: [46, 46], maxZoom: 6 });
        drawSketch();
        changed();
      },
      undo() { sketch.points.pop(); drawSketch(); sketch.changed(); },
      end() {
        Object.assign(sketch, { on: false, points: [], zone: null });
        document.getElementById("map").classList.remove("drawing");
        map.doubleClickZoom.enable();
        sketchLine.clearLayers();
      },
      points: waypoints,
      draw: drawSketch,
    },
  };
}
