// The page: reads the data, and lays out one run, or two side by side.

const GOOD = ["aligned"];
/** Kinds after which no more is wound. */
const ENDS = new Set(["break", "collision", "runaway"]);
const BAD = DEFECTS.map((kind) => kind.name);

/** What the parts of the page need of a run: `beside` are all on the page, `all` those that share its scales. */
class Run {
  constructor(data) {
    this.name = data.name;
    this.summary = data.summary;
    this.woundTo = data.wound_to;
    this.defects = data.summary.defects ?? [];
    this.diameter = data.summary.product.enamelled_diameter_m ?? data.summary.product.wire_diameter_m;
    this.enamelled = this.diameter > data.summary.product.wire_diameter_m;
    this.faces = data.summary.product.window?.faces_m ?? null;
    this.history = decodeAll(data.history);
    this.stations = decodeAll(data.stations);
    this.wire = decodeAll(data.wire);
    this.core = decodeAll(data.core);
    this.frames = data.frames.map((frame) => ({ ...frame, wire: decodeAll(frame.wire) }));
    // Faults of the wire itself have a place, but no stretch of wire is marked with them: the view shows balls there, if there is one.
    this.marked = (this.wire?.defect ?? []).reduce((sum, bits) => sum | bits, 0);
    this.balls = !this.wire ? [] : this.defects.filter((defect) => defect.place_m && !(defectOf(defect.kind).bit & this.marked));
    if (this.wire) this.measure();
  }

  /** Turns from the clamp at every node, the way round, where the coil ends, and how large it is. */
  measure() {
    const { points, bulge } = this.wire;
    const nodes = bulge.length;
    const angles = new Float64Array(nodes);
    const polar = (k) => Math.atan2(points[3 * k + 2], points[3 * k]);
    for (let k = 1; k < nodes; k += 1) {
      const step = polar(k) - polar(k - 1);
      angles[k] = angles[k - 1] + step - TURN * Math.round(step / TURN);
    }
    this.direction = angles[nodes - 1] < 0 ? -1 : 1;
    this.turnOf = angles.map((angle) => Math.max(0, (this.direction * angle) / TURN));
    // Laid: all that has come to rest, and live wire as near to the axis as that.
    const radius = (k) => Math.hypot(points[3 * k], points[3 * k + 2]);
    let rest = 0;
    let far = 0;
    for (let k = 0; k < nodes; k += 1) if (Number.isFinite(bulge[k])) [rest, far] = [k + 1, Math.max(far, radius(k))];
    if (rest === 0) far = this.coreRadius() + 2 * this.diameter;
    let laid = rest;
    while (laid < nodes && radius(laid) < far + 2 * this.diameter) laid += 1;
    this.laid = Math.max(laid, Math.min(2, nodes));
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let k = 0; k < this.laid; k += 1) {
      for (let axis = 0; axis < 3; axis += 1) {
        low[axis] = Math.min(low[axis], points[3 * k + axis]);
        high[axis] = Math.max(high[axis], points[3 * k + axis]);
      }
    }
    const middle = low.map((value, axis) => (value + high[axis]) / 2);
    const across = Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2;
    this.extent = { middle, radius: Math.max(across, this.coreRadius(), 4 * this.diameter) };
  }

  /** Largest distance of the core from the axis where wire lies, m. */
  coreRadius() {
    let most = 0;
    const points = this.core?.points ?? [];
    for (let k = 0; k < points.length; k += 3) most = Math.max(most, Math.hypot(points[k], points[k + 2]));
    return Math.min(most, 1);
  }

  /** Turns of the spindle at a time, s. */
  turnsAt(time) {
    if (!this.history) return null;
    const k = Math.min(lowerBound(this.history.time, time * (1 - 1e-6)), this.history.time.length - 1);
    return Math.abs(this.history.angle[k]) / TURN;
  }

  /** The first time, s, by which so many turns of wire were wound; Infinity where they never were. */
  timeOf(turns) {
    const k = this.history ? this.history.wound.findIndex((wound) => wound >= turns) : -1;
    return k < 0 ? Infinity : this.history.time[k];
  }

  /** Moves the view to a place of the wire, in turns from the clamp. */
  goTo(turn) {
    this.choose(null);
    if (!this.view?.renderer) return;
    const k = Math.min(lowerBound(this.turnOf, turn), this.laid - 1);
    const { points, tension, gap, bulge, layer } = this.wire;
    const at = this.turnOf[k];
    const words = [`turn ${Math.floor(at) + 1}, ${Math.round((at % 1) * STATIONS)}°`, `tension ${digits(tension[k])} N`];
    if (Number.isFinite(gap[k])) words.push(`gap ${mm(gap[k])}`);
    if (Number.isFinite(bulge[k])) words.push(`bulge ${mm(bulge[k])}`, `layer ${layer[k]}`);
    this.view.goTo(points.subarray(3 * k, 3 * k + 3), words.join("  ·  "), at, this.timeOf(at));
  }

  goToDefect(defect) {
    const size = defect.size_m == null ? "" : `  ·  ${sizeOf(defect)}`;
    const words = `${plainName(defect.kind)}  ·  turn ${defect.turn}, ${Math.round(defect.angle_deg)}°${size}`;
    if (this.view?.renderer) this.view.goTo(defect.place_m, words, defect.turn - 1 + defect.angle_deg / STATIONS, defect.time_s);
    this.choose(defect);
  }

  /** Marks the row of the defect that the view shows; no defect marks none. */
  choose(defect) {
    const rows = this.rows?.querySelectorAll("tr") ?? [];
    rows.forEach((row) => row.classList.toggle("chosen", row.defect === defect));
  }
}

