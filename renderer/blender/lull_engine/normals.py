"""Normal maps: their strength as Cycles has it, and how far their normals lean."""
import numpy as np

import images

# Of the light of a white sky, what Cycles takes from diffuse surfaces whose normals lean by so many degrees, and lull does not.
_LEANS, _DIMMED = (0, 5, 10, 15, 20, 27, 35, 45, 60), (0, 0.013, 0.035, 0.057, 0.077, 0.101, 0.121, 0.133, 0.125)
MOST = 0.02


def dimmed(pixels, strength=1):
    """Returns the share of a white sky's light that Cycles takes from a diffuse surface with the normals of these pixels."""
    x, y, z = _vectors(pixels, strength)
    return float(np.interp(np.degrees(np.arctan2(np.hypot(x, y), z)), _LEANS, _DIMMED).mean())


def weakened(pixels, name, strength):
    """Returns the image of a normal map of strength 1: Cycles raises z where the strength is below 1, glTF does not."""
    values, vectors = pixels.copy(), np.stack(_vectors(pixels, strength), -1)
    values[:, :, :3] = 0.5 + 0.5 * vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)
    return images.made_of(values, name, 'Non-Color')


def _vectors(pixels, strength):
    x, y, z = (2 * pixels[..., i].astype(float) - 1 for i in range(3))
    return x * strength, y * strength, 1 + (z - 1) * min(max(strength, 0), 1)
