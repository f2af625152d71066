"""Lays crops of images out as a sheet, each with lines of text above it. Needs Pillow (Debian: python3-pil)."""
from PIL import Image, ImageDraw, ImageFont

FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
PAPER, INK = (250, 249, 246), (40, 42, 46)
GAP, LINE, SCALE = 10, 17, 2  # in pixels; each pixel of a crop is drawn SCALE pixels wide


def crop(path):
    """Returns the pixels of an image file, enlarged."""
    image = Image.open(path).convert("RGB")
    return image.resize((image.width * SCALE, image.height * SCALE), Image.NEAREST)


def sheet(rows):
    """Returns rows of crops of one size, each given as (lines of text, image)."""
    font = ImageFont.truetype(FONT, 12)
    lines, first = rows[0][0]
    text = len(lines) * LINE + 6
    column, line = first.width + GAP, first.height + text + GAP
    picture = Image.new("RGB", (max(map(len, rows)) * column + GAP, len(rows) * line + GAP), PAPER)
    draw = ImageDraw.Draw(picture)
    for y, row in enumerate(rows):
        for x, (words, image) in enumerate(row):
            left, top = GAP + x * column, GAP + y * line
            for k, words_of_line in enumerate(words):
                draw.text((left, top + 2 + k * LINE), words_of_line, fill=INK, font=font)
            picture.paste(image, (left, top + text))
    return picture
