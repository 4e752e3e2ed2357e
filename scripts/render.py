#!/usr/bin/env python3
"""Pictures and films of a run, from the files in its folder.

    render.py DIR                                     DIR/render.png: the coil at the end
    render.py DIR --colour layer --from x             coloured by layer, seen along x
    render.py DIR --film FILM.mp4                     a film of the frames (coilwind run --frames N); .gif works too

The Python is that of `scripts/venv.sh render`. The camera stands so that the windings fill the picture, beside the scale
of colours. Of a core with flanges it shows the part between them; --flanges shows it whole.
"""

import argparse
import contextlib
import json
import logging
import re
import warnings
from pathlib import Path
from xml.etree import ElementTree

import imageio
import imageio_ffmpeg
import numpy as np
import pyvista as pv
from PIL import Image
from vtkmodules.vtkCommonCore import vtkLogger

import folder as folders
from failure import Mistake, told
from progress import Progress

# Columns that colour the wire: array, factor to the unit, title.
COLOURS = {
    "tension": ("tension", 1.0, "tension (N)"),
    "plastic_strain": ("plastic_strain", 100.0, "plastic strain (%)"),
    "gap": ("gap", 1e6, "gap (um)"),
    "height": ("height", 1e3, "height over the core (mm)"),
    "bulge": ("bulge", 1e3, "bulge (mm)"),
    "layer": ("layer", 1.0, "layer"),
    "turn": ("turn", 1.0, "turn"),
    "none": (None, 1.0, ""),
}
# The axis of the core is y.
VIEWS = {"corner": (1.0, 0.55, 0.8), "x": (1.0, 0.0, 0.0), "z": (0.0, 0.0, 1.0), "axis": (0.001, 1.0, 0.0)}
COPPER, CORE, PAPER = "#c87941", "#9aa3ad", "white"
SIDES = 20
# Room that the scale of colours takes at the right, pixels, and its largest share of the width.
BAR, BAR_SHARE = 200, 0.4
# Frames a second that players show.
RATES = (0.5, 120.0)
# The last bytes of a whole file of VTK hold it.
END = b"</VTKFile>"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="DIR", help="folder of a run")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.png", help="picture (default: DIR/render.png)")
    parser.add_argument("--film", type=Path, metavar="FILE", help="film of the frames, .mp4 or .gif, instead of a picture")
    parser.add_argument("--colour", choices=COLOURS, default="tension", help="what colours the wire (default: tension)")
    parser.add_argument("--from", dest="view", choices=VIEWS, default="corner", help="where the camera stands (default: corner)")
    parser.add_argument("--flanges", action="store_true", help="show the flanges of the core")
    parser.add_argument("--no-core", action="store_true", help="show the wire alone")
    parser.add_argument("--size", default="1280x960", metavar="WxH", help="pixels (default: 1280x960)")
    parser.add_argument("--rate", type=float, default=20.0, metavar="FPS", help=f"frames a second of the film, {RATES[0]:g} to {RATES[1]:g} (default: 20)")
    args = parser.parse_args()
    # It warns that there is no screen.
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    with told(parser.prog):
        if not RATES[0] <= args.rate <= RATES[1]:
            raise Mistake(f"--rate {args.rate:g}: frames a second have to be from {RATES[0]:g} to {RATES[1]:g}")
        if args.film and args.output:
            raise Mistake(f"-o {args.output} names a picture, --film {args.film} a film; leave one out and start again for the other")
        if args.film and args.film.suffix not in (".mp4", ".gif"):
            raise Mistake(f"--film {args.film}: the ending has to be .mp4 or .gif")
        size_of(args.size)
        refuse_unfinished(args.run)
        print(f"wrote {film(args) if args.film else picture(args)}")


def size_of(text):
    try:
        width, height = (int(number) for number in text.split("x"))
    except ValueError:
        raise Mistake(f"--size {text} is not WIDTHxHEIGHT, such as 1280x960") from None
    # Encoders of films want even numbers.
    if min(width, height) < 16 or max(width, height) > 8192 or width % 2 or height % 2:
        raise Mistake(f"--size {text}: both have to be even, from 16 to 8192")
    return width, height


