// The unrolled coil: a row a turn, a column a degree, coloured by gap, bulge or layer; defects are rings.

/** The map of a run, or null without stations. A click goes to that place of the wire. */
function defectMap(run) {
  const stations = run.stations;
  if (!stations || stations.arc.length === 0) return null;
  // (a defect may lie in wire that has not come to rest)
  const turns = Math.max(Math.ceil(stations.arc.length / STATIONS), ...run.defects.map((defect) => defect.turn));
  // (the axis title, then the longest number)
  const left = 30 + 8 * `${turns}`.length, bottom = 40, top = 6, right = 14;
  const row = Math.min(30, Math.max(3, 420 / turns));
  const measure = (key, of = stations) => {
    if (key === "layer") return of.layer;
    // (a gap in a crossover is none)
    return of[key].map((value, k) => (of.measured[k] && !(key === "gap" && of.crosses[k]) ? value : NaN));
  };
  // (bulges as they are judged)
  const bulge = run.all.every(overRest) ? "bulge_excess" : "bulge";
  let key = "gap";
  let values, colours, picture;
  const kinds = [...new Set(run.defects.map((defect) => defect.kind))];
  const rings = kinds.length ? [keys(kinds.map((kind) => [plainName(kind), pageColour(kind)]), "rings")] : [];
  const legendBox = el("div", { class: "keys-of-map" });
  const choose = (chosen) => {
    key = chosen;
    values = measure(key);
    const all = run.all.flatMap((one) => (one.stations ? Array.from(measure(key, one.stations)) : []));
    colours = colouring(key, all, run.all);
    picture = image(values, colours, turns);
    legendBox.replaceChildren(...legend(key, colours, all, run.all), ...rings);
  };
  choose(key);

  const draw = (pen, width, height) => {
    const across = width - left - right;
    const high = height - top - bottom;
    pen.fillStyle = css("--faint");
    pen.fillRect(left, top, across, high);
    pen.imageSmoothingEnabled = false;
    pen.drawImage(picture, left, top, across, high);
    pen.fillStyle = css("--soft");
    pen.textAlign = "center";
    for (let angle = 0; angle <= STATIONS; angle += width < 500 ? 90 : 45) {
      pen.fillText(`${angle}°`, left + (across * angle) / STATIONS, height - bottom + 16);
    }
    pen.fillText("Angle from the clamp", left + across / 2, height - 5);
    pen.textAlign = "right";
    const every = Math.max(1, Math.ceil(14 / row / 5) * (row < 14 ? 5 : 1));
    for (let turn = 1; turn <= turns; turn += 1) {
      if (turn === 1 || turn % every === 0) pen.fillText(`${turn}`, left - 8, top + (turn - 0.5) * row + 4);
    }
    pen.save();
    pen.translate(11, top + high / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    if (high > 30) pen.fillText("Turn", 0, 0);
    pen.restore();
    for (const defect of run.defects) {
      pen.beginPath();
      pen.arc(left + (across * defect.angle_deg) / STATIONS, top + (defect.turn - 0.5) * row, Math.min(6, Math.max(4, row / 2)), 0, TURN);
      pen.lineWidth = 4;
      pen.strokeStyle = css("--card");
      pen.stroke();
      pen.lineWidth = 2;
      pen.strokeStyle = lineColour(defect.kind);
      pen.stroke();
    }
  };
  const board = canvas(() => turns * row + top + bottom, draw, { "aria-label": "Map of turn against angle" });
  const tip = el("div", { class: "tip", hidden: true });
  const under = (event) => {
    const angle = Math.floor(((event.offsetX - left) / (board.clientWidth - left - right)) * STATIONS);
    const turn = Math.floor((event.offsetY - top) / row);
    const index = turn * STATIONS + angle;
    return angle >= 0 && angle < STATIONS && turn >= 0 && turn < turns ? { angle, turn, index } : null;
  };
  board.addEventListener("mousemove", (event) => {
    const at = under(event);
    tip.hidden = !at;
    if (!at) return;
    const parts = [`turn ${at.turn + 1}, ${at.angle}°`];
    if (at.index < values.length) {
      parts.push(`gap ${mm(stations.gap[at.index])}`, `bulge ${mm(stations.bulge[at.index])}`, `layer ${stations.layer[at.index]}`);
    } else parts.push("not at rest");
    tip.textContent = parts.join("  ·  ");
    tip.style.left = `${Math.max(0, Math.min(event.offsetX + 12, board.clientWidth - tip.offsetWidth))}px`;
    tip.style.top = `${event.offsetY + 16}px`;
  });
  board.addEventListener("mouseleave", () => (tip.hidden = true));
  board.addEventListener("click", (event) => {
    const at = under(event);
    if (!at) return;
    const near = run.defects.find((d) => d.turn === at.turn + 1 && Math.abs(d.angle_deg - at.angle) < 6);
    if (near) run.goToDefect(near);
    else run.goTo(at.index / STATIONS);
  });
  const pick = (chosen) => {
    choose(chosen);
    board.paint();
  };
  const bar = el("div", { class: "bar" }, el("h2", {}, "Defect map"),
    choice({ gap: "Gap", [bulge]: "Bulge", layer: "Layer" }, key, pick));
  const note = [run.defects.length ? "Rings mark defects." : "No defects.", ...(run.view?.renderer ? ["A click moves the view there."] : [])].join(" ");
  return el("section", { class: "card map" }, bar, el("div", { class: "plot" }, board, tip),
    el("div", { class: "legend", style: "position: static; display: inline-block; margin-top: 8px" }, legendBox),
    el("p", { class: "note" }, `${note} Grey is not judged: shaped by the clamp, without a neighbour, in the step to the next layer, or a gap in a crossover.`));
}

/** The measures as a picture, a pixel a station. */
function image(values, colours, turns) {
  const board = document.createElement("canvas");
  [board.width, board.height] = [STATIONS, turns];
  const pen = board.getContext("2d");
  const pixels = pen.createImageData(STATIONS, turns);
  values.forEach((value, k) => pixels.data.set([...colours.of(value), 255], 4 * k));
  pen.putImageData(pixels, 0, 0);
  return board;
}
