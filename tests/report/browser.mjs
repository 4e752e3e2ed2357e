// Opens the report of a run in headless Chromium and tries what a reader does.
//
//     node browser.mjs --modules DIR --page FILE [--shots DIR] [--frames] [--layers "2, 3"] [--runs N]
//     node browser.mjs --modules DIR --page FILE --changed       the same page with other numbers in it
//     node browser.mjs --modules DIR --page FILE --pair alike    two runs of one wire side by side; unlike: of two wires
//     node browser.mjs --modules DIR --page FILE --no-webgl      a browser without graphics
//
// Prints a line for each check; exit code 1 if one fails. tests/report/run.sh calls it.
import { createRequire } from "node:module";
import { mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";

const { values: given } = parseArgs({
  options: {
    modules: { type: "string" }, page: { type: "string" }, shots: { type: "string" }, chromium: { type: "string" },
    frames: { type: "boolean" }, layers: { type: "string" }, changed: { type: "boolean" }, pair: { type: "string" }, "no-webgl": { type: "boolean" }, runs: { type: "string", default: "1" },
  },
});
const { chromium } = createRequire(join(resolve(given.modules), "x.js"))("playwright-core");
const MOST_BYTES = 10e6;
/** Until the page is laid out and drawn, ms; two seconds on a desk, more on a machine without graphics that others share. */
const MOST_MS = 10_000;

let failed = 0;
function check(what, ok, saw = "") {
  console.log(`${ok ? "ok  " : "FAIL"} ${what}${saw === "" ? "" : `: ${saw}`}`);
  failed += ok ? 0 : 1;
}

const browser = await chromium.launch({
  executablePath: given.chromium ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", ...(given["no-webgl"] ? ["--disable-gpu", "--disable-3d-apis"] : ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])],
});

/** How many colours an element shows. */
const coloursOf = async (page, element) => {
  await element.scrollIntoViewIfNeeded();
  const picture = await element.screenshot();
  return (await compare(page, picture, picture)).colours;
};

/** Share of the pixels of the view that differ between two pictures, and how many colours the first has. */
const compare = (page, before, after) => page.evaluate(async ([before, after]) => {
  const pixels = async (data) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    pen.drawImage(bitmap, 0, 0);
    return pen.getImageData(0, 0, bitmap.width, bitmap.height).data;
  };
  const [a, b] = [await pixels(before), await pixels(after)];
  const colours = new Set();
  let different = 0;
  for (let k = 0; k < a.length; k += 4) {
    colours.add((a[k] >> 3) * 1024 + (a[k + 1] >> 3) * 32 + (a[k + 2] >> 3));
    different += Math.abs(a[k] - b[k]) + Math.abs(a[k + 1] - b[k + 1]) + Math.abs(a[k + 2] - b[k + 2]) > 24 ? 1 : 0;
  }
  return { different: (4 * different) / a.length, colours: colours.size };
}, [before.toString("base64"), after.toString("base64")]);

/** Asks for the processor time from here on, ms: that of the page's own thread, and that of the whole browser, which draws too. */
async function processorTime(page) {
  const thread = await page.context().newCDPSession(page);
  const whole = await browser.newBrowserCDPSession();
  await thread.send("Performance.enable", { timeDomain: "threadTicks" });
  const now = async () => {
    const { metrics } = await thread.send("Performance.getMetrics");
    const { processInfo } = await whole.send("SystemInfo.getProcessInfo");
    return {
      script: metrics.find((metric) => metric.name === "TaskDuration").value,
      all: processInfo.reduce((sum, process) => sum + process.cpuTime, 0),
    };
  };
  const before = await now();
  return async () => {
    const after = await now();
    return { script: Math.round(1e3 * (after.script - before.script)), all: Math.round(1e3 * (after.all - before.all)) };
  };
}

