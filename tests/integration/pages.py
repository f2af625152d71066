#!/usr/bin/env python3
"""Uses the pages that lull writes in a headless browser, as people would.

pages.py LULL CHROMIUM SCENES: exits with 0 if they do what they should, without errors and without asking the network for anything.
"""
import sys
import tempfile

import report_page
import study_page
from browser import Browser, check

if __name__ == "__main__":
    lull, chromium, scenes = sys.argv[1:]
    with tempfile.TemporaryDirectory() as profile:
        browser = Browser(chromium, profile)
        report_page.test(browser, lull)
        study_page.test(browser, lull, scenes)
        check(not browser.problems, "no errors, nothing from the network " + "; ".join(browser.problems))
        browser.close()
