"""Stores the CPU times of renders."""

import json
import os
import subprocess
import sys


class Seconds(dict):
    """Holds the processor seconds of renders by name, as the JSON file `path` does."""

    def __init__(self, path):
        super().__init__(json.load(open(path)) if os.path.exists(path) else {})
        self.path = path

    def note(self, name, seconds):
        self[name] = seconds
        with open(self.path, 'w') as f:
            json.dump(self, f, indent=1)

    def run(self, name, command):
        """Runs `command`, which makes the image `name`, unless that has been done."""
        if name in self:
            return
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(run.pid, 0)
        if status != 0:
            sys.exit('failed: ' + ' '.join(command))
        self.note(name, used.ru_utime + used.ru_stime)
