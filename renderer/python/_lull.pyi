"""Types of the extension of the module `lull`."""
from typing import NamedTuple

import numpy as np

Layer = np.ndarray | tuple[np.ndarray, np.ndarray] | list[np.ndarray] | None

__version__: str


class BlockAnswer:
    """State of one block.

    `value` is compared with `threshold`; `probability` (models) is that of an observer seeing noise;
    `masked_noise` is in L*.
    """
    stop: bool
    checked: bool
    spp: int
    next_spp: int
    votes: int
    votes_needed: int
    value: float
    threshold: float
    probability: float | None
    masked_noise: float | None


class Answer:
    """State of all blocks: arrays of rows x columns, with the fields of BlockAnswer.

    `stop` is True if all blocks are clean. `probability` is None for rules without one,
    `masked_noise` without half buffers.
    """
    stop: bool
    stopped: np.ndarray
    checked: np.ndarray
    spp: np.ndarray
    next_spp: np.ndarray
    votes: np.ndarray
    value: np.ndarray
    threshold: np.ndarray
    probability: np.ndarray | None
    masked_noise: np.ndarray | None


class Stopper:
    """Decides which blocks of one image need more samples, from its first samples to its last.

    `blocks` are (x, y, width, height), row by row. `active` is a height x width array, True where more
    samples are needed. `done` is True if all blocks are clean, `needs_half` if the rule reads `half`.
    """
    width: int
    height: int
    blocks: list[tuple[int, int, int, int]]
    active: np.ndarray
    done: bool
    needs_half: bool

    def __init__(self, width: int, height: int, model: str | None = None, *, rule: str | None = None,
                 models: str | None = None, block: int = 200, pass_spp: int = 0, cap: int = 0,
                 caution: float = 1.0) -> None:
        """Creates a stopper.

        Args:
            width, height: pixels of the image, 40 to 65,536.
            model: an installed model ("entropy", the default, "paper") or a file.
            rule: any other rule of `lull render --stop`, instead of a model.
            models: folder of installed models.
            block: side of the blocks in pixels.
            pass_spp: spp between two images; 0: any.
            cap: maximum spp, if above 10,000.
            caution: 2 allows half as much visible noise.

        Raises: ValueError for invalid arguments, OSError for a model that cannot be read.
        """
    def observe(self, image: np.ndarray, spp: int, half: np.ndarray | None = None) -> Answer:
        """Checks all active blocks.

        Args:
            image: height x width x 3, float32 (linear) or uint8 (sRGB), with any strides.
            spp: sample count of the active blocks, larger than at the last call.
            half: mean of a fixed half of the samples, like `image`.

        Returns: the state of all blocks.
        Raises: ValueError for images of another shape, type or range.
        """
    def observe_block(self, block: int, image: np.ndarray, spp: int,
                      half: np.ndarray | None = None) -> BlockAnswer:
        """Checks one block, with an image of its size. See observe()."""
    def answer(self) -> Answer:
        """Returns the state of all blocks."""
    def save(self) -> bytes:
        """Serialises the state of the stopper."""
    def restore(self, state: bytes) -> None:
        """Restores the state of save() into a stopper with equal arguments.

        Raises: OSError for damaged states, and states of other arguments.
        """


class SvdEntropy(NamedTuple):
    """The SVD-entropies of the sub-blocks of an image: arrays of their rows x columns, in [0, 1].

    h = h1 + h2, where h1 has the terms of the first quarter of the singular values.
    """
    h: np.ndarray
    h1: np.ndarray
    h2: np.ndarray


def svd_entropy(image: np.ndarray, sub_blocks: int = 100) -> SvdEntropy:
    """Computes the SVD-entropy of the lightness of each sub-block of an image."""
def attributes26(image: np.ndarray) -> np.ndarray:
    """Computes the 26 attributes of the paper of an image."""


class Denoised:
    """A denoised image of height x width pixels, and its estimated error.

    `image` is height x width x 3, float32, linear. `error` is the standard error of each pixel in L*.
    `blocks` are (x, y, width, height), row by row. `estimate` and `upper` (exceeded in 10 of 100 blocks)
    are their visible differences from the true image, as arrays of rows x columns.
    """
    image: np.ndarray
    error: np.ndarray
    blocks: list[tuple[int, int, int, int]]
    estimate: np.ndarray
    upper: np.ndarray


def denoise(a: np.ndarray, b: np.ndarray, *, albedo: Layer = None, normal: Layer = None,
            depth: Layer = None, block: int = 200) -> Denoised:
    """Denoises an image, given as two half buffers.

    Args:
        a, b: means of independent samples, height x width x 3, linear; e.g. renders with other seeds.
        albedo: of first hits, height x width x 3, 0 to 1: an array, or a pair for a and b.
        normal: of first hits, height x width x 3, -1 to 1; likewise.
        depth: of first hits, height x width, above 0; likewise.
        block: side of the blocks of the error estimate, in pixels.

    Raises: ValueError for arrays of another shape, type or range, and for dependent a and b.
    """
