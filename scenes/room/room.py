#!/usr/bin/env python3
"""Makes the files that room.pbrt and room-night.pbrt include: the things in the room, and the images on them.

room.py [FOLDER]: writes to FOLDER (this one by default). Everything is a function of the numbers below, so that the files
are the same, byte for byte, each time. Metres; x to the right, y up, z away from the camera.
materials.pbrt has the materials that are named here. Soft and turned things are cages that the renderer
subdivides; planks, books, leaves and the like are instances.
"""
import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from cages import PbrtScene, box, cushion, group, joined, lathe, sheet, torus, tube  # noqa: E402
from images import write_images  # noqa: E402

LEFT, RIGHT, FRONT, BACK, HEIGHT = -2.2, 2.5, -1.9, 5.0, 2.75  # of the room, inside
WINDOWS = [(-1.2, -.1), (1.85, 2.95), (3.4, 4.5)]               # along z, in the left wall
SILL, HEAD, WALL = .42, 2.38, .26                               # height of the windows, thickness of the wall
PLANKS, SHADES, COVERS = 9, 6, 12                               # kinds of planks, their colours, kinds of books


def walls(s):
    """Walls, ceiling, mouldings, windows; the view outside."""
    outer = LEFT - WALL
    s.shape('ceiling', box((LEFT - .3, HEIGHT, FRONT - .3), (RIGHT + .3, HEIGHT + .1, BACK + .3), 0))
    s.shape('limewash', box((LEFT - .3, -.05, BACK), (RIGHT + .3, HEIGHT, BACK + .2), 0))
    s.shape('plaster', joined(box((RIGHT, -.05, FRONT - .3), (RIGHT + .2, HEIGHT, BACK + .3), 0),
                              box((LEFT - .3, -.05, FRONT - .2), (RIGHT + .3, HEIGHT, FRONT), 0)))
    ends = [FRONT - .2] + [z for window in WINDOWS for z in window] + [BACK + .2]
    wall = [box((outer, -.05, a), (LEFT, HEIGHT, b), .006) for a, b in zip(ends[::2], ends[1::2])]
    for a, b in WINDOWS:
        wall += [box((outer, -.05, a - .02), (LEFT, SILL - .03, b + .02), 0),
                 box((outer, HEAD, a - .02), (LEFT, HEIGHT, b + .02), .006)]
    s.shape('plaster', joined(*wall))

    trim = []
    for y0, y1, depth in ((0, .11, .018), (.11, .125, .012)):  # skirting
        trim += [box((LEFT, y0, FRONT), (LEFT + depth, y1, BACK), .005),
                 box((LEFT, y0, BACK - depth), (RIGHT, y1, BACK), .005)]
    for y, depth in ((HEIGHT - .03, .09), (HEIGHT - .06, .06), (HEIGHT - .08, .03)):  # cornice
        trim += [box((LEFT, y, FRONT), (LEFT + depth, HEIGHT, BACK), .01),
                 box((LEFT, y, BACK - depth), (RIGHT, HEIGHT, BACK), .01)]
    s.shape('paint', joined(*trim))

    half, x = (WINDOWS[0][1] - WINDOWS[0][0]) / 2, .06 - WALL
    frame = [box((-WALL, SILL - .03, -half - .06), (.05, SILL, half + .06), .006)]
    for z0, z1 in ((-half, -half + .055), (half - .055, half), (-.03, .03)):
        frame.append(box((x, SILL, z0), (x + .06, HEAD, z1), .006))
    for y0, y1 in ((SILL, SILL + .075), (HEAD - .06, HEAD)):
        frame.append(box((x + .004, y0, -half), (x + .056, y1, half), .006))
    for k in (1, 2, 3):
        y = SILL + k * (HEAD - SILL) / 4
        frame.append(box((x + .015, y - .013, -half), (x + .045, y + .013, half), .006))
    with s.object('window'):
        s.shape('paint', joined(*frame))
    for a, b in WINDOWS:
        s.instance('window', (LEFT, 0, (a + b) / 2))

    s.shape('lawn', box((LEFT - 12, -.6, -14), (outer, -.5, 24), 0))
    s.shape('hedge', box((LEFT - 6.6, -.5, -14), (LEFT - 5.5, 1.75, 24), .08))


