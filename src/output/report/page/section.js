// Cross-sections: where the wire passes through a half plane from the axis, and the core's outline there.

/** The section of a run with a slider for its angle, or null without wire. */
function crossSection(run) {
  if (!run.wire) return null;
  const start = Math.atan2(run.wire.points[2], run.wire.points[0]);
  const sense = run.direction;
  let angle = 90;
  let cut = null;
  const look = () => {
    const polar = start + (sense * angle * Math.PI) / 180;
    cut = { wires: wiresAt(run, polar), core: run.core ? outline(run.core, polar) : [] };
  };
  look();
  const board = canvas((width) => Math.min(420, Math.max(260, 0.42 * width)), (pen, width, height) => drawSection(pen, width, height, run, cut));
  const output = el("output", {});
  const name = () => {
    const turns = cut.wires.length;
    output.textContent = `${angle}° from the clamp, ${turns} wire${turns === 1 ? "" : "s"}`;
  };
  name();
  const slider = el("input", {
    type: "range", min: 0, max: 359, value: angle, "aria-label": "Angle of the section, degrees from the clamp",
    oninput: (event) => {
      angle = Number(event.target.value);
      look();
      name();
      board.paint();
    },
  });
  const layers = [...new Set(run.wire.layer)].sort((a, b) => a - b);
  const named = layers.map((layer) => [layer === 0 ? "not at rest" : `layer ${layer}`, layerColour(layer)]);
  return el("section", { class: "card section" }, el("div", { class: "bar" }, el("h2", {}, "Cross-section"), keys(named)),
    board, el("div", { class: "angle" }, el("span", { class: "soft" }, "Angle"), slider, output),
    el("p", { class: "note" }, "Numbers are turns. Wires are drawn round, at their diameter; a wire that crosses at a slant is wider in truth."));
}

/** Places in the half plane at a polar angle where the wire passes it: along the axis, from the axis, turn, layer. */
function wiresAt(run, polar) {
  const { points, layer } = run.wire;
  const [c, s] = [Math.cos(polar), Math.sin(polar)];
  const found = [];
  const side = (k) => c * points[3 * k + 2] - s * points[3 * k];
  let before = side(0);
  for (let k = 1; k < layer.length; k += 1) {
    const now = side(k);
    if (before <= 0 !== now <= 0) {
      const share = before / (before - now);
      const at = (axis) => points[3 * (k - 1) + axis] + share * (points[3 * k + axis] - points[3 * (k - 1) + axis]);
      const radius = c * at(0) + s * at(2);
      // The free span to the nozzle is no part of the coil.
      if (radius > 0 && k < run.laid) found.push({ y: at(1), radius, layer: layer[k], turn: Math.floor(run.turnOf[k]) + 1 });
    }
    before = now;
  }
  return found;
}

/** Segments of the core's surface in the half plane. */
function outline(core, polar) {
  const { points, corners } = core;
  const [c, s] = [Math.cos(polar), Math.sin(polar)];
  const side = (k) => c * points[3 * k + 2] - s * points[3 * k];
  const segments = [];
  for (let t = 0; t < corners.length; t += 3) {
    const ends = [];
    for (let edge = 0; edge < 3; edge += 1) {
      const [a, b] = [corners[t + edge], corners[t + ((edge + 1) % 3)]];
      const [da, db] = [side(a), side(b)];
      if (da <= 0 === db <= 0) continue;
      const share = da / (da - db);
      const at = (axis) => points[3 * a + axis] + share * (points[3 * b + axis] - points[3 * a + axis]);
      ends.push([at(1), c * at(0) + s * at(2)]);
    }
    if (ends.length === 2 && (ends[0][1] > 0 || ends[1][1] > 0)) segments.push(ends);
  }
  return segments;
}

