#!/usr/bin/env python3
"""Makes modelDescription/documentation/model.png, what importers show for the FMU.

It is docs/coil.png, drawn by `coilwind run bobbin`, at a third of the size. Run it with
`$(scripts/venv.sh) scripts/model_picture.py` when that picture has changed, and commit the result.
"""

from pathlib import Path

from matplotlib import image

ROOT = Path(__file__).resolve().parents[1]
SHARE = 3


def main():
    picture = image.imread(ROOT / "docs/coil.png")[..., :3]
    high, wide = (n // SHARE for n in picture.shape[:2])
    blocks = picture[: high * SHARE, : wide * SHARE].reshape(high, SHARE, wide, SHARE, 3)
    # No software name or time in the file: the same picture gives the same bytes.
    image.imsave(
        ROOT / "modelDescription/documentation/model.png",
        blocks.mean(axis=(1, 3)),
        metadata={"Software": None},
    )


main()