def floor(s):
    """Planks of random length; no two of one colour end to end."""
    rng = random.Random(11)
    for k in range(PLANKS):
        with s.object(f'plank{k}'):
            s.shape(f'plank{k % SHADES}', box((0, -.02, 0), (.1485, 0, 1), .0016, 2, k * .37), textured=True)
    x, last = LEFT, 0
    while x < RIGHT:
        z = FRONT - rng.uniform(0, 1.4)
        while z < BACK:
            length = rng.uniform(1.1, 1.9)
            kind = rng.choice([k for k in range(PLANKS) if k % SHADES != last])
            s.instance(f'plank{kind}', (x, 0, z), scale=(1, 1, length - .0012))
            z, last = z + length, kind % SHADES
        x += .15
    s.shape('soil', box((LEFT, -.1, FRONT - 1.5), (RIGHT + 1, -.019, BACK + 1), 0))


def curtains(s):
    """Two kinds of panels, each hung several times, and their rods and rings."""
    for name, folds, seed in (('curtain0', 5, 1), ('curtain1', 4, 2)):
        rng = random.Random(seed)
        swells = [rng.uniform(.6, 1.15) for _ in range(folds + 1)]
        leans = [rng.uniform(-1, 1) for _ in range(folds + 1)]

        def cloth(u, v):
            t = u * folds
            k = min(int(t), folds - 1)
            swell = swells[k] * (1 - t + k) + swells[k + 1] * (t - k)
            lean = leans[k] * (1 - t + k) + leans[k + 1] * (t - k)
            phase = 2 * math.pi * t + .9 * lean * v
            return ((.03 + .022 * v) * swell * math.sin(phase) + .02 * lean * v, -v * 2.445,
                    (u - .5) * (.40 + .07 * v) + .005 * math.sin(2 * phase) + .02 * lean * math.sin(2.5 * v))
        with s.object(name):
            s.shape('linen', sheet(cloth, folds * 7, 5))
    with s.object('ring'):
        s.shape('brass', torus(.026, .0045, 10), 1)
    with s.object('finial'):
        s.shape('brass', lathe([(.001, -.03), (.02, -.025), (.028, 0), (.02, .025), (.001, .03)]))
    x, y, wide = LEFT + .1, 2.5, WINDOWS[0][1] - WINDOWS[0][0]
    with s.object('rod'):
        s.shape('brass', tube([(0, 0, z) for z in (0, .002, .4, .8, wide + .718, wide + .72)], [.011] * 6), 1)
        s.shape('brass', joined(*(part for z in (.03, wide + .69) for part in (
            box((LEFT - x, -.006, z - .006), (0, .006, z + .006), 0),
            box((LEFT - x, -.03, z - .015), (LEFT - x + .006, .03, z + .015))))))
    for window, (a, b) in enumerate(WINDOWS):
        s.instance('rod', (x, y, a - .36))
        for k, (z, turn) in enumerate(((a - .1, 0), (b + .1, 180))):
            s.instance(f'curtain{(window + k) % 2}', (x, y - .03, z), turn)
            s.instance('finial', (x, y, z + .28 * (2 * k - 1)), 0, 90)
            for i in range(7):
                s.instance('ring', (x, y - .012, z - .19 + .38 * i / 6), 12 * (i % 3 - 1), 90)