function head(run) {
  const s = run.summary;
  const kind = GOOD.includes(s.verdict) ? "good" : s.verdict === "marginal" ? "fair" : BAD.includes(s.verdict) ? "bad" : "";
  const end = run.defects.find((defect) => ENDS.has(defect.kind));
  const status = { done: end ? `winding ended with a ${plainName(end.kind)}` : run.woundTo, interrupted: "interrupted", failed: s.reasons ? "failed before its planned end" : `failed: ${s.reason}` }[s.status] ?? s.status;
  const rpm = (s.speed_rad_per_s * 30) / Math.PI;
  const meta = [status, `${fixed(s.turns_wound, 2)} turns wound, ${fixed(s.turns_settled, 2)} at rest`,
    `${duration(s.simulated_s)} simulated`, `d is the diameter of the wire${run.enamelled ? " over its enamel" : ""}, ${digits(1e3 * run.diameter)} mm`, `${digits(s.speed_rad_per_s)} rad/s (${Math.round(rpm)} rpm) at the end`, `folder ${run.name}`];
  return el("header", {},
    el("h1", {}, s.scene || run.name, el("span", { class: `pill ${kind}` }, plainName(s.verdict))),
    el("ul", { class: "reasons" }, ...(s.reasons ?? []).map((reason) => el("li", {}, `${reason}.`))),
    el("p", { class: "meta" }, meta.join("  ·  ")));
}

/** Share of metal in the winding window, or of wire in the coil where there is no window. */
function fill(p) {
  if (p.window) return [["Metal in window", fixed(100 * p.window.fill_bare, 1), "%"]];
  return [p.fill > 0 ? ["Fill factor", fixed(100 * p.fill, 1), "%"] : ["Fill factor", "–", ""]];
}

function product(run) {
  const p = run.summary.product;
  const ohm = p.resistance_ohm < 1 ? [digits(1e3 * p.resistance_ohm), "mΩ"] : [digits(p.resistance_ohm), "Ω"];
  const figures = [
    ["Turns at rest", fixed(p.turns, 2), ""], ["Layers", p.layers, ""], ["Wire length", digits(p.wire_length_m, 4), "m"],
    ["Resistance at 20 °C", ...ohm], ...fill(p), ["Wire diameter", digits(1e3 * p.wire_diameter_m), "mm"],
  ];
  if (run.history) {
    const [least, most] = [Math.min(...run.history.tension_min), Math.max(...run.history.tension_max)];
    // two digits of the largest, and the same decimals of the least
    const decimals = most > 0 ? Math.max(0, 1 - Math.floor(Math.log10(most))) : 0;
    figures.push(["Tension at the nozzle", `${fixed(least, decimals)} to ${digits(most, 2)}`, "N"]);
  }
  if (run.enamelled) figures.push(["Over the enamel", digits(1e3 * p.enamelled_diameter_m), "mm"]);
  if (p.clearance_m != null) figures.push(["Clearance in window", digits(1e3 * p.clearance_m), "mm"]);
  return el("dl", { class: "product" }, ...figures.map(([name, value, unit]) =>
    el("div", {}, el("dt", {}, name), el("dd", {}, `${value} `, el("small", {}, unit)))));
}

/** How large a defect is, in the words of the reasons: jumps count in turns, and stretch is that of a turn. */
function sizeOf(defect) {
  if (defect.size_m == null) return null;
  if (defect.kind.endsWith("_jump")) return `${fixed(defect.size_d, 1)} turns`;
  if (defect.kind === "overstretch") return `${mm(defect.size_m)} a turn`;
  return `${mm(defect.size_m)} (${fixed(defect.size_d, 2)} d)`;
}

function defects(run) {
  const table = el("table", { class: "defects" },
    el("thead", {}, el("tr", {}, ...["Defect", "Turn", "Layer", "Angle", "Time", "Size"].map((name) => el("th", {}, name)))),
    run.rows = el("tbody", {}, ...run.defects.slice(0, 500).map((defect) => {
      const size = sizeOf(defect) ?? "–";
      const kind = el("span", { class: "kind" }, dot(pageColour(defect.kind)), plainName(defect.kind));
      const cells = [kind, defect.turn, defect.layer, `${Math.round(defect.angle_deg)}°`, duration(defect.time_s), size];
      const go = () => run.goToDefect(defect);
      const row = el("tr", { tabindex: 0, onclick: go, onkeydown: (event) => event.key === "Enter" && go() }, ...cells.map((cell) => el("td", {}, cell)));
      row.defect = defect;
      return row;
    })));
  const count = run.defects.length;
  const title = el("div", { class: "bar" }, el("h2", {}, count ? `Defects (${count})` : "Defects"));
  const more = count > 500 ? el("p", { class: "note" }, "The first 500; all stand in defects.csv.") : null;
  const body = count ? el("div", { class: "scroll" }, table) : el("p", { class: "soft" }, run.summary.status === "failed" ? "None found until the run failed." : "None found.");
  return el("section", { class: "card" }, title, body, count && run.view?.renderer ? el("p", { class: "note" }, "A click moves the view there.") : null, more);
}

