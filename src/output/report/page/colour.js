// Colours: a ramp for measures, which also reads in grey and with weak colour vision, and keys for kinds.

const RAMP = ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6dcd59", "#b4de2c", "#fde725"];
const LAYERS = ["#c8793f", "#4f86b8", "#5fa36a", "#b45f8f", "#d0a93b", "#7a6bb5", "#48a5a8", "#a6704f"];
const DEFECTS = [
  { name: "slack", bit: 16, colour: "#2b76d5" },
  { name: "loose_turn", bit: 512, colour: "#5aa9a0" },
  { name: "bulge", bit: 1, colour: "#e0a100" },
  { name: "gap", bit: 2, colour: "#d5422b" },
  { name: "late_jump", bit: 256, colour: "#8a7a2b" },
  { name: "early_jump", bit: 128, colour: "#b5651d" },
  { name: "skipped_groove", bit: 64, colour: "#c2417c" },
  { name: "overlap", bit: 4, colour: "#a02bb0" },
  { name: "double_turn", bit: 32, colour: "#6a1fb0" },
  { name: "overstretch", bit: 1024, colour: "#7a1f1f" },
  { name: "collision", bit: 2048, colour: "#333333" },
  { name: "runaway", bit: 4096, colour: "#555555" },
  { name: "break", bit: 8, colour: "#111111" },
];
const PLAIN = "#c08457";
const UNKNOWN = "#9aa0a6";

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const RAMP_RGB = RAMP.map(rgb);

/** Red, green and blue, 0 to 255, of a share from 0 to 1. */
function ramp(share) {
  const at = Math.min(Math.max(share, 0), 1) * (RAMP.length - 1);
  const low = Math.min(Math.floor(at), RAMP.length - 2);
  return [0, 1, 2].map((k) => RAMP_RGB[low][k] + (at - low) * (RAMP_RGB[low + 1][k] - RAMP_RGB[low][k]));
}

/** What wire is coloured by. `scale` takes SI to the unit. */
const QUANTITIES = {
  tension: { label: "Tension", unit: "N", scale: 1 },
  plastic_strain: { label: "Plastic strain", unit: "%", scale: 100 },
  gap: { label: "Gap to the neighbour", unit: "mm", scale: 1e3 },
  bulge: { label: "Bulge", unit: "mm", scale: 1e3 },
  bulge_excess: { label: "Bulge beyond that at rest", unit: "mm", scale: 1e3 },
  layer: { label: "Layer", kinds: true },
  defect: { label: "Defect", kinds: true },
};

const layerColour = (layer) => (layer === 0 ? UNKNOWN : LAYERS[(layer - 1) % LAYERS.length]);
function defectColour(bits) {
  const worst = DEFECTS.findLast((kind) => bits & kind.bit);
  return worst ? worst.colour : PLAIN;
}
const defectOf = (name) => DEFECTS.find((kind) => kind.name === name) ?? { name, bit: 0, colour: UNKNOWN };
/** The colour of a kind on the page itself, where black would vanish in the dark: for the style sheet, and as it is now. */
const pageColour = (name) => `var(--kind-${name}, ${defectOf(name).colour})`;
const lineColour = (name) => css(`--kind-${name}`) || defectOf(name).colour;

/** The name of a kind of defect as it is read; tables on disk have it with underscores. */
const plainName = (kind) => kind.replaceAll("_", " ");

/** Kinds of the defects with a place, the mildest first, and whether they are drawn along the wire or as balls. */
function kindsOf(runs) {
  const places = runs.flatMap((run) => run.defects.filter((defect) => defect.place_m).map((defect) => defect.kind));
  const onWire = runs.reduce((bits, run) => bits | run.marked, 0);
  const named = DEFECTS.filter((kind) => kind.bit & onWire || places.includes(kind.name));
  const strange = [...new Set(places)].filter((name) => !DEFECTS.some((kind) => kind.name === name)).map(defectOf);
  return [...named, ...strange].map((kind) => ({ ...kind, ball: runs.some((run) => run.balls.some((ball) => ball.kind === kind.name)) }));
}

/** Share of the diameter that gaps span at least on the scale: the limit of a gap where the scene sets no other. */
const GAP_LIMIT = 0.15;

/** Whether a run judges bulges by what they stand higher than drawn wire at rest. */
const overRest = (run) => run.summary.bulge_judged?.by === "over_rest";