def rug(s):
    """A kilim with fringes."""
    wide, deep, n, m = 2.5, 1.7, 12, 8
    uvs = [(i / n, j / m) for j in range(m + 1) for i in range(n + 1)]
    points = [((u - .5) * wide, .007 + .0016 * math.sin(16 * u + 2 * math.sin(8 * v)), (v - .5) * deep) for u, v in uvs]
    triangles = [t for j in range(m) for i in range(n) for a in [j * (n + 1) + i]
                 for t in ((a, a + 1, a + n + 1), (a + 1, a + n + 2, a + n + 1))]
    tassel = tube([(0, .005, 0), (.001, .004, .02), (.004, .002, .05), (.002, .002, .075)],
                  [.004, .003, .004, .002], 4)
    with s.object('tassels'):
        s.shape('wool', group(*((tassel, (.0169 * k, 0, 0), turn) for k, turn in enumerate((11, -9, 4, -13)))), 1)
    rng = random.Random(9)
    with s.placed((-.05, 0, 3.02), -4):
        s.shape('kilim', (points, triangles, uvs), textured=True)
        s.shape('wool', box((-wide / 2 + .006, .0005, -deep / 2 + .004), (wide / 2 - .006, .0052, deep / 2 - .004)))
        for side in (-1, 1):
            for i in range(25):
                s.instance('tassels', (side * (wide / 2 - .004), .001, side * (.5 - (i + .15) / 25) * (deep - .01)),
                           90 * side + rng.uniform(-3, 3), scale=(1, 1, rng.uniform(.85, 1.15)))


def armchair(s):
    """Velvet on turned legs, with a pillow and a throw over its arm; it faces -z."""
    with s.placed((-.72, 0, 3.72), -38):
        for side in (-1, 1):
            for z, slant in ((-.33, -.05), (.33, .06)):
                path = [(side * (.30 + .03 * t), .17 - .17 * t, z + slant * t) for t in (0, .05, .95, 1)]
                s.shape('turned', tube(path, [.025, .025, .015, .015]))
            with s.placed((side * .355, .385, 0), roll=-3 * side):
                s.shape('velvet', cushion((.13, .43, .80), (.012, .014, .01), .8))
        s.shape('velvet', cushion((.62, .13, .74), (0, .01, 0), .84, (0, .235, 0)))
        with s.placed((0, .355, -.055), tilt=-4):
            s.shape('velvet', cushion((.575, .15, .66), (0, .028, .012), .8))
        with s.placed((0, .57, .315), tilt=13):
            s.shape('velvet', cushion((.60, .62, .17), (0, .02, .022), .82))
        with s.placed((.10, .585, .15), 12, 20, 9):
            s.shape('stripes', cushion((.44, .44, .045), (-.035, -.035, .075), .9))

        # The throw: its course across the arm, from the seat outwards and down
        course = [(-.105, .26), (-.10, .40), (-.092, .54), (-.078, .612), (-.03, .634), (.03, .634), (.08, .612),
                  (.092, .54), (.10, .40), (.11, .25), (.12, .12)]

        def throw(u, v):
            k = min(int(v * (len(course) - 1)), len(course) - 2)
            t = v * (len(course) - 1) - k
            x, y = (a + (b - a) * t for a, b in zip(course[k], course[k + 1]))
            away = max(0, abs(v - .45) - .12)
            ripple = .012 + .008 * math.sin(9 * u + 1.4) + .006 * math.sin(17 * u + 3.3)
            return (x + ripple * (1 if v > .45 else -1) * min(1, 8 * away),
                    y + .008 + .02 * away * math.sin(5 * u + 2.2), -.30 + .36 * u + .05 * (v - .5))
        with s.placed((.355, 0, 0)):
            s.shape('indigo', sheet(throw, 16, 20))


def vessel(s, material, at, outline, bottom=.012, thick=.004):
    """Adds a vessel: its outline [(radius, height)] outside, and the same inside, down to `bottom`."""
    inside = [(r - thick, y) for r, y in reversed(outline) if y > bottom]
    outline = [(outline[0][0] / 2, 0)] + outline + inside
    with s.placed(at):
        s.shape(material, lathe(outline + [(inside[-1][0] * .8, bottom), (inside[-1][0] * .3, bottom)], 8))