/** Drags the view to and fro for a second or so: how long it took, ms, how many pictures were drawn, and what for processor time. */
async function turn(page, canvas) {
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  const [x, y] = [box.x + 0.5 * box.width, box.y + 0.5 * box.height];
  const state = () => page.locator(".view").first().evaluate((view) => ({ pictures: Number(view.dataset.pictures), drawn: view.dataset.drawn }));
  await page.mouse.move(x, y);
  await page.mouse.down();
  const before = await state();
  const spent = await processorTime(page);
  const began = Date.now();
  for (let step = 0; Date.now() - began < 1500; step += 1) {
    await page.mouse.move(x + 120 * Math.sin(0.05 * step), y);
    await page.evaluate(() => new Promise(requestAnimationFrame));
  }
  const ms = Date.now() - began;
  const after = await state();
  const { all } = await spent();
  await page.mouse.up();
  return { ms, all, pictures: after.pictures - before.pictures, drawn: after.drawn };
}

async function look(scheme) {
  const context = await browser.newContext({ colorScheme: scheme, viewport: { width: 1280, height: 900 }, reducedMotion: "reduce", offline: true });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => /^https?:/.test(request.url()) && complaints.push(`asks for ${request.url()}`));
  const spent = await processorTime(page);
  const began = Date.now();
  await page.goto(pathToFileURL(resolve(given.page)).href);
  // Of two runs, all that is tried belongs to the first: a control of the other would not change its picture.
  const run = page.locator(".run").first();
  const canvas = run.locator(".view canvas").first();
  await canvas.waitFor();
  const pictures = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60)))));
  // Until all stands there, and each view shows its fine picture.
  const settle = async () => {
    await pictures();
    await page.waitForFunction(() => document.body.dataset.whole && [...document.querySelectorAll(".view")].every((view) => view.dataset.drawn === "fine"));
    await pictures();
  };
  await pictures();
  const took = Date.now() - began;
  const { script, all } = await spent();
  check(`${scheme}: drawn within ${MOST_MS} ms`, took < MOST_MS, `${took} ms; ${script} ms of processor time in the page, ${all} ms with drawing`);
  await settle();
  const drawn = await run.locator(".view").first().evaluate((view) => ({ ...view.dataset }));
  check(`${scheme}: one draft is drawn, then one fine picture`, drawn.pictures === "2", drawn.pictures);
  check(`${scheme}: a view that stands still is not drawn`, await page.evaluate(async (before) => {
    await new Promise((done) => setTimeout(done, 600));
    return document.querySelector(".view").dataset.pictures === before;
  }, drawn.pictures));
  // A tube has 20 triangles a node, a draft of it 5.
  // Drafts that took long are left out for a while: here each is to be tried.
  const forget = () => page.evaluate(() => (runs[0].view.painter.takes.draft = 0));
  const triangles = async () => {
    const { draftTriangles, fineTriangles } = await run.locator(".view").first().evaluate((view) => ({ ...view.dataset }));
    return [Number(draftTriangles), Number(fineTriangles)];
  };
  // Without the balls of defects, which are the same in a draft.
  const start = await run.locator("select.colour").first().inputValue();
  await forget();
  await run.locator("select.colour").first().selectOption("layer");
  await settle();
  const [draft, fine] = await triangles();
  await forget();
  await run.locator("select.core").first().selectOption("hidden");
  await settle();
  const [sketch, wire] = await triangles();
  check(`${scheme}: the draft has a quarter of the wire's triangles`, Math.abs(sketch - 0.25 * wire) < 40, `${sketch} of ${wire}`);
  check(`${scheme}: and a core of fewer triangles`, draft > sketch && draft - sketch < fine - wire, `${draft - sketch} of ${fine - wire}`);
  check(`${scheme}: a coil of 100 turns stays below 400 000 triangles`, fine < 400_000, `${fine}`);
  await run.locator("select.core").first().selectOption("solid");
  await run.locator("select.colour").first().selectOption(start);
  await settle();
  check(`${scheme}: runs on the page`, (await page.locator(".run").count()) === Number(given.runs));

  const sizes = await page.evaluate(() => [["early_jump", 0.9], ["overstretch", 3], ["gap", 0.2]].map(([kind, d]) => sizeOf({ kind, size_m: 0.7e-3 * d, size_d: d })));
  check(`${scheme}: jumps count in turns, stretch is that of a turn`, sizes[0] === "0.9 turns" && sizes[1].endsWith("mm a turn") && sizes[2].endsWith("(0.20 d)"), sizes.join(", "));

  const shot = async () => {
    await settle();
    return canvas.screenshot();
  };
  const adapted = await page.evaluate(() => {
    const { painter } = runs[0].view;
    if (!painter.adapt) return [];
    const sharp = [];
    for (const took of [20, 60]) {
      for (let k = 0; k < 40; k += 1) painter.adapt(took);
      sharp.push(painter.sharp);
    }
    painter.sharp = sharp[0];
    return sharp;
  });
  check(`${scheme}: slow pictures get fewer pixels, never below a quarter`, adapted[0] === 0.5 && adapted[1] === 0.25, adapted.join());
  const first = await shot();
  const core = run.locator("select.core").first();
  await core.selectOption("hidden");
  const bare = await shot();
  const seen = await compare(page, first, bare);
  check(`${scheme}: the view is not blank`, seen.colours > 40, `${seen.colours} colours`);
  check(`${scheme}: the core can be hidden`, seen.different > 0.01, seen.different.toFixed(3));
  await core.selectOption("solid");

  const colour = run.locator("select.colour").first();
  const shots = new Map();
  const keys = await colour.locator("option").evaluateAll((options) => options.map((option) => option.value));
  const wanted = ["tension", "plastic_strain", "gap", "bulge", "layer", "defect"];
  check(`${scheme}: what the wire is coloured by`, `${keys}` === `${wanted}`, `${keys}`);
  for (const key of keys) {
    await colour.selectOption(key);
    shots.set(key, await shot());
    check(`${scheme}: legend of ${key}`, (await run.locator(".view .legend").first().innerText()).length > 4);
  }
  for (const [a, b] of [["tension", "plastic_strain"], ["tension", "layer"], ["gap", "bulge"]]) {
    const { different } = await compare(page, shots.get(a), shots.get(b));
    check(`${scheme}: ${a} and ${b} have other colours`, different > 0.004, different.toFixed(4));
  }
  if (given.frames) {
    const before = shots.get("defect");
    const slider = run.locator(".time input").first();
    const told = await run.locator(".time output").first().innerText();
    await slider.evaluate((input) => {
      input.value = 0;
      input.dispatchEvent(new Event("input"));
    });
    const { different } = await compare(page, before, await shot());
    check(`${scheme}: the slider over time shows other wire`, different > 0.004, different.toFixed(4));
    check(`${scheme}: and says another time`, told !== (await run.locator(".time output").first().innerText()), told);
    await slider.evaluate((input) => {
      input.value = input.max;
      input.dispatchEvent(new Event("input"));
    });
    check(`${scheme}: its end is the coil`, (await compare(page, before, await shot())).different < 1e-3);
  }
  const peel = run.locator("input.peel").first();
  if (await peel.count()) {
    const before = await shot();
    await peel.evaluate((input) => {
      input.value = 2;
      input.dispatchEvent(new Event("input"));
    });
    check(`${scheme}: turns can be taken off`, (await compare(page, before, await shot())).different > 0.02);
    await run.getByRole("button", { name: "Whole coil" }).click();
  }
  const turned = await turn(page, canvas);
  check(`${scheme}: a view that is turned is drawn`, turned.pictures > 0, `${turned.pictures} pictures in ${turned.ms} ms, ${turned.all} ms of processor time, the last one ${turned.drawn}`);
  await settle();
  await run.getByRole("button", { name: "Whole coil" }).click();
  const row = run.locator(".defects tbody tr").first();
  if (await row.count()) {
    const before = await shot();
    const place = () => page.evaluate(() => {
      const { top, bottom } = document.querySelector(".view").getBoundingClientRect();
      return { top, bottom, high: innerHeight, scrolled: scrollY };
    });
    await row.evaluate((it) => scrollBy(0, it.getBoundingClientRect().top - 60));
    const away = await place();
    await row.click();
    const there = await place();
    check(`${scheme}: a click on a defect brings the view into sight`, away.top < 0 && there.top >= 0 && there.bottom <= there.high, `${away.top} px, then ${there.top} px`);
    if (given.frames) {
      // with the slider before the defect the wire of another turn stood under its name
      const time = run.locator(".time input").first();
      await time.evaluate((input) => {
        input.value = 0;
        input.dispatchEvent(new Event("input"));
      });
      const named = () => run.locator(".view .place").first().innerText();
      check(`${scheme}: a place that is not wound yet is not named`, (await named()) === "", await named());
      await row.dispatchEvent("click");
      check(`${scheme}: and shows the wire that has it`, await time.evaluate((input) => input.value === input.max));
    }
    const { different } = await compare(page, before, await shot());
    check(`${scheme}: a click on a defect moves the view there`, different > 0.05, different.toFixed(3));
    await page.evaluate(() => scrollBy(0, -7));
    const near = await place();
    await row.dispatchEvent("click");
    check(`${scheme}: a view in sight stays where it is`, (await place()).scrolled === near.scrolled, `${near.scrolled} px`);
    check(`${scheme}: and names it`, /turn \d/.test(await run.locator(".view .place").first().innerText()));
    if (given.shots) {
      mkdirSync(given.shots, { recursive: true });
      await page.screenshot({ path: join(given.shots, `defect-${scheme}.png`) });
    }
    const chosen = () => run.locator(".defects tr.chosen").count();
    const marked = [await chosen()];
    await run.getByRole("button", { name: "Whole coil" }).click();
    marked.push(await chosen());
    await row.click();
    await page.evaluate(() => runs[0].goTo(1));
    marked.push(await chosen());
    check(`${scheme}: a row is marked while the view shows its defect, and no longer`, marked.join() === "1,0,0", marked.join());
    await run.getByRole("button", { name: "Whole coil" }).click();
  }
  const map = run.locator(".map canvas.own").first();
  if (await map.count()) {
    const before = await shot();
    const box = await map.boundingBox();
    await map.scrollIntoViewIfNeeded();
    await map.click({ position: { x: 0.6 * box.width, y: 12 } });
    check(`${scheme}: a click on the map moves the view`, (await compare(page, before, await shot())).different > 0.05);
    await run.getByRole("button", { name: "Whole coil" }).click();
    const gaps = await map.screenshot();
    await run.locator(".map button[data-key=layer]").first().click();
    check(`${scheme}: the map has other colours for layers`, (await compare(page, gaps, await map.screenshot())).different > 0.01);
    await run.locator(".map button[data-key=gap]").first().click();
  }
  const section = run.locator(".section canvas.own").first();
  const cut = await section.screenshot();
  await run.locator(".section input[type=range]").first().evaluate((input) => {
    input.value = 200;
    input.dispatchEvent(new Event("input"));
  });
  await settle();
  check(`${scheme}: the section moves`, (await compare(page, cut, await section.screenshot())).different > 1e-3);
  check(`${scheme}: no section or curve is blank`, (await compare(page, cut, cut)).colours > 3);
  const curves = await page.locator(".chart canvas").count();
  check(`${scheme}: curves are drawn, or missed`, curves >= 2 || (await page.getByText("history.csv is missing").count()) > 0, `${curves}`);
  // The curves are over turns of the spindle, which is ahead of the wire; places on the wire were taken for turns of the spindle.
  const wound = await page.evaluate(() => {
    const { wound, angle, time } = runs[0].history ?? {};
    if (!wound) return null;
    const turns = Array.from(angle, (one) => Math.abs(one) / (2 * Math.PI));
    const k = wound.findIndex((one, j) => j > wound.length / 2 && one > wound[j - 1]);
    return k < 0 ? null : [between(wound, turns, wound[k]) - turns[k], runs[0].timeOf(wound[k]) - time[k]];
  });
  check(`${scheme}: curves know where the spindle was when wire was wound`, wound === null || wound.every((off) => Math.abs(off) < 1e-6), `${wound}`);
  const begun = await page.getByText(/begin of layer/).allInnerTexts();
  check(`${scheme}: layers are marked where there are some`, begun.length === (given.layers ? 1 : 0) && begun.every((told) => told.includes(`begin of layer ${given.layers}.`)), begun.join(" | "));
  check(`${scheme}: the console is quiet`, complaints.length === 0, complaints.join(" | "));
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(`${scheme}: nothing sticks out sideways`, wide <= 0, `${wide} px`);
  // Tables may be longer than their place, not wider.
  const cutTables = () => page.evaluate(() => [...document.querySelectorAll(".scroll")].filter((box) => box.scrollWidth > box.clientWidth).length);
  for (const width of [900, 390]) {
    await page.setViewportSize({ width, height: 800 });
    await settle();
    check(`${scheme}: no table is cut in a window of ${width} px`, (await cutTables()) === 0);
  }
  const apart = await page.evaluate(() => document.querySelector(".view .legend").getBoundingClientRect().top - document.querySelector(".view canvas").getBoundingClientRect().bottom);
  check(`${scheme}: the legend does not cover a narrow view`, apart >= 0, `${apart} px`);
  const over = await page.evaluate(() => document.documentElement.scrollWidth - 390);
  check(`${scheme}: nor in a window of 390 px`, over <= 0, `${over} px`);
  if (given.shots) {
    mkdirSync(given.shots, { recursive: true });
    await page.screenshot({ path: join(given.shots, `narrow-${scheme}.png`), fullPage: true });
  }
  await page.setViewportSize({ width: 1280, height: 900 });
  if (given.shots) {
    mkdirSync(given.shots, { recursive: true });
    await page.evaluate(() => scrollTo(0, 0));
    await settle();
    await page.screenshot({ path: join(given.shots, `${scheme}.png`), fullPage: true });
  }
  await context.close();
}

