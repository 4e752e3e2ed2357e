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
  bulge: { label: "Height over its bed", unit: "mm", scale: 1e3 },
  layer: { label: "Layer", kinds: true },
  defect: { label: "Defect", kinds: true },
};

const layerColour = (layer) => (layer === 0 ? UNKNOWN : LAYERS[(layer - 1) % LAYERS.length]);
function defectColour(bits) {
  const worst = DEFECTS.findLast((kind) => bits & kind.bit);
  return worst ? worst.colour : PLAIN;
}
const defectOf = (name) => DEFECTS.find((kind) => kind.name === name) ?? { colour: UNKNOWN };

/** A function from a value to red, green and blue, 0 to 255, and the range that it spans. */
function colouring(key, values) {
  if (key === "layer") return { of: cached((layer) => rgb(layerColour(layer))) };
  if (key === "defect") return { of: cached((bits) => rgb(defectColour(bits))) };
  const range = span(values);
  const unknown = rgb(UNKNOWN);
  return {
    range,
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

/** The legend of a colouring as an element's children. */
function legend(key, colours, values) {
  const { label, unit, scale } = QUANTITIES[key];
  if (colours.range && !values.some(Number.isFinite)) return [el("div", {}, label), keys([["not measured", UNKNOWN]])];
  if (colours.range) {
    const stops = RAMP.join(", ");
    const across = scale * (colours.range[1] - colours.range[0]);
    const count = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(across))));
    const ends = colours.range.map((value) => `${fixed(scale * value, count)} ${unit}`);
    const lacks = values.some((value) => !Number.isFinite(value));
    return [
      el("div", {}, label),
      el("div", { class: "ramp", style: `background: linear-gradient(90deg, ${stops})` }),
      el("div", { class: "ends" }, ...ends.map((text) => el("span", {}, text))),
      lacks ? keys([["not measured", UNKNOWN]]) : null,
    ].filter(Boolean);
  }
  const present = [...new Set(values)].sort((a, b) => a - b);
  if (key === "layer") {
    const named = present.map((layer) => [layer === 0 ? "not at rest" : `${layer}`, layerColour(layer)]);
    return [el("div", {}, label), keys(named)];
  }
  const found = DEFECTS.filter((kind) => present.some((bits) => bits & kind.bit));
  return [el("div", {}, label), keys([["none", PLAIN], ...found.map((kind) => [kind.name, kind.colour])])];
}

function keys(named) {
  const entry = ([text, colour]) => el("span", {}, el("i", { style: `background: ${colour}` }), text);
  return el("div", { class: "keys" }, ...named.map(entry));
}