def stack(s, at, books, turn, rng):
    """Lays books, each (width, thickness, depth, kind), on one another."""
    x, y, z = at
    for wide, thick, deep, kind in books:
        s.instance(f'book{kind}', (x + wide / 2, y, z), turn + rng.uniform(-7, 7), roll=90, scale=(thick, wide, deep))
        y += thick + .0005


def tables(s):
    """A low table with oranges and books, a side table with a mug, and a pouf."""
    for at, r, y, legs in (((.02, 0, 3.70), .24, .52, 3), ((.82, 0, 2.66), .46, .36, 4)):
        with s.placed(at):
            s.shape('turned', lathe([(r - .02, y - .022), (r - .004, y - .02), (r, y - .012), (r - .002, y - .002),
                                     (r - .008, y), (r - .03, y)], 14))
            for k in range(legs):
                a = 2 * math.pi * k / legs + .5
                path = [(r * (.55 + .33 * t) * math.cos(a), (y - .015) * (1 - t), r * (.55 + .33 * t) * math.sin(a))
                        for t in (0, .03, .97, 1)]
                s.shape('turned', tube(path, [.018, .018, .012, .012]))
    vessel(s, 'celadon', (.13, .522, 3.62), [(.028, 0), (.036, .004), (.04, .03), (.041, .07), (.0415, .085)], .07)
    rng = random.Random(2)
    stack(s, (-.03, .522, 3.66), [(.24, .03, .17, 10), (.22, .024, .16, 5)], -62, rng)
    stack(s, (.66, .362, 2.72), [(.30, .032, .23, 6), (.26, .028, .20, 2), (.23, .02, .17, 7)], 24, rng)
    x, y, z = .80, .36, 2.42
    vessel(s, 'stoneware', (x, y, z), [(.05, 0), (.055, .006), (.06, .012), (.11, .04), (.14, .075), (.146, .08)],
           .016, .006)
    with s.object('orange'):
        s.shape('orange', lathe([(.004, -.034), (.02, -.032), (.038, -.012), (.038, .014), (.02, .034), (.003, .033)], 8))
    for dx, dy, dz in ((-.045, .058, .03), (.045, .058, .022), (0, .058, -.05), (.005, .108, .002)):
        s.instance('orange', (x + dx, y + dy, z + dz), 100 * dx, 900 * dz)
    with s.placed((-1.22, 0, 2.62)):
        s.shape('ochre', lathe([(.12, 0), (.20, .003), (.255, .05), (.285, .16), (.265, .27), (.21, .325), (.10, .335),
                                (.03, .332)], 36, ribs=12), 1)


def book():
    """Returns cover and pages of a book of 1 x 1 x 1 whose spine is in front."""
    arc = [(.5 - .5 * math.cos(math.pi * i / 6), .035 - .035 * math.sin(math.pi * i / 6)) for i in range(7)]
    outer = [(0, 1)] + arc + [(1, 1)]
    inner = [(.08, 1)] + [(.08 + .84 * x, .04 + z) for x, z in arc] + [(.92, 1)]
    n = len(outer)
    points = [(x, y, z) for outline in (outer, inner) for y in (0, 1) for x, z in outline]
    # The image is on the spine, the colour of its lower edge on all else.
    uvs = [(min(.999, max(.001, x)), y * (.998 if z < .04 else 0) + .001) for x, y, z in points]
    triangles = [t for i in range(n - 1) for a, b in ((0, n), (2 * n, 3 * n), (0, 2 * n), (n, 3 * n))
                 for t in ((a + i, a + i + 1, b + i), (a + i + 1, b + i + 1, b + i))]
    return (points, triangles, uvs), box((.06, .015, .05), (.94, .985, .97), 0)


