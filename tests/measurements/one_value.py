"""Checks that a quantity has one value on all pages and charts, and that of the table of scenes where it comes from one.

    python3 one_value.py

QUANTITIES has a line for each that several pages state: its page, or a table with the function that computes it, and the
words around its value, `#`, as regular expressions. Wherever these match, on any page, the value must be the same, rounded
at most. Words that no page has fail, too, as does a line whose page does not state it, or that no second place states.
"""

import csv
import decimal
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORDS = {word: number for number, word in enumerate(
    'zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen'.split())}
WORDS['twenty-six'] = 26

README = 'README.md'
MODELS, RENDERER = (f'tests/measurements/{name}.md' for name in ('models', 'renderer'))
RULES, PAPER, TRAINING = (f'stopping/docs/{name}.md' for name in ('entropy', 'paper', 'training'))
REFERENCE, RENDERING, BLENDER = (f'renderer/docs/{name}.md' for name in ('reference', 'rendering', 'blender'))
SPEED = 'tests/measurements/pbrt_speed.csv', 'samples_per_second'
ESTIMATE = 'tests/measurements/denoising_estimate.csv', 'cpu_seconds'
BLOCKS_OF_STILL = decimal.Decimal(1920 * 1080) / 128**2


def mean(values):
    values = list(values)
    return sum(values) / len(values)


QUANTITIES = [
    ('blocks of the default', MODELS, '# blocks of ten viewpoints of seven scenes, 800x800', '# blocks of ten viewpoints; other',
     'trained on # of the 160', 'trained on all # blocks', r'\| # of ten viewpoints', '# blocks, not held out', 'of # blocks seen',
     'Thirteen of the # are by night'),
    ('viewpoints', MODELS, '89 blocks of # viewpoints', '160 blocks of # viewpoints', r'\| 89 of # viewpoints'),
    ('scenes of the viewpoints', MODELS, 'ten viewpoints of # scenes', 'Evidence from # scenes'),
    ('blocks of the viewpoints', TRAINING, 'of the # blocks are missing', '89 of the # blocks'),
    ('blocks by night', MODELS, 'of the # night blocks', '# of the 89 are by night'),
    ('blocks recorded first', MODELS, 'on the # of first-blocks.csv', 'these # again', 'the # blocks. nearness', 'lists the # that'),
    ('blocks recorded later', MODELS, '# blocks were recorded after', 'before the other # '),
    ('early stops', RULES, 'below # % of the human threshold'),
    ('late stops', RULES, 'late ones above # %'),
    ('earliest stop, spp', RULES, 'is at 100 spp, so that no block stops before # spp', 'default rule no block stops before # spp',
     'default takes at least #', 'at the earliest, # spp', r'earliest stop, spp \| 380 \| 380 \| #'),
    ("the paper's earliest stop, spp", PAPER, 'every 40 spp, so that no block stops before # spp', r'earliest stop, spp \| # '),
    ("first check of the default, spp", RULES, 'with both inputs is at # spp', 'each block, from # spp'),
    ('early stops where options are left out', ('tests/measurements/nested.csv', 'early_percent', mean),
     'without the scene. The critical error is 9.0 %, with # % early', r'without the scene, too \| 9\.0 \| #;'),
    ('early stops with the shipped options', MODELS, 'in the same run, with # % early', r'each scene left out .{1,60}%: [0-9.-]+\) \| #;'),
    ('limit of peak noise, L*', RULES, 'limit is # for the model', r'none \| none \| # L', r'shipped options, 0\.25 and #,'),
    ('exponent of nearness', RULES, 'and x = #, which', 'shipped options, # and'),
    ('visible noise over deviation', RULES, 'that is # to 2, times', 'in SVD-entropy, # to 2 times'),
    ('units of the default', RULES, 'layers of 8 and # units', r'\| 8, #; 533'),
    ('epochs', TRAINING, r'epochs \| #, samples', '# epochs, no dropout'),
    ('rate of RMSprop', TRAINING, 'RMSprop with a rate of #, ρ', 'viewpoints balanced; batches of 64, RMSprop, rate #'),
    ('published error', PAPER, r'svd-entropy-rnn 40 640 0 0 # ', 'blocks of the published # %'),
    ('part of the estimated error', RENDERER, '; # on 16 at stops', 'without # of such an error'),
    ('threshold of denoised', RULES, r'the true one is below T \(#\)', 'the true image is below #', 'below T, by default #',
     'without the worst, #, was the best', 'of --denoise, #', 'seed 1, threshold #', r'estimate.max\(\) > #'),
    ('cap, spp', REFERENCE, r'Stop every block at N spp at the latest # \(', r'--max-spp, # spp by default', r'block, # by default \(--max-spp'),
    ('pass, spp', REFERENCE, r'Decide every N spp \(1 to 1048576\) #', 'Each pass adds # spp'),
    ('side of a block, pixels', REFERENCE, r'Set the side of the blocks, in pixels \(1 to 65536\) #', 'each block of #x200 pixels stops',
     'Observers judged blocks of #x200'),
    ('peak luminance', REFERENCE, 'in lux #cd,40ppd,250lux', '--viewing #cd,40ppd,250lux'),
    ('bytes of a pixel, denoised', RENDERING, 'checkpoints need; # with', 'of which the film has #'),
    ('bytes of a pixel', RENDERING, 'A pixel of the film takes # bytes', 'of which the film takes # or 48'),
    ('bytes of a pixel with a half buffer', RENDERING, 'film takes 24 bytes; # with', 'of which the film takes 24 or #'),
    ('shortest time by --denoise, s', (*ESTIMATE, min), 'after # to [0-9.]+ s of CPU time'),
    ('longest of all, s', (*ESTIMATE, max), 'after 47.8 to # s in seven'),
    ('shortest time of a still by --denoise, min', (*ESTIMATE, lambda s: BLOCKS_OF_STILL * min(s) / 60), '# to 19 min'),
    ('longest time of a still by --denoise, h', (*ESTIMATE, lambda s: BLOCKS_OF_STILL * max(s) / 3600), r'\| 1\.7 to # h'),
    ('scenes compared with pbrt-v3', RENDERER, "with pbrt-v3's, # scenes", 'on # whole scenes'),
    ('slowest scene, samples/s', (*SPEED, min), 'a core takes # to'),
    ('fastest scene, samples/s', (*SPEED, max), 'a core takes [0-9,]+ to # samples'),
    ('stop of a block of staircase2, spp', RULES, 'denoised, at # and at 2,886', 'trained without this scene, stops at # spp', '>stop: #<', 'below half at # spp'),
    ('human threshold of a block of staircase2, spp', RULES, 'at 2,380 and at # samples', 'observers asked for #.', '>observers: #<'),
    ('version of Blender', BLENDER, 'Tested with Blender 3.4.# ', r'Debian 12 \(Blender 3.4.#\)', 'Blender 3.4.#, two threads'),
]