def check(run, name, what, *words):
    """A mistake where a file of a run is missing or cut short; `what` gives it, `words` are the options that wind it again."""
    path = run / name
    if not path.is_file():
        raise Mistake(f"{path} is missing; {what}")
    with open(path, "rb") as file:
        file.seek(max(path.stat().st_size - 64, 0))
        if END not in file.read():
            raise broken(run, name, "it ends too early", *words)


def read(run, name, what, *words):
    """A surface or a line of a run, which has passed `check`."""
    check(run, name, what, *words)
    try:
        with quiet(), pv.VtkErrorCatcher(raise_errors=True, send_to_logging=False):
            return pv.read(run / name)
    except Exception as error:
        # VTK says who noticed, in a first line or in front of the second one, and then what.
        reason = (str(error).splitlines() or ["no file of VTK"])[:2][-1]
        raise broken(run, name, re.sub(r"^\w+ \(0x\w+\): ", "", reason).strip('\t."'), *words) from None


@contextlib.contextmanager
def quiet():
    """Keeps VTK and pyvista from telling in their own ways what is raised; an error of a reader, of which pyvista only warns, is raised too."""
    logging.disable()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.filterwarnings("error", message="The VTK reader")
            yield
    finally:
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
        logging.disable(logging.NOTSET)


def broken(run, name, reason, *words):
    return Mistake(f"{run}: {name} is not whole ({reason}); {folders.wind_again(run, *words)}")


def refuse_unfinished(run):
    """A mistake where the folder holds no run, or one without results: it is under way, or was killed before it wrote them."""
    folders.refuse_without_run(run)
    ended = (run / "summary.json").exists() and not (run / folders.CHECKPOINT).exists()
    if not ended and folders.is_under_way(run):
        raise Mistake(f"{run}: the run is under way and has not written its results; wait for its end, or stop it first")
    if (run / "scene.toml").exists() and not (run / "summary.json").exists():
        raise Mistake(f"{run}: the run was stopped before it wrote its results; {folders.wind_again(run)}")


def picture(args):
    coil = Coil(args)
    plotter = coil.stage()
    plotter.add_mesh(coil.tube(coil.end), reset_camera=False, **coil.look)
    output = args.output or args.run / "render.png"
    folders.write_whole(output, lambda path: shot(plotter).save(path, "PNG"))
    return output


def shot(plotter):
    """The picture that is on the stage."""
    return Image.fromarray(plotter.screenshot(return_img=True))


def film(args):
    frames = frames_of(args.run)
    coil = Coil(args)
    words = ["--frames", str(len(frames))]
    files = [(name, folders.wind_again(args.run, *words), *words) for _, name in frames]
    # Before the film begins, since half of one is of no use.
    for file in files:
        check(args.run, *file)
    plotter = coil.stage()
    progress = Progress("frames", len(frames))

    def pictures():
        for (time, _), file in zip(frames, files):
            wire = read(args.run, *file)
            if wire.n_points < 2:
                continue
            plotter.add_mesh(coil.tube(wire), name="wire", reset_camera=False, **coil.look)
            plotter.add_text(f"{1e3 * time:.1f} ms", name="time", font_size=12, color="black", position="upper_left")
            yield shot(plotter)
            progress.step()

    write = write_mp4 if args.film.suffix == ".mp4" else write_gif
    try:
        folders.write_whole(args.film, lambda path: write(path, pictures(), args.rate))
    finally:
        progress.end()
    return args.film


def write_gif(path, pictures, rate):
    first, *others = pictures
    first.save(path, "GIF", save_all=True, append_images=others, duration=1000 / rate, loop=0)