def bookcase(s):
    """Six shelves in two columns, full of books."""
    cover, pages = book()
    for k in range(COVERS):
        with s.object(f'book{k}'):
            s.shape(f'cover{k}', cover, textured=True, file='cover.pbrt')
            s.shape('paper', pages, file='pages.pbrt')
    x0, x1, z0, z1, board, top = .62, 2.22, 4.66, BACK - .02, .026, 2.24
    middle, levels = (x0 + x1) / 2, [.10, .47, .85, 1.20, 1.55, 1.88]
    columns = (x0 + board, middle - board / 2), (middle + board / 2, x1 - board)
    s.shape('oak', joined(
        *(box((x, 0, z0), (x + board, top, z1), .002) for x in (x0, middle - board / 2, x1 - board)),
        *(box((a, y - board, z0 + .004), (b, y, z1), .002) for a, b in columns for y in levels),
        box((x0 - .015, top, z0 - .02), (x1 + .015, top + .035, z1), .006),
        box((x0 + board, 0, z0 + .02), (x1 - board, .10 - board, z0 + .04)),
        box((x0, .05, z1), (x1, top, z1 + .006))), textured=True)

    rng = random.Random(23)
    rooms = {(0, 5): .34, (1, 4): .30, (0, 3): .26, (1, 2): 0, (1, 5): .42, (0, 1): 0, (1, 3): .16}  # for other things
    for column, (a, b) in enumerate(columns):
        for level, y in enumerate(levels):
            clear = (levels + [top])[level + 1] - board - y
            room = rooms.get((column, level), .06)
            x, volumes = a + .004, 0
            while True:
                if volumes == 0:  # single ones, or several of a series
                    volumes, kind = rng.choice((1, 1, 1, 1, 2, 3, 5)), rng.randrange(COVERS)
                    thick, tall, deep = rng.uniform(.016, .048), clear * rng.uniform(.66, .93), rng.uniform(.15, .23)
                if x + thick > b - room:
                    break
                s.instance(f'book{kind}', (x, y, z0 + rng.uniform(.018, .045)), scale=(thick, tall, deep))
                x += thick + rng.uniform(.0005, .002)
                volumes -= 1
            lean = rng.uniform(5, 9)
            thick, tall, away = rng.uniform(.018, .03), clear * rng.uniform(.66, .8), math.radians(lean)
            if x + thick * math.cos(away) + tall * math.sin(away) < b:  # the last one leans
                s.instance(f'book{rng.randrange(COVERS)}', (x + tall * math.sin(away), y, z0 + .03), roll=lean,
                           scale=(thick, tall, .18))
    right = x1 - board
    stack(s, (right - .26, levels[4], z0 + .05), [(.23, .035, .17, 4), (.21, .028, .16, 9), (.19, .022, .15, 1)], 0, rng)
    stack(s, (middle - .32, levels[5], z0 + .05), [(.24, .03, .18, 7), (.22, .04, .16, 0)], 0, rng)
    vessel(s, 'celadon', (middle - .14, levels[3], z0 + .13), [
        (.035, 0), (.05, .004), (.075, .06), (.07, .12), (.03, .17), (.026, .2), (.034, .215)], .16)
    vessel(s, 'stoneware', (right - .085, levels[3], z0 + .12), [
        (.03, 0), (.045, .004), (.06, .05), (.055, .10), (.05, .11)], .09)


def lamps(s):
    """A floor lamp, and a globe of glass on a cord; their bulbs are in room-night.pbrt."""
    with s.placed((.20, 0, 4.42)):
        s.shape('brass', lathe([(.06, 0), (.13, 0), (.14, .004), (.14, .016), (.13, .02), (.012, .024), (.010, .1),
                                (.010, .8), (.010, 1.56), (.009, 1.57), (.002, 1.575)]))
        s.shape('shade', lathe([(.235, 1.38), (.234, 1.385), (.21, 1.5), (.182, 1.65), (.180, 1.655)], 16, False))
        for y, radius in ((1.38, .235), (1.655, .180)):
            with s.placed((0, y, 0)):
                s.shape('brass', torus(radius, .004), 1)
    with s.placed((-.60, 0, 2.75)):
        s.shape('iron', tube([(0, y, 0) for y in (2.17, 2.2, 2.45, 2.72, 2.749)], [.004] * 5), 1)
        s.shape('brass', lathe([(.001, 2.749), (.05, 2.748), (.055, 2.735), (.03, 2.72), (.002, 2.715)]))
        s.shape('brass', lathe([(.030, 2.105), (.033, 2.11), (.034, 2.14), (.030, 2.17), (.012, 2.19), (.003, 2.2)]))
        globe = [(.03, .118), (.06, .106), (.095, .07), (.115, 0), (.095, -.07), (.06, -.102), (.02, -.118)]
        s.shape('glass', lathe([(r, 2 + y) for r, y in globe] + [(r * .965, 2 + y * .965) for r, y in globe[::-1]],
                               12, False), 3)