def plain(text):
    """Returns the words of a page, without markup."""
    text = re.sub(r'<!--.*?-->', '', text, flags=re.S)
    text = re.sub(r'\]\([^()\s]*\)', ']', text)
    return ' '.join(re.sub(r'[\[\]`*\\]', '', text).split())


def pattern(words):
    return re.compile(words.replace('#', r'(\d+(?:,\d{3})*(?:\.\d+)?|[A-Za-z]+(?:-[a-z]+)?)'))


def number(text):
    """Returns the number that digits or a word state, or None."""
    if text.lower() in WORDS:
        return decimal.Decimal(WORDS[text.lower()])
    try:
        return decimal.Decimal(text.replace(',', ''))
    except decimal.InvalidOperation:
        return None


def agree(a, b):
    """Returns whether two numbers are the same, after rounding to the decimals of the shorter."""
    step = decimal.Decimal(1).scaleb(max(a.as_tuple().exponent, b.as_tuple().exponent))
    return a.quantize(step, decimal.ROUND_HALF_UP) == b.quantize(step, decimal.ROUND_HALF_UP)


def computed(file, column, function):
    with open(ROOT / file, encoding='utf-8') as table:
        return function(decimal.Decimal(row[column]) for row in csv.DictReader(table) if row[column])


def main():
    files = [*ROOT.rglob('*.md'), *(ROOT / 'scenes' / 'pictures').glob('*.svg')]
    pages = {str(path.relative_to(ROOT)): plain(path.read_text(encoding='utf-8')) for path in sorted(files)
             if not any(part == 'build' or part.startswith('.') for part in path.relative_to(ROOT).parts)}
    wrong, count = [], 0
    for name, home, *texts in QUANTITIES:
        found = []
        for words in texts:
            matches = [(page, match[1], number(match[1])) for page, text in pages.items()
                       for match in pattern(words).finditer(text) if number(match[1]) is not None]
            if not matches:
                wrong.append(f'{name}: no page has "{words}"')
            found += matches
        if isinstance(home, tuple):
            found.insert(0, (home[0], '', computed(*home)))
            home = home[0]
        here = [value for page, _, value in found if page == home]
        if not here or len(found) < 2:
            wrong.append(f'{name}: {home} does not state it, or no other place does')
            continue
        for page, text, value in found:
            count += 1
            if not agree(value, here[0]):
                wrong.append(f'{name}: {text} in {page}, {here[0]} in {home}')
    print('\n'.join(wrong) if wrong else f'{len(QUANTITIES)} quantities have one value in {count} places')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
