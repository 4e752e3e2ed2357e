// The coil in three dimensions, to turn, zoom and colour. Lengths in mm.

/** Defects that are shown as balls, at most: each is drawn on its own. */
const MOST_BALLS = 200;
const BALL = new Vendor.SphereGeometry(1, 16, 10);
/** Whether the reader wishes that nothing moves by itself. */
const stands = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

class View {
  constructor(run) {
    this.run = run;
    this.key = run.beside.some((one) => one.defects.some((d) => d.place_m)) ? "defect" : "tension";
    this.frame = null;
    this.legend = el("div", { class: "legend" });
    this.place = el("div", { class: "place" });
    this.box = el("div", { class: "view" }, this.legend, this.place);
    this.scene = new Vendor.Scene();
    this.camera = new Vendor.PerspectiveCamera(32, 1, 0.5, 5000);
    try {
      this.renderer = new Vendor.WebGLRenderer();
      this.renderer.localClippingEnabled = true;
    } catch {
      this.box.replaceChildren(el("p", {}, "This browser shows no WebGL; the other parts of the page do not need it."));
      this.box.classList.add("bare");
      return;
    }
    this.painter = new Painter(this);
    this.box.prepend(this.renderer.domElement);
    this.controls = new Vendor.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    const sky = new Vendor.HemisphereLight(0xffffff, 0x8a8f96, 1.6);
    const lamp = new Vendor.DirectionalLight(0xffffff, 1.9);
    lamp.position.set(-0.4, 0.8, 1);
    this.camera.add(lamp);
    this.scene.add(sky, this.camera);
    this.material = new Vendor.MeshPhongMaterial({ vertexColors: true, specular: 0x303030, shininess: 24 });
    this.mark = new Vendor.Mesh(new Vendor.SphereGeometry(1, 24, 16),
      new Vendor.MeshBasicMaterial({ transparent: true, opacity: 0.28, depthWrite: false }));
    this.mark.scale.setScalar(1.25 * run.diameter * SCALE);
    this.marked = null;
    this.scene.add(this.mark);
    if (run.core) {
      this.surface = new CoreSurface(run.core);
      this.core = this.surface.mesh;
      this.scene.add(this.core);
    }
    this.balls = run.balls.slice(0, MOST_BALLS).map((defect) => this.ball(defect));
    this.balls.forEach((ball) => this.scene.add(ball));
    this.build();
    this.theme();
    onTheme(() => this.theme());
    this.look(1, 0.42, 0.8);
    new ResizeObserver(() => this.resize()).observe(this.box);
  }

  /** Makes the tube of the wire as it is at the frame. */
  build() {
    const wire = wireAt(this.run, this.frame);
    this.wire?.geometry.dispose();
    this.tube = new Tube(wire.points, 0.5 * SCALE * this.run.diameter);
    if (this.wire) this.wire.geometry = this.tube.geometry;
    else {
      this.wire = new Vendor.Mesh(this.tube.geometry, this.material);
      this.scene.add(this.wire);
    }
    this.shown = wire;
    this.showMark();
    this.peel(this.upTo);
    this.colour(this.key);
  }

  /** A ball at a defect that marks no wire. */
  ball(defect) {
    const ball = new Vendor.Mesh(BALL, new Vendor.MeshLambertMaterial({ color: lineColour(defect.kind) }));
    ball.position.set(...defect.place_m).multiplyScalar(SCALE);
    ball.scale.setScalar(0.9 * this.run.diameter * SCALE);
    ball.defect = defect;
    return ball;
  }

  /** Shows the balls of the defects that there are at the frame, on the turns that are shown. */
  showBalls() {
    const time = this.frame == null ? Infinity : this.run.frames[this.frame].time * (1 + SAME);
    for (const ball of this.balls) {
      const { time_s: began, turn, angle_deg: angle } = ball.defect;
      ball.visible = this.key === "defect" && began <= time && turn - 1 + angle / STATIONS <= (this.upTo ?? Infinity);
    }
  }

  /** Shows the first turns only, so that lower layers can be seen; no number shows all. */
  peel(turns) {
    this.upTo = turns;
    this.tube.show(turns == null ? this.tube.nodes : lowerBound(this.run.turnOf, turns));
    if (this.peeler) {
      this.peeler.value = turns == null ? this.peeler.max : Math.ceil(turns);
      this.peeled.textContent = turns == null ? "all" : `${Number(turns.toFixed(2))}`;
    }
    this.showBalls();
    this.draw();
  }