def leaf(length, width, droop, steps=5):
    """Returns a leaf along z that bends down, folded a little along its middle."""
    def point(u, v):
        t = 2 * u - 1
        w = width * math.sin(math.pi * min(1, .04 + .96 * v) ** .8) ** .7
        return t * w / 2, abs(t) * w * .16 - droop * v * v + .012 * math.sin(9 * v) * t * t, length * v
    return sheet(point, 4, steps)


def along(path, t):
    """Returns the point at t, in [0, 1], of a path."""
    k = min(int(t * (len(path) - 1)), len(path) - 2)
    return [a + (b - a) * (t * (len(path) - 1) - k) for a, b in zip(path[k], path[k + 1])]


def plants(s):
    """A rubber plant in the corner, ivy on the bookcase, eucalyptus in glass, a pot on the sill."""
    for name, material, cage, levels in (
            ('leaf', 'leaf', leaf(.27, .12, .07), 2), ('blade', 'leaf', leaf(.34, .05, -.02), 2),
            ('ivy', 'leaf', group((leaf(.07, .06, .02, 3), (.004, 0, 0), 55),
                                  (leaf(.06, .052, .025, 3), (-.004, -.02, 0), -65)), 1),
            ('twig', 'sage', group((leaf(.05, .042, .008, 3), (0, 0, 0), 0),
                                   (leaf(.046, .04, .004, 3), (0, .003, 0), 170)), 1)):
        with s.object(name):
            s.shape(material, cage, levels)
    rng = random.Random(4)

    x, z = -1.62, 4.42
    vessel(s, 'clay', (x, 0, z), [(.105, 0), (.125, .005), (.15, .15), (.168, .28), (.172, .30), (.185, .302),
                                  (.185, .34), (.18, .344)], .27, .014)
    with s.placed((x, .285, z)):
        s.shape('soil', lathe([(.05, 0), (.155, 0), (.162, -.01)], 12), 1)
    for k, (lean, turn, high) in enumerate(((.10, 20, 1.75), (.22, 150, 1.35), (.2, 265, 1.1))):
        a = math.radians(turn)
        path = [(x + (lean * t * t + .03) * math.cos(a) + .012 * math.sin(7 * t + k), .26 + (high - .26) * t,
                 z + (lean * t * t + .03) * math.sin(a)) for t in (i / 8 for i in range(9))]
        s.shape('bark', tube(path, [.012 - .001 * i for i in range(9)], 5), 1)
        count = int(high * 15)
        for i in range(count):
            t = .28 + .72 * (i + .5) / count
            at, size = along(path, t), rng.uniform(.75, 1.1) * (1.15 - .35 * t)
            around = i * 137.5 + turn + rng.uniform(-12, 12)
            a, reach = math.radians(around), .34 * size
            if at[0] + reach * math.sin(a) < LEFT + .16 or at[2] + reach * math.cos(a) > BACK - .02:
                around += 180  # neither curtain nor wall
            s.instance('leaf', at, around, rng.uniform(-12, 16) - 62 * max(0, t - .6), rng.uniform(-14, 14), [size] * 3)

    x, y, z = 1.05, 2.275, 4.80
    vessel(s, 'stoneware', (x, y, z), [(.05, 0), (.06, .003), (.075, .05), (.085, .11), (.087, .12)], .09, .006)
    for k in range(9):
        turn, drop = 180 + (k - 4) * 22 + rng.uniform(-8, 8), rng.uniform(.15, .62)
        a, n = math.radians(turn), 5 + int(8 * drop)
        path = []
        for t in (i / (n - 1) for i in range(n)):
            out = .21 * min(1, 1.7 * t) * (.7 + .3 * math.sin(k * 2.1))
            path.append((x + 1.5 * out * math.sin(a) + .012 * math.sin(9 * t + k),
                         y + .12 + .05 * math.sin(math.pi * min(1, 2 * t)) - 1.4 * drop * max(0, t - .33),
                         z + 1.1 * out * math.cos(a)))
        s.shape('bark', tube(path, [.0022] * n, 3), 1)
        for i, at in enumerate(path[1:]):
            s.instance('ivy', at, turn + (35 if i % 2 else -35) + rng.uniform(-25, 25), rng.uniform(15, 60),
                       rng.uniform(-20, 20), [rng.uniform(.7, 1.15)] * 3)

    x, y, z = .98, .362, 2.60
    vessel(s, 'glass', (x, y, z), [(.035, 0), (.045, .004), (.06, .05), (.062, .10), (.045, .16), (.036, .20),
                                   (.042, .225)], .012, .0035)
    for k in range(7):
        a, lean, high = 2 * math.pi * k / 7 + .3, rng.uniform(.10, .24), rng.uniform(.50, .54)
        bend = [(t, lean * max(0, t - .3) ** 1.4 - .018 * max(0, 1 - 3 * t)) for t in (i / 6 for i in range(7))]
        path = [(x + r * math.cos(a), y + .02 + high * t * (1.2 - lean), z + r * math.sin(a)) for t, r in bend]
        s.shape('bark', tube(path[::2], [.0025] * 4, 3), 1)
        for i in range(14):
            t = .42 + .58 * i / 14
            s.instance('twig', along(path, t), i * 97 + k * 40, rng.uniform(-35, 5), rng.uniform(-20, 20),
                       [rng.uniform(.7, 1.2) * (1.2 - .5 * t)] * 3)

    x, y, z = LEFT - .07, SILL, 3.72
    vessel(s, 'celadon', (x, y, z), [(.045, 0), (.055, .003), (.065, .06), (.07, .10), (.072, .108)], .085, .006)
    for k in range(11):
        s.instance('blade', (x + .02 * math.sin(k * 2.4), y + .08, z + .02 * math.cos(k * 2.4)), k * 137.5,
                   -78 + 4 * (k % 4), scale=[rng.uniform(.6, 1)] * 3)