def write_mp4(path, pictures, rate):
    count = 0
    # Blocks of other sizes than 2 would change that of the film.
    with imageio.get_writer(path, "FFMPEG", fps=rate, quality=7, macro_block_size=2) as film:
        for picture in pictures:
            film.append_data(np.asarray(picture))
            count += 1
    # The encoder does not say what it could not write.
    try:
        written, _ = imageio_ffmpeg.count_frames_and_secs(path)
    except RuntimeError:
        written = 0
    if written != count:
        raise OSError(f"{written} of {count} frames can be read again; the disk may be full")


def frames_of(run):
    """Time and file of every frame."""
    series = run / "frames.pvd"
    if not series.is_file():
        raise Mistake(f"{series} is missing; wind the run with --frames N, such as --frames 100")
    try:
        return [(float(frame.attrib["timestep"]), frame.attrib["file"]) for frame in ElementTree.parse(series).iter("DataSet")]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise broken(run, series.name, error, "--frames", "100") from None


def whole_steps(low, high):
    """Upper end and labels of a scale of whole numbers from `low` up to `high` or little above: at most six labels, with even steps."""
    span = max(1, round(high - low))
    step = -(-span // 5)
    steps = -(-span // step)
    return low + step * steps, steps + 1


class Coil:
    """What does not change in a film: core, camera and colours."""

    def __init__(self, args):
        self.args, self.size = args, size_of(args.size)
        surface = read(args.run, "coil.vtp", "wind the run without --no-geometry")
        if surface.n_points == 0:
            raise Mistake(f"{args.run / 'coil.vtp'} holds no wire; wind for longer")
        self.end = centreline(surface)
        self.radius = float(np.linalg.norm(surface.points[0] - self.end.points[0]))
        # Wire at rest is the coil; the rest leads to the nozzle.
        self.rest = self.end["frozen"] == 1
        if self.rest.sum() < 2:
            self.rest = np.full(self.end.n_points, True)
        self.look = {"smooth_shading": True, "specular": 0.3, "specular_power": 25, **self.colours()}

    def colours(self):
        array, factor, title = COLOURS[self.args.colour]
        if array is None:
            return {"color": COPPER}
        values = factor * self.end[array][self.rest].astype(float)
        values = values[np.isfinite(values)]
        if values.size == 0:
            raise Mistake(f"no wire of {self.args.run} has a {self.args.colour} yet; choose --colour tension")
        counted = array in ("layer", "turn")
        # One place that stands out must not take the colours from all others.
        low, high = (values.min(), values.max()) if counted else np.percentile(values, [1, 99])
        shown = factor * self.end[array].astype(float)
        # (what rounding leaves of zero is zero)
        reach = [0.0 if abs(x) < 1e-9 * high else x for x in (np.nanmin(shown), np.nanmax(shown))]
        if not counted and (reach[0] < low or reach[1] > high):
            title += f"\nvalues from\n{reach[0]:.3g} to {reach[1]:.3g}"
        high, labels = whole_steps(low, high) if counted else (max(high, low + 1e-9), 5)
        width, share = self.size[0], self.bar_share()
        small = min(1.0, share * width / BAR + 0.1)
        bar = {
            # An empty line keeps the title clear of the number at the top of the bar.
            "title": f"{title}\n", "color": "black", "vertical": True, "position_x": 1.0 - 0.65 * share, "position_y": 0.15, "width": 0.35 * share,
            "height": 0.65, "title_font_size": round(20 * small), "label_font_size": round(18 * small), "fmt": "%.0f" if counted else "%.3g",
            "n_labels": labels,
        }
        return {"scalars": "shown", "clim": (low, high), "cmap": "viridis", "nan_color": "#c9c9c9", "scalar_bar_args": bar}

    def bar_share(self):
        """Share of the picture's width that the scale of colours takes."""
        return min(BAR / self.size[0], BAR_SHARE)

    def faces(self):
        """Where the inner faces of the flanges stand along the axis, m; None without flanges."""
        summary = self.args.run / "summary.json"
        if not summary.is_file():
            return None
        try:
            window = json.loads(summary.read_text(encoding="utf-8"))["product"]["window"]
            return window and window["faces_m"]
        except (ValueError, KeyError, TypeError):
            raise broken(self.args.run, summary.name, "it does not tell the winding window") from None

    def tube(self, wire):
        """The surface of a wire, with the numbers that colour it."""
        array, factor, _ = COLOURS[self.args.colour]
        # One line through all nodes: a tube of each edge for itself would show a seam at every node.
        line = pv.MultipleLines(points=wire.points)
        if array is not None:
            line["shown"] = factor * wire[array].astype(float)
        return line.tube(radius=self.radius, n_sides=SIDES)

    def stage(self):
        """The core, seen such that the windings of the end fill the picture."""
        plotter = pv.Plotter(off_screen=True, window_size=self.size, lighting="three lights")
        plotter.set_background(PAPER)
        plotter.enable_anti_aliasing("ssaa")
        points = self.end.points[self.rest]
        low, high = points.min(axis=0) - self.radius, points.max(axis=0) + self.radius
        core = None if self.args.no_core else read(self.args.run, "core.vtp", "wind the run without --no-geometry")
        if core is not None:
            faces = self.faces()
            if faces and not self.args.flanges:
                # A face in the plane of the cut would be left in shreds.
                inset = 1e-3 * (faces[1] - faces[0])
                core = between(core, faces[0] + inset, faces[1] - inset)
            plotter.add_mesh(core, color=CORE, specular=0.1, reset_camera=False)
        middle, reach = 0.5 * (low + high), 0.5 * np.linalg.norm(high - low)
        if core is not None and self.args.flanges:
            reach = max(reach, np.linalg.norm(core.points - middle, axis=1).max())
        towards = np.array(VIEWS[self.args.view]) / np.linalg.norm(VIEWS[self.args.view])
        plotter.camera.view_angle = 30.0
        width, height = self.size
        room = 1.0 - self.bar_share() if "scalars" in self.look else 1.0
        half = np.tan(np.radians(15.0)) * min(1.0, room * width / height)
        distance = 1.05 * reach / np.sin(np.arctan(half))
        # To the left, clear of the scale of colours.
        plotter.camera.SetWindowCenter(1.0 - room, 0.0)
        plotter.camera.focal_point = middle
        plotter.camera.position = middle + distance * towards
        # The axis of the core stands upright, but where the camera looks along it.
        if self.args.view == "axis":
            # A core that stands out of its coil would hide it in perspective.
            plotter.camera.parallel_projection = True
            plotter.camera.parallel_scale = 1.05 * reach / min(1.0, room * width / height)
            if core is not None:
                distance += np.linalg.norm(core.points - middle, axis=1).max()
                plotter.camera.position = middle + distance * towards
        plotter.camera.up = (0.0, 0.0, 1.0) if self.args.view == "axis" else (0.0, 1.0, 0.0)
        plotter.camera.clipping_range = (0.05 * distance, 20.0 * distance)
        return plotter


def centreline(surface):
    """The middle of each ring of a wire's surface, with what is known of the nodes."""
    sides = int(np.argmax(surface["arc"] != surface["arc"][0]))
    line = pv.PolyData(surface.points.reshape(-1, sides, 3).mean(axis=1))
    for name in surface.point_data.keys():
        if name != "Normals":
            line[name] = surface[name][::sides]
    return line


def between(core, low, high):
    """The part of a core from one height along its axis to another, closed where it is cut."""
    bottom, top = core.points[:, 1].min(), core.points[:, 1].max()
    for height, normal, cuts in ((low, (0, 1, 0), low > bottom), (high, (0, -1, 0), high < top)):
        if not cuts:
            continue
        try:
            core = core.clip_closed_surface(normal=normal, origin=(0, height, 0))
        except ValueError:  # a mesh with holes
            core = core.clip(normal=normal, origin=(0, height, 0), invert=False)
    return core


if __name__ == "__main__":
    main()
