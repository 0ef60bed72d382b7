// Entry point: receives five views a second and passes them to the parts of the page.
import { createMap } from "/map.js";
import { createPanels } from "/panels.js";
import { createCharts } from "/charts.js";
import { createCamera } from "/camera.js";
import { createCommands } from "/commands.js";

const byId = (id) => document.getElementById(id);
const SILENT_MS = 3000;  // a stream without data for so long is lost
const FETCH_MS = 15000;  // a long history over a slow link takes seconds
export const getJson = async (url) => {
  const response = await fetch(url, { signal: AbortSignal.timeout(FETCH_MS) });
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return response.json();
};

let setup = null;
let parts = null;
let source = null;
let truthWanted = false;
let newestEvent = 0;
let paths = { global: null, local: null };
let fetching = false;
let heardAt = 0;

function showLink(state, text) {
  byId("link").className = `link ${state}`;
  byId("link").textContent = text;
}

function showVeil(text) {
  byId("veil").hidden = !text;
  byId("veil").firstElementChild.textContent = text || "";
}

// Loads the state of the run; reloads the page if another run uses the same address.
async function begin() {
  const fresh = await getJson("/api/setup");
  if (setup && fresh.run !== setup.run) return location.reload();
  setup = fresh;
  byId("run").textContent = setup.run;
  document.title = `Mission control · ${setup.run}`;
  byId("no-map").hidden = setup.map !== null;
  if (!parts) {
    const map = createMap(setup, { onTruth: (on) => { truthWanted = on; openStream(); } });
    const charts = createCharts(setup);
    parts = { map, charts, camera: createCamera(setup), commands: createCommands(setup, map, charts) };
    parts.panels = createPanels(setup, parts.commands);
  }
  const history = await getJson("/api/history");
  parts.map.setTrack(history.track);
  parts.panels.setEvents(history.events);
  parts.charts.setTrend(history.trend);
  newestEvent = history.events.length ? history.events.at(-1).id : 0;
  paths = { global: null, local: null };
}

// Fetches events and paths when their sequence number has changed.
async function fetchNews(view) {
  if (fetching) return;
  fetching = true;
  try {
    if (view.book.event > newestEvent) {
      const events = await getJson(`/api/events?after=${newestEvent}`);
      newestEvent = events.length ? events.at(-1).id : view.book.event;
      parts.panels.addEvents(events);
    } else if (view.book.event < newestEvent) {
      await begin();
    }
    if (view.book.path !== paths.global || view.path !== paths.local) {
      const found = await getJson("/api/paths");
      paths = { global: found.global.id, local: found.local.id };
      parts.map.setPaths(found);
      parts.commands.showZones(found.global.zones);
    }
  } finally {
    fetching = false;
  }
}

function show(view) {
  heardAt = performance.now();
  showLink("up", view.book.pages > 1 ? `live · ${view.book.pages} pages` : "live");
  const stopped = view.tick_age_s !== null && view.tick_age_s > 2.5;
  showVeil(stopped ? `The rover's clock stopped ${view.tick_age_s.toFixed(0)} s ago` : "");
  parts.map.show(view);
  parts.panels.show(view);
  parts.charts.show(view);
  parts.camera.show(view);
  parts.commands.show(view);
  fetchNews(view).catch(() => {});
}

function reconnect() {
  if (source) source.close();
  source = null;
  showLink("down", "no connection");
  showVeil("No connection to mission control. Reconnecting …");
  setTimeout(start, 1000);
}

function openStream() {
  if (source) source.close();
  source = new EventSource(`/api/stream?truth=${truthWanted ? 1 : 0}`);
  source.addEventListener("view", (event) => show(JSON.parse(event.data)));
  source.addEventListener("truth", (event) => parts.map.showTruth(JSON.parse(event.data)));
  source.onerror = reconnect;
  heardAt = performance.now();
}

async function start() {
  try {
    await begin();
    showVeil("");
    openStream();
  } catch {
    reconnect();
  }
}

// A server that hangs, or a tunnel that stalls, is no error to the browser.
setInterval(() => { if (source && performance.now() - heardAt > SILENT_MS) reconnect(); }, 500);
start();
