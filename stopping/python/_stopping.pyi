"""The types of what the module `lull` has of stopping."""
import numpy as np

__version__: str


class BlockAnswer:
    stop: bool
    checked: bool
    spp: int
    next_spp: int
    votes: int
    votes_needed: int
    people_low: int
    people_high: int
    value: float
    threshold: float
    probability: float | None
    visible_noise: float | None


class Answer:
    stop: bool
    stopped: np.ndarray
    checked: np.ndarray
    spp: np.ndarray
    next_spp: np.ndarray
    votes: np.ndarray
    people_low: np.ndarray
    people_high: np.ndarray
    value: np.ndarray
    threshold: np.ndarray
    probability: np.ndarray | None
    visible_noise: np.ndarray | None


class Stopper:
    width: int
    height: int
    blocks: list[tuple[int, int, int, int]]
    active: np.ndarray
    done: bool
    needs_half: bool

    def __init__(self, width: int, height: int, model: str | None = None, *, rule: str | None = None,
                 models: str | None = None, block: int = 200, pass_spp: int = 0, cap: int = 0,
                 caution: float = 1.0) -> None: ...
    def observe(self, image: np.ndarray, spp: int, half: np.ndarray | None = None) -> Answer: ...
    def observe_block(self, block: int, image: np.ndarray, spp: int,
                      half: np.ndarray | None = None) -> BlockAnswer: ...
    def answer(self) -> Answer: ...
    def save(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...