/** Without WebGL only the view of the coil is missing. */
async function lookWithout() {
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 900 }, offline: true })).newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(pathToFileURL(resolve(given.page)).href);
  const whole = await page.waitForFunction(() => document.body.dataset.whole, null, { timeout: MOST_MS }).then(() => true, () => false);
  check("no WebGL: the page says so", (await page.getByText("shows no WebGL").count()) === 1);
  check("no WebGL: the rest is drawn to its end", whole);
  for (const part of [".chart canvas", ".map canvas.own", ".section canvas.own"]) {
    const element = page.locator(part).first();
    const colours = (await element.count()) ? await coloursOf(page, element) : 0;
    check(`no WebGL: ${part} is not blank`, colours > 3, `${colours} colours`);
  }
  for (const part of [".defects tbody tr", ".map canvas.own", ".chart .u-over"]) {
    const element = page.locator(part).first();
    if (await element.count()) await element.click();
  }
  check("no WebGL: a click on a defect, the map or a curve does no harm", errors.length === 0, errors.join(" | "));
  if (given.shots) {
    mkdirSync(given.shots, { recursive: true });
    await page.screenshot({ path: join(given.shots, "no-webgl.png"), fullPage: true });
  }
}

/** The page with numbers that its run has not: a constant field, flanges, faults of the wire, and gaps that are all but the same. */
async function lookChanged(scheme) {
  const text = readFileSync(given.page, "utf8");
  const [, before, json, after] = /^([^]*<script type="application\/json" id="data">)([^]*?)(<\/script>[^]*)$/.exec(text);
  const data = JSON.parse(json);
  const run = data.runs[0];
  const floats = (name) => new Float32Array(Uint8Array.from(Buffer.from(name.slice(4), "base64")).buffer);
  const packed = (array) => `f32:${Buffer.from(array.buffer).toString("base64")}`;
  run.wire.plastic_strain = packed(floats(run.wire.plastic_strain).fill(0));
  // One place that stands out, above a hundredth of places that share the least.
  run.wire.tension = packed(floats(run.wire.tension).map((_, k, all) => (k === 3 ? 999 : k < 0.1 * all.length ? 10 : 10 + k / all.length)));
  run.stations.gap = packed(floats(run.stations.gap).map((_, k) => 4e-6 * Math.sin(k)));
  const ys = floats(run.core.points).filter((_, k) => k % 3 === 1);
  const [low, high] = [ys.reduce((a, b) => Math.min(a, b)), ys.reduce((a, b) => Math.max(a, b))];
  run.summary.product.window = { fill_bare: 0.5, faces_m: [0.8 * low + 0.2 * high, 0.3 * low + 0.7 * high] };
  const [known] = run.summary.defects;
  for (const kind of ["slack", "runaway", "break"]) run.summary.defects.push({ ...known, kind, size_m: null, size_d: null });
  run.summary.defects.push({ ...known, kind: "collision", place_m: null });
  const path = resolve(`${given.page}.changed.html`);
  writeFileSync(path, before + JSON.stringify(data).replaceAll("<", "\\u003c") + after);
  const page = await (await browser.newContext({ colorScheme: scheme, viewport: { width: 1280, height: 900 }, reducedMotion: "reduce", offline: true })).newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(pathToFileURL(path).href);
  const settle = () => page.waitForFunction(() => document.body.dataset.whole && document.querySelector(".view").dataset.drawn === "fine");
  const canvas = page.locator(".view canvas");
  const shot = async (name) => {
    await page.waitForTimeout(100);
    await settle();
    if (given.shots) {
      mkdirSync(given.shots, { recursive: true });
      await page.locator(".view").screenshot({ path: join(given.shots, `${name}-${scheme}.png`) });
    }
    return canvas.screenshot();
  };
  await settle();
  const legend = () => page.locator(".view .legend").innerText();
  const colour = async (key) => {
    await page.locator("select.colour").selectOption(key);
    return (await legend()).replaceAll("\n", " ");
  };
  const clipped = await colour("tension");
  check(`${scheme}: colours that end before the values say so`, /\d N ≥ [\d.]+ N/.test(clipped) && !clipped.includes("≤") && /values reach from [\d.]+ N to 999\.\d* N/.test(clipped), clipped);
  const constant = await colour("plastic_strain");
  check(`${scheme}: a constant field has one number and no range`, /(^| )0 %/.test(constant) && !constant.includes("50") && !(await page.locator(".view .ramp").count()), constant);
  const kinds = await colour("defect");
  check(`${scheme}: the legend has each kind with a place`, ["gap", "slack", "runaway", "break"].every((kind) => kinds.includes(kind)) && !kinds.includes("collision"), kinds);
  const balls = await shot("balls");
  await colour("layer");
  await page.waitForTimeout(100);
  check(`${scheme}: faults of the wire are balls while defects are coloured`, await page.evaluate(() => {
    const { view } = runs[0];
    const seen = () => view.balls?.filter((ball) => ball.visible).length;
    const others = seen();
    view.colour("defect");
    return others === 0 && seen() === 3;
  }));
  await colour("defect");
  const flat = (await page.locator(".map .legend").innerText()).replaceAll("\n", " ");
  const [, least, most] = /(-?[\d.]+) mm (-?[\d.]+) mm/.exec(flat) ?? [];
  check(`${scheme}: the map does not stretch noise, and says so`, most - least > 0.1 && flat.includes("at least"), flat);
  const core = page.locator("select.core");
  check(`${scheme}: a core with flanges can be shown without them`, (await core.locator("option[value=bare]").count()) === 1);
  if (await core.locator("option[value=bare]").count()) {
    await core.selectOption("bare");
    const bare = await shot("bare");
    await core.selectOption("hidden");
    const hidden = await shot("hidden");
    await core.selectOption("solid");
    const cut = [(await compare(page, balls, bare)).different, (await compare(page, bare, hidden)).different];
    check(`${scheme}: that cuts a part of the core off`, cut[0] > 0.01 && cut[1] > 0.01, cut.map((share) => share.toFixed(3)).join(", "));
    check(`${scheme}: and it comes back`, (await compare(page, balls, await shot("solid"))).different < 1e-3);
  }
  check(`${scheme}: the changed page has no error`, errors.length === 0, errors.join(" | "));
  if (given.shots) await page.screenshot({ path: join(given.shots, `changed-${scheme}.png`), fullPage: true });
  await page.context().close();
  rmSync(path);
}

