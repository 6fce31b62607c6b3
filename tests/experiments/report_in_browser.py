#!/usr/bin/env python3
"""Opens a report in headless Chromium, as a phone and as a desktop show it.

usage: report_in_browser.py FOLDER

FOLDER holds index.html. Checks that every picture loads, that the page does not scroll sideways at
360, 600 and 1280 px, that a figure says so where it is wider than its place, that the console stays
silent, that every local link leads somewhere, and that nothing is fetched from elsewhere. Exit code 77: there is no Chromium to ask.
"""

import html
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

SKIPPED = 77
WIDTHS = (360, 600, 1280)
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

# The page itself has no script: this one looks at it from outside, through a frame of the width of
# a phone or a desktop.
LOOKING_GLASS = """<!DOCTYPE html><html><body style="margin:0">
<iframe id="page" src="{page}" style="width:{width}px;height:2000px;border:0"></iframe>
<pre id="answer">waiting</pre>
<script>
document.getElementById("page").addEventListener("load", event => {{
  const page = event.target.contentDocument;
  const root = page.documentElement;
  const wide = [...page.querySelectorAll("body *")].filter(element => {{
    const box = element.getBoundingClientRect();
    return box.right > root.clientWidth + 1 && !element.closest(".scroll, .picture, pre");
  }});
  // A caption tells of scrolling where its figure scrolls, and nowhere else.
  const untold = [...page.querySelectorAll("figure")].filter(figure => {{
    const picture = figure.querySelector(".picture");
    const hint = event.target.contentWindow.getComputedStyle(
      figure.querySelector("figcaption"), "::before").content;
    return (picture.scrollWidth > picture.clientWidth) !== hint.includes("Scroll");
  }});
  document.getElementById("answer").textContent = JSON.stringify({{
    width: root.clientWidth, needed: root.scrollWidth, pictures: page.images.length,
    untold: untold.map(f => f.textContent.slice(0, 60)),
    broken: [...page.images].filter(i => !i.complete || i.naturalWidth === 0).map(i => i.src),
    wide: wide.slice(0, 5).map(e => e.tagName + "." + e.className + ": " +
                                    e.textContent.slice(0, 60))}});
}});
</script></body></html>
"""


def find_browser():
    wanted = os.environ.get("KAIROS_BROWSER")
    for name in ([wanted] if wanted else []) + list(BROWSERS):
        found = shutil.which(name)
        if found:
            return found
    return None


def look(browser, page, width):
    """What the browser says of the page at this width, and its console."""
    with tempfile.TemporaryDirectory(prefix="kairos-browser-") as scratch:
        glass = pathlib.Path(scratch) / "glass.html"
        glass.write_text(LOOKING_GLASS.format(page=page.as_uri(), width=width), encoding="utf-8")
        ran = subprocess.run(
            [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--no-first-run", "--disable-background-networking", "--allow-file-access-from-files",
             f"--user-data-dir={scratch}/profile", "--enable-logging=stderr",
             "--virtual-time-budget=60000", "--window-size=1400,2200", "--dump-dom",
             glass.as_uri()],
            capture_output=True, text=True, timeout=300, check=False)
    answer = re.search(r'<pre id="answer">(.*?)</pre>', ran.stdout, re.DOTALL)
    if answer is None or answer.group(1) == "waiting":
        sys.exit(f"{browser} did not answer:\n{ran.stdout[-500:]}\n{ran.stderr[-2000:]}")
    console = [line for line in ran.stderr.splitlines() if ":CONSOLE" in line]
    return json.loads(html.unescape(answer.group(1))), console


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.targets = []
        self.names = set()

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key == "id":
                self.names.add(value)
            elif key in ("href", "src"):
                self.targets.append(value)


def dead_links(page):
    """Links that lead nowhere, or away from the folder."""
    links = Links()
    links.feed(page.read_text(encoding="utf-8"))
    dead = []
    for target in links.targets:
        if target.startswith("#"):
            if target[1:] not in links.names and target != "#":
                dead.append(target)
        elif target.startswith("data:"):
            continue
        elif ":" in target.split("/")[0] or target.startswith("//"):
            dead.append(f"{target} (not in this folder)")
        elif not (page.parent / urllib.parse.unquote(target)).is_file():
            dead.append(target)
    return dead


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    page = pathlib.Path(arguments[0]).resolve() / "index.html"
    problems = [f"dead link: {link}" for link in dead_links(page)]
    browser = find_browser()
    if browser is None:
        if problems:
            sys.exit("\n".join(problems))
        print(f"skipped: none of {', '.join(BROWSERS)} is on the path; links lead somewhere")
        sys.exit(SKIPPED)
    for width in WIDTHS:
        seen, console = look(browser, page, width)
        problems += [f"{width} px: not loaded: {picture}" for picture in seen["broken"]]
        problems += [f"{width} px: console: {line}" for line in console]
        problems += [f"{width} px: its hint to scroll is wrong: {figure}" for figure in seen["untold"]]
        if seen["needed"] > seen["width"]:
            problems.append(f"{width} px: scrolls sideways, {seen['needed']} px wide: {seen['wide']}")
        print(f"{width} px: {seen['pictures']} pictures, {seen['needed']} px needed, "
              f"{len(console)} lines on the console")
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main(sys.argv[1:])
