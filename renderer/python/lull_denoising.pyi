"""The types of the module `lull_denoising`."""
import numpy as np

Layer = np.ndarray | tuple[np.ndarray, np.ndarray] | list[np.ndarray] | None


class Denoised:
    picture: np.ndarray
    error: np.ndarray
    blocks: list[tuple[int, int, int, int]]
    estimate: np.ndarray
    upper: np.ndarray


def denoise(a: np.ndarray, b: np.ndarray, *, albedo: Layer = None, normal: Layer = None,
            depth: Layer = None, block: int = 200) -> Denoised: ...
