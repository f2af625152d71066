"""Runs the program lull: python -m lull render scene.pbrt."""
import subprocess
import sys

from . import program


def main():
    try:
        found = program.find()
    except FileNotFoundError as error:
        sys.exit("lull: error: %s" % error)
    with subprocess.Popen([found, *sys.argv[1:]]) as process:
        while True:
            try:
                sys.exit(process.wait())
            except KeyboardInterrupt:  # which the program has had, too
                pass


if __name__ == "__main__":
    main()