/** Two runs side by side: what differs is told, and scales are shared by runs of one wire only. */
async function lookPair(alike) {
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 900 }, reducedMotion: "reduce", offline: true })).newPage();
  await page.goto(pathToFileURL(resolve(given.page)).href);
  await page.waitForFunction(() => document.body.dataset.whole);
  const told = (await page.locator(".differences").innerText()).replaceAll(/\s+/g, " ");
  check("pair: what differs between the scenes is told, with units", alike ? /traverse\.per_turn 0\.95 mm 0\.7 mm/.test(told) && !told.includes("wire.diameter") : /wire\.diameter 0\.7 mm 0\.5 mm/.test(told), told);
  check("pair: and whether scales are shared", told.includes(alike ? "both runs share their scales" : "each run has its own scales"));
  for (const key of ["tension", "gap"]) {
    for (const select of await page.locator("select.colour").all()) await select.selectOption(key);
    const [one, other] = await page.locator(".view .legend").allInnerTexts();
    const alone = [one, other].filter((text) => text.includes("this run alone")).length;
    const ends = [one, other].map((text) => text.match(/-?[\d.]+ (N|mm)/g).slice(0, 2).join());
    check(`pair: scale of ${key}`, alike ? ends[0] === ends[1] && alone === 0 : ends[0] !== ends[1] && alone === 2, ends.join(" and "));
  }
  const d = await page.locator(".meta").allInnerTexts();
  check("pair: d is told for each run", d[0].includes("0.700 mm") && d[1].includes(alike ? "0.700 mm" : "0.500 mm"), d.join(" | "));
  const least = await page.locator(".map .legend").allInnerTexts();
  const floors = least.map((text) => /at least ([\d.]+) mm \(0\.15 d\)/.exec(text)?.[1]);
  check("pair: 0.15 d goes with the wire of the run", floors.every((floor, k) => floor === undefined || floor === (alike || k === 0 ? "0.105" : "0.075")), floors.join());
  if (given.shots) {
    mkdirSync(given.shots, { recursive: true });
    await page.screenshot({ path: join(given.shots, `pair-${given.pair}.png`), fullPage: true });
  }
}

try {
  check("the page is below 10 MB", statSync(given.page).size < MOST_BYTES, `${(statSync(given.page).size / 1e6).toFixed(2)} MB`);
  if (given["no-webgl"]) await lookWithout();
  else if (given.pair) await lookPair(given.pair === "alike");
  else for (const scheme of ["light", "dark"]) await (given.changed ? lookChanged(scheme) : look(scheme));
} finally {
  await browser.close();
}
console.log(failed ? `${failed} failed` : "all passed");
process.exit(failed ? 1 : 0);
