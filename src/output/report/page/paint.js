// When the view is drawn, and how finely: the finest picture that is quick at once, the fine one when all stands still.

/** Pixels drawn for one of the page, either way: the fine picture has more than are shown, so that its edges are smooth. */
const RATIO = { rough: (painter) => painter.sharp, draft: () => 0.7, fine: () => Math.max(2, devicePixelRatio || 1) };
/** The most and the least of a rough picture, and by how much they go down where it takes long. */
const SHARP = { most: 0.5, least: 0.25, step: 0.8 };
/** The fine picture waits until nothing has moved for so long, ms. */
const STILL = 250;
/** A picture that takes longer, ms, is not drawn while the view moves, if there is a quicker one. */
const SMOOTH = 25; // the browser needs as long to bring it to the screen, and 20 a second look smooth
/** One in so many rough pictures is waited for to see how long it takes: the wait holds up the next. */
const MEASURED = 3;

class Painter {
  constructor(view) {
    this.view = view;
    // What a picture took, ms; what is unknown is tried.
    this.takes = { fine: Infinity, draft: 0 };
    this.sharp = SHARP.most;
    this.roughs = 0;
  }

  /** Draws before the screen is next painted. */
  ask() {
    clearTimeout(this.rest);
    if (this.waits) return;
    this.waits = true;
    requestAnimationFrame(() => {
      this.waits = false;
      if (this.takes.fine < SMOOTH) return this.paint("fine");
      if (this.takes.draft < SMOOTH) this.takes.draft = this.time(() => this.paint("draft"));
      else if ((this.roughs += 1) % MEASURED === 1) this.adapt(this.time(() => this.paint("rough")));
      else this.paint("rough");
      this.rest = setTimeout(() => this.finish(), STILL);
    });
  }

  /** Draws the fine picture, after all else of the page, and sees how long it takes. */
  finish() {
    if (!document.body.dataset.whole) {
      this.rest = setTimeout(() => this.finish(), STILL);
      return;
    }
    // The first draft had to set all up. Later ones are tried again now and then, since the machine may have become quiet.
    const draft = this.takes.fine === Infinity ? 0 : 0.7 * this.takes.draft;
    this.takes = { fine: this.time(() => this.paint("fine")), draft };
    this.sharp = Math.min(SHARP.most, this.sharp / SHARP.step);
    this.roughs = 0;
  }

  /** Takes fewer pixels after a rough picture that took so long, ms; more come back when all stands still. */
  adapt(took) {
    if (took > SMOOTH) this.sharp = Math.max(SHARP.least, SHARP.step * this.sharp);
  }

  /** How long a picture takes, ms. */
  time(paint) {
    this.wait();
    const began = performance.now();
    paint();
    this.wait();
    return performance.now() - began;
  }

  /** Waits until all that was asked for is drawn: a pixel that is read comes after it. */
  wait() {
    const gl = this.view.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  paint(detail) {
    const { renderer, tube, surface, scene, camera, box } = this.view;
    const ratio = RATIO[detail](this);
    if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
    if (tube.drawn !== detail) tube.detail(detail);
    surface?.detail(detail);
    renderer.render(scene, camera);
    // For tests: what stands there, and how often it was drawn.
    box.dataset.drawn = detail;
    box.dataset.pictures = Number(box.dataset.pictures ?? 0) + 1;
    box.dataset[`${detail}Triangles`] = renderer.info.render.triangles;
  }
}