function trust(run) {
  const { energy: e, penetration: p, summary: _, ...s } = run.summary;
  const judged = s.bulge_judged ?? {};
  const rows = [
    ["Energy that is not accounted for", `${digits(100 * e.residual_over_dissipated)} % of what was dissipated`],
    ["Deepest contact at rest", `${digits(100 * p.at_rest_over_d)} % of the diameter`],
    ["Bulge judged by", judged.by === "over_rest" ? `${mm(judged.limit_m)} over the height at rest` : `${mm(judged.limit_m)}`],
    ["Steps of the solver", `${s.steps}`],
    ["Computed in", `${duration(s.wall_s)} (real-time factor ${digits(s.real_time_factor)})`],
  ];
  return el("section", { class: "card" }, el("div", { class: "bar" }, el("h2", {}, "How far to trust it")),
    el("div", { class: "scroll" }, el("table", { class: "words" }, el("tbody", {}, ...rows.map(([name, value]) => el("tr", {}, el("td", {}, name), el("td", {}, value)))))));
}

/** A place that is empty, so that two runs side by side stay in line. */
const nothing = (title, why) => el("section", { class: "card" }, el("div", { class: "bar" }, el("h2", {}, title)), el("p", { class: "soft" }, why));

function layOut(run) {
  if (run.wire) run.view = new View(run);
  const curves = charts(run);
  const noWire = "The folder has no coil.vtp, as after --no-geometry, or no wire was wound.";
  return el("article", { class: "run" },
    head(run), product(run),
    run.view ? run.view.card() : nothing("Coil", noWire),
    el("div", { class: "two" }, defects(run), trust(run)),
    curves.length ? el("div", { class: "two" }, ...curves) : nothing("Tension and torque", "history.csv is missing."),
    defectMap(run) ?? nothing("Defect map", run.stations ? "No wire has come to rest." : "stations.csv is missing."),
    crossSection(run) ?? nothing("Cross-section", noWire));
}

/** Whether two runs wound the same wire, so that lengths and pulls of the one say something of the other. */
function sameWire(one, other) {
  const [a, b] = [one, other].map(({ summary: { product: p } }) => [p.material, p.wire_diameter_m, p.enamelled_diameter_m]);
  return a.every((value, k) => value === b[k]);
}
/** Whether other runs on the page have scales of their own. */
const apart = (sharing) => sharing.length < sharing[0].beside.length;

/** What differs between the scenes and options of two runs, and what that means for the scales of the page. */
function comparison() {
  const [differences, names] = [data.differences, runs.map((run, k) => `${["First", "Second"][k]}: ${run.name}`)];
  const scales = apart(runs[0].all) ? "The wires differ, so each run has its own scales of colours and curves."
    : "The wire is the same, so both runs share their scales of colours, tension and torque.";
  const what = differences == null ? "The scene of a run is missing (scene.toml), so what differs is not known."
    : differences.length === 0 ? "The scenes and the options of the runs are the same." : null;
  const table = what ? null : el("div", { class: "scroll" }, el("table", { class: "words" },
    el("thead", {}, el("tr", {}, ...["In the scene or its options", ...names].map((name) => el("th", {}, name)))),
    el("tbody", {}, ...differences.map(({ name, meaning, values }) =>
      el("tr", {}, el("td", {}, meaning, " ", el("code", {}, name)), ...values.map((value) => el("td", {}, value || "–")))))));
  return el("section", { class: "card differences" }, el("div", { class: "bar" }, el("h2", {}, "What differs")),
    table, el("p", { class: "note" }, [what, scales].filter(Boolean).join(" ")));
}

const data = JSON.parse(document.getElementById("data").textContent);
const page = document.getElementById("page");
page.classList.toggle("pair", data.runs.length > 1);
const runs = data.runs.map((one) => new Run(one));
for (const run of runs) [run.beside, run.all] = [runs, runs.every((other) => sameWire(run, other)) ? runs : [run]];
if (runs.length > 1) page.append(comparison());
page.append(...runs.map(layOut));
runs.forEach((run) => run.view?.resize());
requestAnimationFrame(() => requestAnimationFrame(() => {
  runs.forEach((run) => run.view?.painter?.wait());
  // The picture needs a moment more to come to the screen.
  setTimeout(doWhatWaits, 100);
}));
document.getElementById("made").textContent = `Made by coilwind ${data.version} from the files of the run. Contains three.js and uPlot.`;
