"""lull for Python: the renderer as functions, and for other renderers the stopping rule and the denoiser.

    import lull
    r = lull.render("scene.pbrt", resolution=(400, 300), denoise=True)
    r.image, r.spp, r.blocks, r.seconds

Options are those of the command of the same name, with _ for -: `lull render --help`. `python -m
lull` is the program itself. Decisions of a Stopper go to the logger "lull.stopper": images with
the level INFO, blocks with DEBUG.
"""
from ._lull import *  # noqa: F401,F403
from ._lull import __version__  # noqa: F401
from .commands import Comparison, Rendering, compare, entropy, evaluate, render  # noqa: F401
from .program import Error  # noqa: F401
