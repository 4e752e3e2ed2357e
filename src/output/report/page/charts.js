// Curves over the turns of the spindle, by uPlot.

/** Kinds that happen to the wire at an instant. The others are found in wire at rest. */
const HAPPENS = new Set(["slack", "break", "collision", "runaway"]);

/** Tension and torque of a run; a click goes to that place of the wire. */
function charts(run) {
  const history = run.history;
  if (!history) return [];
  const turns = Array.from(history.angle, (angle) => Math.abs(angle) / TURN);
  // A spindle that turns back would draw over what was there: then over time.
  const forward = turns.every((turn, k) => k === 0 || turn >= turns[k - 1]);
  const x = forward ? turns : Array.from(history.time, (time) => 1e3 * time);
  const axis = forward ? "Turns of the spindle" : "Time, ms";
  const when = (d) => (forward ? run.turnsAt(d.time_s) : 1e3 * d.time_s);
  // Where the spindle was when this wire was wound: it is ahead of the wire by the free span's part of a turn.
  const laid = (d) => (forward ? between(history.wound, turns, d.turn - 1 + d.angle_deg / STATIONS) : null);
  const marks = run.defects.map((d) => [HAPPENS.has(d.kind) ? when(d) : laid(d), d.kind]).filter(([at]) => at != null);
  const plain = (array, scale = 1) => Array.from(array, (value) => scale * value);
  const go = forward ? (turn) => run.goTo(between(turns, history.wound, turn)) : () => {};
  const happened = [...HAPPENS].filter((kind) => marks.some(([, marked]) => marked === kind));
  const lying = marks.some(([, kind]) => !HAPPENS.has(kind)) ? "defects, where their wire was wound" : null;
  const words = [lying, happened.length ? `${happened.join(", ")}, at the instant of it` : null].filter(Boolean);
  const layers = begun(history.layer, x);
  const numbers = layers.map(([, number]) => number).join(", ");
  const begin = layers.length ? `Thin lines: begin of layer ${numbers}.` : null;
  const note = [words.length ? `Dashed: ${words.join("; ")}.` : null, begin].filter(Boolean).join(" ") || null;
  const torque = plain(history.torque, 1e3);
  // Runs of one wire side by side are compared by eye, which takes one scale.
  const over = (scale, ...names) => {
    if (run.all.length < 2) return null;
    let [low, high] = [Infinity, -Infinity];
    for (const { history: one } of run.all) {
      for (const name of one ? names : []) {
        for (const value of one[name]) [low, high] = [Math.min(low, scale * value), Math.max(high, scale * value)];
      }
    }
    const room = 0.05 * (high - low) || 1;
    return [low - room, high + room];
  };
  const alone = apart(run.all) ? "Scale of this run alone: the wires differ." : null;
  const told = (...parts) => parts.filter(Boolean).join(" ") || null;
  return [
    chart("Tension at the nozzle", axis, x, "N", [
      { label: "tension", values: plain(history.tension), width: 1.4 },
      { label: "least", values: plain(history.tension_min), band: true },
      { label: "largest", values: plain(history.tension_max), band: true },
    ], [marks, layers], go, told(note, alone), over(1, "tension", "tension_min", "tension_max")),
    chart("Torque of the wire on the core", axis, x, "mN.m", [{ label: "torque", values: torque, width: 1.4 }], [marks, layers], go,
      told(resists(history.angle), alone), over(1e3, "torque")),
  ];
}

/** Value of a curve over places that never fall, linear between them. */
function between(places, values, at) {
  const k = Math.min(lowerBound(places, at), places.length - 1);
  const [low, high] = [places[Math.max(k - 1, 0)], places[k]];
  const share = high > low ? Math.min(Math.max((at - low) / (high - low), 0), 1) : 1;
  return values[Math.max(k - 1, 0)] * (1 - share) + values[k] * share;
}