  /** Colours the wire; the range is that of the coils of all runs of this wire at their ends, so that frames and runs can be compared. */
  colour(key) {
    this.key = key;
    const coil = this.run.all.flatMap((run) => (run.wire ? Array.from(run.wire[key].subarray(0, Math.max(1, run.laid))) : []));
    const colours = colouring(key, coil, this.run.all);
    this.tube.paint(this.shown[key], colours);
    this.legend.replaceChildren(...legend(key, colours, [...coil, ...this.shown[key]], this.run.all));
    this.showBalls();
    this.draw();
  }

  showCore(how) {
    if (!this.core) return;
    this.core.visible = how !== "hidden";
    this.core.material.clippingPlanes = how === "bare" ? this.betweenFaces() : null;
    this.core.material.transparent = how === "glass";
    this.core.material.opacity = how === "glass" ? 0.25 : 1;
    this.core.material.depthWrite = how !== "glass";
    this.core.material.needsUpdate = true;
    this.draw();
  }

  /** Planes that leave of the core what lies between the inner faces of its flanges. */
  betweenFaces() {
    const [low, high] = this.run.faces.map((y) => SCALE * y);
    // A face in the plane itself would be left in shreds.
    const inset = 1e-3 * (high - low);
    return [new Vendor.Plane(new Vendor.Vector3(0, 1, 0), -low - inset), new Vendor.Plane(new Vendor.Vector3(0, -1, 0), high - inset)];
  }

  show(frame) {
    this.frame = frame;
    this.build();
  }

  theme() {
    this.scene.background = new Vendor.Color(css("--view"));
    this.mark.material.color.set(css("--accent"));
    for (const ball of this.balls) ball.material.color.set(lineColour(ball.defect.kind));
    this.core?.material.color.set(css("--core"));
    this.draw();
  }