/** What a scale spans at least, m, so that it does not make structure of noise, and what that is; null for others. */
function floorOf(key, runs) {
  const most = (of) => Math.max(...runs.map(of));
  if (key === "gap") {
    const least = GAP_LIMIT * most((run) => run.diameter);
    return { least, words: `${mm(least)} (${GAP_LIMIT} d)` };
  }
  if (key === "bulge" && runs.every(overRest)) {
    return { least: 0.5 * most((run) => run.diameter), words: "half a diameter" };
  }
  if (key === "bulge" || key === "bulge_excess") {
    const least = most((run) => run.summary.bulge_judged?.limit_m ?? 0.5 * run.diameter);
    const alike = runs.every((run) => run.summary.bulge_judged?.limit_m === runs[0].summary.bulge_judged?.limit_m);
    return { least, words: `${mm(least)}, the ${alike ? "" : "larger "}limit of a bulge` };
  }
  return null;
}

/** A function from a value to red, green and blue, 0 to 255, and the range that it spans. */
function colouring(key, values, runs) {
  if (key === "layer") return { of: cached((layer) => rgb(layerColour(layer))) };
  if (key === "defect") return { of: cached((bits) => rgb(defectColour(bits))) };
  let range = span(values);
  const unknown = rgb(UNKNOWN);
  if (range[0] === range[1]) {
    const one = ramp(0.5);
    return { range, of: (value) => (Number.isFinite(value) ? one : unknown) };
  }
  const floor = floorOf(key, runs);
  const raised = floor && range[1] - range[0] < floor.least ? floor : null;
  if (raised) range = [range[0], range[0] + raised.least];
  return {
    range, raised,
    of: (value) => (Number.isFinite(value) ? ramp((value - range[0]) / (range[1] - range[0])) : unknown),
  };
}

function cached(make) {
  const made = new Map();
  return (key) => {
    if (!made.has(key)) made.set(key, make(key));
    return made.get(key);
  };
}

/** The legend of a colouring of these values as an element's children; `runs` share its scale. */
function legend(key, colours, values, runs) {
  const { label, unit, scale } = QUANTITIES[key];
  const alone = colours.range && apart(runs) ? el("div", { class: "soft" }, "Scale of this run alone: the wires differ.") : null;
  if (colours.range && !values.some(Number.isFinite)) return [el("div", {}, label), keys([["not measured", UNKNOWN]])];
  const lacks = values.some((value) => !Number.isFinite(value));
  if (colours.range && colours.range[0] === colours.range[1]) {
    const one = `rgb(${colours.of(colours.range[0]).map(Math.round).join(" ")})`;
    const named = [[`${digits(scale * colours.range[0])} ${unit} everywhere`, one], ...(lacks ? [["not measured", UNKNOWN]] : [])];
    return [el("div", {}, label), keys(named), alone].filter(Boolean);
  }
  if (colours.range) {
    const stops = RAMP.join(", ");
    const across = scale * (colours.range[1] - colours.range[0]);
    const count = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(across))));
    const name = (value) => `${fixed(scale * value, count)} ${unit}`;
    const reach = extremes(values);
    // Values that lie beyond an end have its colour. Those that read the same as the end are not worth a word.
    const beyond = [reach[0] < colours.range[0], reach[1] > colours.range[1]].map((lies, end) => lies && name(reach[end]) !== name(colours.range[end]));
    const ends = colours.range.map((value, end) => `${beyond[end] ? ["≤ ", "≥ "][end] : ""}${name(value)}`);
    return [
      el("div", {}, label),
      el("div", { class: "ramp", style: `background: linear-gradient(90deg, ${stops})` }),
      el("div", { class: "ends" }, ...ends.map((text) => el("span", {}, text))),
      beyond.includes(true) ? el("div", { class: "soft" }, `Colours end there; values reach from ${name(reach[0])} to ${name(reach[1])}.`) : null,
      colours.raised ? el("div", { class: "soft" }, `The scale spans at least ${colours.raised.words}.`) : null,
      alone,
      lacks ? keys([["not measured", UNKNOWN]]) : null,
    ].filter(Boolean);
  }
  const present = [...new Set(values)].sort((a, b) => a - b);
  if (key === "layer") {
    const named = present.map((layer) => [layer === 0 ? "not at rest" : `${layer}`, layerColour(layer)]);
    return [el("div", {}, label), keys(named)];
  }
  const found = kindsOf(runs).map((kind) => [kind.ball ? `${plainName(kind.name)} (ball)` : plainName(kind.name), kind.ball ? pageColour(kind.name) : kind.colour]);
  return [el("div", {}, label), keys([["none", PLAIN], ...found])];
}

/** Names with their colours, as dots or as rings. */
function keys(named, shape = "dots") {
  const entry = ([text, colour]) => el("span", {}, dot(colour), text);
  return el("div", { class: `keys ${shape}` }, ...named.map(entry));
}
const dot = (colour) => el("i", { class: "dot", style: `--kind: ${colour}` });