function drawSection(pen, width, height, run, cut) {
  const d = run.diameter;
  const pad = { left: 50, right: 14, top: 10, bottom: 36 };
  const ys = cut.wires.map((wire) => wire.y);
  const radii = cut.wires.map((wire) => wire.radius);
  pen.fillStyle = css("--soft");
  if (ys.length === 0) {
    pen.textAlign = "center";
    pen.fillText("No wire passes here.", width / 2, height / 2);
    return;
  }
  const [y0, y1] = [Math.min(...ys) - 2 * d, Math.max(...ys) + 2 * d];
  // The core belongs into the picture where wire does not stand too far off.
  const lowest = Math.min(...radii);
  const beneath = cut.core.flat().filter(([y, r]) => y > y0 && y < y1 && r < lowest).map(([, r]) => r);
  const spanning = cut.core.filter(([a, b]) => Math.min(a[0], b[0]) < y0 && Math.max(a[0], b[0]) > y1).map(([a, b]) => Math.min(a[1], b[1]));
  const surface = Math.max(...beneath, ...spanning.filter((r) => r < lowest), lowest - 6 * d);
  const [r0, r1] = [Math.min(surface - 0.4 * d, lowest - 1.1 * d), Math.max(...radii) + 1.2 * d];
  const [across, high] = [width - pad.left - pad.right, height - pad.top - pad.bottom];
  const scale = Math.min(across / (y1 - y0), high / (r1 - r0));
  const x = (y) => pad.left + across / 2 + (y - (y0 + y1) / 2) * scale;
  const up = (r) => pad.top + high / 2 - (r - (r0 + r1) / 2) * scale;
  pen.save();
  pen.beginPath();
  pen.rect(pad.left, pad.top, across, high);
  pen.clip();
  pen.strokeStyle = css("--core");
  pen.lineWidth = 2;
  pen.beginPath();
  for (const [a, b] of cut.core) {
    pen.moveTo(x(a[0]), up(a[1]));
    pen.lineTo(x(b[0]), up(b[1]));
  }
  pen.stroke();
  pen.textAlign = "center";
  const size = Math.min(13, 0.5 * d * scale);
  pen.font = `${size}px system-ui, 'Segoe UI', sans-serif`;
  for (const wire of cut.wires) {
    pen.beginPath();
    pen.arc(x(wire.y), up(wire.radius), 0.5 * d * scale, 0, TURN);
    pen.fillStyle = layerColour(wire.layer);
    pen.fill();
    pen.lineWidth = 1;
    pen.strokeStyle = css("--card");
    pen.stroke();
    if (size >= 7) {
      pen.fillStyle = "#ffffff";
      pen.fillText(`${wire.turn}`, x(wire.y), up(wire.radius) + 0.36 * size);
    }
  }
  pen.restore();
  axes(pen, width, height, pad, { x, up, across, high, scale, middle: [(y0 + y1) / 2, (r0 + r1) / 2] });
}

function axes(pen, width, height, pad, frame) {
  pen.font = "12px system-ui, 'Segoe UI', sans-serif";
  pen.fillStyle = css("--soft");
  pen.strokeStyle = css("--line");
  pen.lineWidth = 1;
  pen.strokeRect(pad.left, pad.top, frame.across, frame.high);
  const wish = 50 / frame.scale;
  const power = 10 ** Math.floor(Math.log10(wish));
  const step = [1, 2, 5, 10].map((k) => k * power).find((value) => value >= wish);
  const count = Math.max(0, -Math.floor(Math.log10(1e3 * step) + 1e-9));
  const ticks = (middle, half) => {
    const found = [];
    for (let k = Math.ceil((middle - half) / step); k * step <= middle + half; k += 1) found.push(k * step);
    return found;
  };
  pen.textAlign = "center";
  for (const y of ticks(frame.middle[0], frame.across / 2 / frame.scale)) {
    pen.fillText((1e3 * y).toFixed(count), frame.x(y), height - pad.bottom + 16);
  }
  pen.fillText("Along the axis, mm", pad.left + frame.across / 2, height - 4);
  pen.textAlign = "right";
  for (const r of ticks(frame.middle[1], frame.high / 2 / frame.scale)) pen.fillText((1e3 * r).toFixed(count), pad.left - 6, frame.up(r) + 4);
  pen.save();
  pen.translate(11, pad.top + frame.high / 2);
  pen.rotate(-Math.PI / 2);
  pen.textAlign = "center";
  pen.fillText("From the axis, mm", 0, 0);
  pen.restore();
}