  resize() {
    if (!this.renderer) return;
    // (in a narrow window the legend stands below the picture)
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    if (!width || !height || (width === this.wide && height === this.high)) return;
    [this.wide, this.high] = [width, height];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.sized) this.look(1, 0.42, 0.8);
    this.sized = true;
    this.draw();
  }

  /** Shows the whole coil from a direction. */
  look(x, y, z) {
    const { middle, radius } = this.run.extent;
    const target = new Vendor.Vector3(...middle).multiplyScalar(SCALE);
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (1.12 * SCALE * radius) / Math.sin((0.5 * this.camera.fov * Math.PI) / 180) / narrow;
    this.move(target, new Vendor.Vector3(x, y, z).normalize().multiplyScalar(distance).add(target), !this.sized);
    this.marked = null;
    this.showMark();
    this.run.choose(null);
    this.peel(null);
  }

  /** Goes to a place of the wire, m, at so many turns, seen from outside and from the middle of the coil. Wire that was
   * wound over it later is hidden. A frame of before the place was wound, at a time in s, gives way to the end of the run. */
  goTo(point, words, turns, time) {
    if (this.frame != null && this.run.frames[this.frame].time * (1 + SAME) < time) this.toEnd();
    const node = lowerBound(this.run.turnOf, turns);
    const layers = this.run.wire.layer;
    const covered = node < layers.length && layers[node] > 0 && layers.subarray(node).some((layer) => layer > layers[node]);
    this.peel(covered ? Math.min(turns + 1, this.run.turnOf[layers.findIndex((layer, k) => k > node && layer > layers[node])]) : null);
    const target = new Vendor.Vector3(...point).multiplyScalar(SCALE);
    const out = new Vendor.Vector3(target.x, 0, target.z).normalize();
    out.y = point[1] > this.run.extent.middle[1] ? -0.4 : 0.4;
    const distance = Math.max(22 * SCALE * this.run.diameter, 0.5 * SCALE * this.run.extent.radius);
    this.move(target, out.normalize().multiplyScalar(distance).add(target));
    this.mark.position.copy(target);
    this.marked = { words, time };
    this.showMark();
    this.bringIntoSight();
  }

  /** Shows the place that was gone to, if any, where its wire is wound at the frame. */
  showMark() {
    const there = this.marked && (this.frame == null || this.run.frames[this.frame].time * (1 + SAME) >= (this.marked.time ?? 0));
    this.mark.visible = Boolean(there);
    this.place.textContent = there ? this.marked.words : "";
  }

  /** Scrolls the page by as little as shows all of the view; not at all where it is in sight. */
  bringIntoSight() {
    const { top, bottom } = this.box.getBoundingClientRect();
    if (top >= 0 && bottom <= innerHeight) return;
    this.box.scrollIntoView({ block: "nearest", behavior: stands() ? "instant" : "smooth" });
  }

  move(target, eye, atOnce = false) {
    const still = atOnce || stands();
    const [from, seen, began] = [this.camera.position.clone(), this.controls.target.clone(), performance.now()];
    const step = (now) => {
      const t = still ? 1 : Math.min(1, Math.max(0, (now - began) / 450));
      const share = t * t * (3 - 2 * t);
      this.camera.position.lerpVectors(from, eye, share);
      this.controls.target.lerpVectors(seen, target, share);
      this.controls.update();
      this.draw();
      if (t < 1) requestAnimationFrame(step);
    };
    step(began);
  }

  /** Draws once before the screen is next painted, as soon as it is known how large. */
  draw() {
    if (this.wide) this.painter.ask();
  }

  /** The card: view, its switches, and the slider over time where frames were kept. */
  card() {
    const pick = (names, chosen, change) => el("select", { onchange: (event) => change(event.target.value) },
      ...Object.entries(names).map(([key, text]) => el("option", { value: key, selected: key === chosen }, text)));
    // The map has quantities that the files of the coil do not have.
    const onWire = Object.entries(QUANTITIES).filter(([key]) => this.shown?.[key]);
    const names = Object.fromEntries(onWire.map(([key, { label }]) => [key, label]));
    const cores = { solid: "solid", ...(this.run.faces ? { bare: "without flanges" } : {}), glass: "see-through", hidden: "hidden" };
    const sides = { corner: [1, 0.42, 0.8], x: [1, 0.02, 0], z: [0, 0.02, 1], axis: [0.02, 1, 0] };
    const bar = el("div", { class: "bar" }, el("h2", {}, "Coil"),
      el("label", {}, "Colour", withClass("colour", pick(names, this.key, (key) => this.colour(key)))),
      this.core ? el("label", {}, "Core", withClass("core", pick(cores, "solid", (how) => this.showCore(how)))) : null,
      el("span", { class: "group" }, ...Object.entries({ corner: "Whole coil", x: "From x", z: "From z", axis: "Along the axis" })
        .map(([key, text]) => el("button", { type: "button", onclick: () => this.look(...sides[key]) }, text))));
    const card = el("section", { class: "card coil" }, this.renderer ? bar : el("div", { class: "bar" }, el("h2", {}, "Coil")), this.box);
    if (this.renderer && this.run.frames.length) card.append(this.slider());
    if (this.renderer && this.run.turnOf[this.run.laid - 1] > 5) card.append(this.layersSlider());
    if (this.renderer) card.append(el("p", { class: "note" }, "Drag to turn, wheel to zoom, right button to shift."));
    return card;
  }

  layersSlider() {
    const most = Math.ceil(this.run.turnOf[this.run.laid - 1]);
    this.peeled = el("output", {}, "all");
    this.peeler = el("input", {
      type: "range", class: "peel", min: 1, max: most, value: most, "aria-label": "Turns shown",
      oninput: (event) => this.peel(Number(event.target.value) === most ? null : Number(event.target.value)),
    });
    return el("div", { class: "time" }, el("span", { class: "soft" }, "Turns shown"), this.peeler, this.peeled);
  }

  slider() {
    const frames = this.run.frames;
    const times = frames.map((frame) => frame.time);
    // A run that failed or was stopped ends after its last frame: the wire there is that of the coil.
    const end = this.run.summary.simulated_s;
    if (end > times[frames.length - 1] * (1 + SAME)) times.push(end);
    const last = times.length - 1;
    const output = el("output", {});
    const name = (frame) => {
      const time = times[frame];
      const turns = this.run.turnsAt(time);
      output.textContent = `${duration(time)}${turns == null ? "" : `, ${turns.toFixed(2)} turns`}`;
    };
    const input = el("input", {
      type: "range", min: 0, max: last, value: last, "aria-label": "Time",
      oninput: (event) => set(Number(event.target.value)),
    });
    const set = (frame) => {
      input.value = frame;
      name(frame);
      this.show(frame < frames.length ? frame : null);
    };
    let timer = null;
    const play = el("button", {
      type: "button", class: "play",
      onclick: () => {
        if (timer) return halt();
        if (Number(input.value) === last) set(0);
        play.textContent = "Pause";
        timer = setInterval(() => (Number(input.value) < last ? set(Number(input.value) + 1) : halt()), Math.max(60, 6000 / times.length));
      },
    }, "Play");
    const halt = () => {
      clearInterval(timer);
      timer = null;
      play.textContent = "Play";
    };
    this.toEnd = () => {
      halt();
      set(last);
    };
    name(last);
    return el("div", { class: "time" }, play, el("span", { class: "soft" }, "Time"), input, output);
  }
}

function withClass(name, element) {
  element.classList.add(name);
  return element;
}
