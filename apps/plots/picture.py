"""The README's picture: the bed beside its force chains. picture.py DIR OUT.png"""
import argparse
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import bed_picture  # noqa: E402
import style  # noqa: E402
from read_run import Missing, Run  # noqa: E402


def build(folder, out, width=None):
    """Bed and chains side by side, or one above the other where the bed is long."""
    style.use()
    run = Run(folder)
    bed = bed_picture.Bed(run)
    left = bed_picture.stones(run, width=width, bed=bed)
    try:
        right = bed_picture.chains(run, width=width, bed=bed, backdrop=left.image)
        images = [left.image, right.image]
    except Missing:
        images = [left.image]
    white = np.min([(image > 0.995).all(axis=2) for image in images], axis=0)
    rows, columns = np.flatnonzero(~white.all(axis=1)), np.flatnonzero(~white.all(axis=0))
    images = [image[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1] for image in images]
    side = images[0].shape[1] < 1.8 * images[0].shape[0]
    gap = 40
    blank = np.ones((images[0].shape[0], gap, 3)) if side else np.ones((gap, images[0].shape[1], 3))
    joined = images[0]
    for image in images[1:]:
        joined = np.concatenate([joined, blank, image], axis=1 if side else 0)
    framed = np.ones((joined.shape[0] + 2 * gap, joined.shape[1] + 2 * gap, 3))
    framed[gap:-gap, gap:-gap] = joined
    plt.imsave(out, np.clip(framed, 0, 1).astype(np.float32), metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description="The bed and its force chains in one picture.")
    parser.add_argument("folder", help="folder of a run")
    parser.add_argument("out", help="PNG to write")
    parser.add_argument("--width", type=int, help="pixels of each half")
    options = parser.parse_args()
    try:
        build(options.folder, options.out, options.width)
    except (Missing, OSError) as why:
        print(f"picture: {why}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
