"use strict";
// Arrays, elements and numbers: what every part of the page uses. SI units, lengths in the core frame.

const KINDS = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array };
const TURN = 2 * Math.PI;
const STATIONS = 360;

/** The array of a text such as `f32:BASE64`. */
function decode(text) {
  const at = text.indexOf(":");
  const letters = atob(text.slice(at + 1));
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < bytes.length; k += 1) bytes[k] = letters.charCodeAt(k);
  return new KINDS[text.slice(0, at)](bytes.buffer);
}

/** The arrays of an object, or null. */
function decodeAll(object) {
  return object && Object.fromEntries(Object.entries(object).map(([name, text]) => [name, decode(text)]));
}

/** An element with attributes, listeners (`onclick`) and children. */
function el(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value != null) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child != null));
  return made;
}

/** A colour of the style sheet as it is now, light or dark. */
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Calls back where the page turns light or dark. */
function onTheme(changed) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
}

/** A number with so many digits that count; a dash where there is none. */
function digits(value, count = 3) {
  if (value == null || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  if (magnitude < -4 || magnitude > 5) return value.toExponential(count - 1).replace("e", " · 10^");
  return value.toFixed(Math.min(8, Math.max(0, count - 1 - magnitude)));
}
/** A number with so many digits after the point; no minus before a zero. */
const fixed = (value, count) => (value == null || !Number.isFinite(value) ? "–" : value.toFixed(count).replace(/^-(0\.?0*)$/, "$1"));
const mm = (metres, count = 3) => `${fixed(1e3 * metres, count)} mm`;

/** A time, s, in a unit that suits it. */
function duration(seconds) {
  if (seconds >= 120) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
  return seconds >= 1 ? `${digits(seconds)} s` : `${digits(1e3 * seconds)} ms`;
}

/** Index of the first of sorted values that is not below x. */
function lowerBound(values, x) {
  let [low, high] = [0, values.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Differences of a value below this share of it are those of numbers with four bytes. */
const SAME = 1e-6;
/** Least and largest of the finite values, or null without any. */
function extremes(values) {
  let [least, most] = [Infinity, -Infinity];
  for (const value of values) if (Number.isFinite(value)) [least, most] = [Math.min(least, value), Math.max(most, value)];
  return least <= most ? [least, most] : null;
}

/** Least and largest of the finite values, without the outermost hundredth at either end; the same number twice where
 * all are equal. */
function span(values) {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  if (sorted.length === 0) return [0, 0];
  const at = (share) => sorted[Math.round(share * (sorted.length - 1))];
  const differ = ([least, most]) => most - least > SAME * Math.max(Math.abs(least), Math.abs(most));
  // A field that differs in less than a hundredth of its places is not constant.
  return [[at(0.01), at(0.99)], [at(0), at(1)]].find(differ) ?? [at(0.5), at(0.5)];
}

/** Buttons of which one is pressed. */
function choice(names, chosen, choose) {
  const buttons = Object.entries(names).map(([key, text]) => el("button", {
    type: "button", "data-key": key, "aria-pressed": String(key === chosen),
    onclick: () => {
      buttons.forEach((b) => b.setAttribute("aria-pressed", String(b.dataset.key === key)));
      choose(key);
    },
  }, text));
  return el("span", { class: "group", role: "group" }, ...buttons);
}

/** Work that waits until the page has shown its first picture, in the order of the page. */
const waiting = [];
const later = (work) => waiting.push(work);

/** Does the work that waits, a piece between two pictures, so that the page answers meanwhile. */
function doWhatWaits() {
  const next = waiting.shift();
  if (!next) return void (document.body.dataset.whole = "yes");
  // First, so that a piece that fails takes no other with it.
  setTimeout(doWhatWaits);
  next();
}

/** A canvas in the pixels of the screen that draws itself again when its width or the theme changes; first when all else is shown. */
function canvas(height, draw, attributes = {}) {
  const made = el("canvas", { class: "own", ...attributes });
  const paint = () => {
    const [width, tall, ratio] = [made.clientWidth, height(made.clientWidth), devicePixelRatio || 1];
    if (width === 0) return;
    made.style.height = `${tall}px`;
    made.width = Math.round(width * ratio);
    made.height = Math.round(tall * ratio);
    const pen = made.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, 'Segoe UI', sans-serif";
    draw(pen, width, tall);
  };
  let before = 0;
  const fit = () => {
    if (made.clientWidth === before) return;
    before = made.clientWidth;
    paint();
  };
  later(() => {
    fit();
    new ResizeObserver(fit).observe(made);
    onTheme(paint);
  });
  made.paint = paint;
  return made;
}