/** Which sign the torque has where the wire resists a spindle that has turned through these angles. */
function resists(angles) {
  const turnsBack = angles.some((angle, k) => k > 0 && Math.abs(angle) < Math.abs(angles[k - 1]));
  if (turnsBack) return "Its sign is not that of the speed where the wire resists the spindle.";
  return `${angles[angles.length - 1] < 0 ? "Positive" : "Negative"} where the wire resists the spindle.`;
}

/** Where each layer but the first begins, with its number. */
function begun(layer, x) {
  const found = [];
  let highest = layer[0];
  layer.forEach((number, k) => {
    if (number <= highest) return;
    highest = number;
    found.push([x[k], number]);
  });
  return found;
}

function chart(title, axis, x, unit, curves, [marks, layers], go, note, range) {
  const box = el("div", { class: "plot" });
  const section = el("section", { class: "card chart" }, el("div", { class: "bar" }, el("h2", {}, title)), box,
    note ? el("p", { class: "note" }, note) : null);
  const grid = { stroke: () => css("--line"), width: 1 };
  // (as wide as the longest number beside the label)
  const wide = (u, values) => Math.max(46, 26 + 7 * Math.max(0, ...(values ?? []).map((value) => String(value).length)));
  const axes = [
    { label: axis, labelSize: 20, labelFont: "12px system-ui", font: "12px system-ui", stroke: () => css("--soft"), grid, ticks: grid, size: 34 },
    { label: unit, labelSize: 18, labelFont: "12px system-ui", font: "12px system-ui", stroke: () => css("--soft"), grid, ticks: grid, size: wide },
  ];
  const tell = (u, value) => (value == null ? "–" : `${digits(value)} ${unit}`);
  const series = curves.map((curve) => ({
    label: curve.label, value: tell, width: curve.width ?? 0.6, points: { show: false },
    stroke: () => css(curve.band ? "--edge" : "--curve"),
  }));
  const options = {
    width: 500, height: 250, axes, cursor: { drag: { x: true, y: false } },
    scales: { x: { time: false }, ...(range ? { y: { range } } : {}) },
    series: [{ label: axis, value: (u, value) => (value == null ? "–" : value.toFixed(3)) }, ...series],
    bands: curves.length === 3 ? [{ series: [3, 2], fill: () => css("--band") }] : [],
    hooks: { draw: [(u) => drawLayers(u, layers), (u) => drawMarks(u, marks)] },
  };
  later(() => {
    options.width = box.clientWidth || options.width;
    const plot = new Vendor.uPlot(options, [x, ...curves.map((curve) => curve.values)], box);
    plot.over.addEventListener("click", () => {
      if (plot.cursor.left >= 0) go(plot.posToVal(plot.cursor.left, "x"));
    });
    const fit = () => box.clientWidth && box.clientWidth !== plot.width && plot.setSize({ width: box.clientWidth, height: 250 });
    new ResizeObserver(fit).observe(box);
    onTheme(() => plot.redraw());
  });
  return section;
}

function drawLayers(u, layers) {
  const pen = u.ctx;
  const { left, top, width, height } = u.bbox;
  pen.save();
  pen.lineWidth = devicePixelRatio;
  pen.font = `${11 * devicePixelRatio}px system-ui`;
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.strokeStyle = pen.fillStyle = css("--soft");
  for (const [at, number] of layers) {
    const x = u.valToPos(at, "x", true);
    if (x < left || x > left + width) continue;
    pen.beginPath();
    pen.moveTo(x, top);
    pen.lineTo(x, top + height);
    pen.stroke();
    pen.fillText(`layer ${number}`, x + 4 * devicePixelRatio, top);
  }
  pen.restore();
}

function drawMarks(u, marks) {
  const pen = u.ctx;
  const { left, top, width, height } = u.bbox;
  pen.save();
  pen.setLineDash([5, 4]);
  pen.lineWidth = 1.2 * devicePixelRatio;
  for (const [at, kind] of marks) {
    const x = u.valToPos(at, "x", true);
    if (x < left || x > left + width) continue;
    pen.strokeStyle = lineColour(kind);
    pen.beginPath();
    pen.moveTo(x, top);
    pen.lineTo(x, top + height);
    pen.stroke();
  }
  pen.restore();
}
