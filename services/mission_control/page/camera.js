// Camera images. The LocCam image shows the hazard detector's region of interest and its hazards.
const byId = (id) => document.getElementById(id);

// Projects points of the body frame into the rectified camera (z forward, x right, y down).
function createProjection(camera) {
  const R = camera.rotation, t = camera.position_m;
  return {
    camera,
    pixel([x, y, z]) {
      const d = [x - t[0], y - t[1], z - t[2]];
      const c = [0, 1, 2].map((k) => R[0][k] * d[0] + R[1][k] * d[1] + R[2][k] * d[2]);
      if (c[2] < .05) return null;
      return [camera.cx_px + (camera.focal_px * c[0]) / c[2], camera.cy_px + (camera.focal_px * c[1]) / c[2]];
    },
    // Image row, in column u, of the ground at the distance `ahead` from the camera.
    row(u, ahead, ground_z) {
      const a = (u - camera.cx_px) / camera.focal_px, drop = t[2] - ground_z;
      const b = -(drop * (R[0][0] * a + R[0][2]) + ahead * (R[2][0] * a + R[2][2])) / (drop * R[0][1] + ahead * R[2][1]);
      return camera.cy_px + camera.focal_px * b;
    },
  };
}

export function createCamera(setup) {
  const canvas = byId("camera"), context = canvas.getContext("2d");
  let chosen = "loccam", projection = null, requested = false, shown = { loccam: 0, navcam: 0 }, loading = false, switched = false;
  const ground = -setup.vehicle.origin_height_m;

  byId("camera-choice").onclick = ({ target }) => {
    if (!target.dataset.camera) return;
    chosen = target.dataset.camera;
    shown[chosen] = 0;
    switched = true;
  };

  async function findProjection() {
    if (projection || requested) return;
    requested = true;
    try {
      const response = await fetch("/api/camera");
      const camera = await response.json();
      if (camera) projection = createProjection(camera);
    } catch { /* retried */ }
    setTimeout(() => { requested = false; }, 1000);
  }

  function drawRegion() {
    const { near_m, far_m } = setup.roi, w = canvas.width, steps = 8;
    context.beginPath();
    for (let i = 0; i <= steps; i++) context[i ? "lineTo" : "moveTo"]((w * i) / steps, projection.row((w * i) / steps, far_m, ground));
    for (let i = steps; i >= 0; i--) context.lineTo((w * i) / steps, projection.row((w * i) / steps, near_m, ground));
    context.closePath();
    context.strokeStyle = "#5cc8ffd0";
    context.lineWidth = 1.5;
    context.stroke();
  }

  // Point on the ground plane fitted by the hazard detector.
  const onGround = (grid, x, y) => [x, y, ground - Math.tan(grid.plane[0]) * x + Math.tan(grid.plane[1]) * y];

  // The layer image has one pixel per cell; row 0 is the largest y.
  function drawHazards(grid, cells) {
    const size = document.createElement("canvas");
    size.width = grid.nx; size.height = grid.ny;
    const c = size.getContext("2d", { willReadFrequently: true });
    c.drawImage(cells, 0, 0);
    const data = c.getImageData(0, 0, grid.nx, grid.ny).data;
    for (let v = 0; v < grid.ny; v++) {
      for (let u = 0; u < grid.nx; u++) {
        const i = 4 * (v * grid.nx + u);
        const free = data[i + 1] > data[i];
        if (!data[i + 3] || free) continue;
        const corner = (du, dv) => projection.pixel(onGround(grid, grid.x_m + (u + du) * grid.cell_m, grid.y_m + (grid.ny - v - dv) * grid.cell_m));
        const corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        if (corners.includes(null)) continue;
        context.beginPath();
        corners.forEach(([x, y], k) => context[k ? "lineTo" : "moveTo"](x, y));
        context.closePath();
        context.fillStyle = `rgba(${data[i]},${data[i + 1]},${data[i + 2]},${data[i + 3] > 200 ? .5 : .26})`;
        context.fill();
      }
    }
  }

  const picture = (src) => new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = reject;
    image.src = src;
  });

  async function load(view, name) {
    const image = view.images[name], grid = name === "loccam" ? view.grids.hazards : null;
    loading = true;
    try {
      const [photo, cells] = await Promise.all([
        picture(`/camera/${name}.jpg?seq=${image.seq}`),
        grid && grid.seq === image.seq && projection ? picture(`/layer/hazards.png?seq=${grid.seq}`) : null,
      ]);
      shown[name] = image.seq;
      if (canvas.width !== image.width || canvas.height !== image.height) Object.assign(canvas, { width: image.width, height: image.height });
      context.drawImage(photo, 0, 0, canvas.width, canvas.height);
      if (name === "loccam" && projection && projection.camera.width === canvas.width) {
        if (cells) drawHazards(grid, cells);
        drawRegion();
      }
    } catch { /* retried with the next view */ } finally {
      loading = false;
    }
  }

  return {
    show(view) {
      findProjection();
      const both = view.images.loccam && view.images.navcam;
      byId("camera-choice").hidden = !both;
      byId("camera-title").hidden = Boolean(both);
      if (!switched) chosen = view.images.navcam && (view.state.level === "FULL" || !view.images.loccam) ? "navcam" : "loccam";
      for (const button of byId("camera-choice").children) button.classList.toggle("on", button.dataset.camera === chosen);
      document.querySelector(".cameras .legend").hidden = chosen !== "loccam";
      byId("camera-title").textContent = chosen === "loccam" ? "LocCam" : "NavCam";
      const image = view.images[chosen];
      byId("camera-age").textContent = image && Number.isFinite(image.age_s) ? `${image.age_s.toFixed(1)} s old` : "no image yet";
      if (image && image.seq !== shown[chosen] && !loading) load(view, chosen);
    },
  };
}
