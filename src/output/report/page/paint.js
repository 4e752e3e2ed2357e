// When the view is drawn, and how finely: the finest picture that is quick at once, the fine one when all stands still.

/** Pixels drawn for one of the page, either way: the fine picture has more than are shown, so that its edges are smooth. */
const RATIO = { rough: () => 0.5, draft: () => 0.7, fine: () => Math.max(2, devicePixelRatio || 1) };
/** The fine picture waits until nothing has moved for so long, ms. */
const STILL = 250;
/** A picture that takes longer, ms, is not drawn while the view moves, if there is a quicker one. */
const SMOOTH = 25;

class Painter {
  constructor(view) {
    this.view = view;
    // What a picture took, ms: the fine one since the page was opened, the draft since the view moves.
    this.takes = { fine: Infinity, draft: 0 };
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
    this.takes = { fine: this.time(() => this.paint("fine")), draft: 0 };
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
    const { renderer, tube, scene, camera, box } = this.view;
    const ratio = RATIO[detail]();
    if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
    if (tube.drawn !== detail) tube.detail(detail);
    renderer.render(scene, camera);
    // For tests: what stands there, and how often it was drawn.
    box.dataset.drawn = detail;
    box.dataset.pictures = Number(box.dataset.pictures ?? 0) + 1;
    box.dataset[`${detail}Triangles`] = renderer.info.render.triangles;
  }
}