def prints(s):
    """Three prints in frames."""
    for x, y, wide, high, mount in ((-1.06, 1.66, .66, .86, .085), (-.40, 1.90, .34, .40, .06), (-.40, 1.43, .34, .40, .06)):
        w, h, f = wide / 2, high / 2, .022
        with s.placed((x, y, BACK)):
            s.shape('walnut', joined(
                box((-w, -h, -.03), (-w + f, h, -.002)), box((w - f, -h, -.03), (w, h, -.002)),
                box((-w + f, -h, -.03), (w - f, -h + f, -.002)), box((-w + f, h - f, -.03), (w - f, h, -.002))), textured=True)
            s.shape('mount', box((-w + f, -h + f, -.012), (w - f, h - f, -.002), 0))
            a, b = w - f - mount, h - f - mount
            s.shape('print', ([(-a, -b, -.0125), (a, -b, -.0125), (a, b, -.0125), (-a, b, -.0125)],
                              [(0, 1, 2), (0, 2, 3)], [(0, 0), (1, 0), (1, 1), (0, 1)]), textured=True)


PARTS = walls, floor, curtains, rug, armchair, bookcase, tables, lamps, plants, prints


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    scene = PbrtScene('geometry.pbrt', 'Things in the room. Made by room.py.')
    for part in PARTS:
        scene.add(f'\n# {part.__doc__}')
        part(scene)
    scene.write(folder)
    write_images(folder)


if __name__ == '__main__':
    main()
