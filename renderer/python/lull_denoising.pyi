"""Types of the module `lull_denoising`."""
import numpy as np

Layer = np.ndarray | tuple[np.ndarray, np.ndarray] | list[np.ndarray] | None


class Denoised:
    """A denoised image of height x width pixels, and its estimated error.

    `picture` is height x width x 3, float32, linear. `error` is the standard error of each pixel in L*.
    `blocks` are (x, y, width, height), row by row. `estimate` and `upper` (exceeded in 10 of 100 blocks)
    are their visible differences from the true image, as arrays of rows x columns.
    """
    picture: np.ndarray
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
