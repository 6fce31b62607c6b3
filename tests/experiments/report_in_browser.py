#!/usr/bin/env python3
"""Opens a report in headless Chromium, as a phone and as a desktop show it.

usage: report_in_browser.py FOLDER

FOLDER holds the pages. Checks of each that every picture loads, that the page does not scroll sideways at 360, 600
and 1280 px, folded or unfolded, that it is shorter than 20 screens, that the console stays silent, that
every local link leads somewhere, and that nothing is fetched from elsewhere. Exit code 77: there is no Chromium to ask.
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
<iframe id="page" style="width:{width}px;height:800px;border:0"></iframe>
<pre id="answer">waiting</pre>
<script>
const frame = document.getElementById("page");
const shown = address => new Promise(done => {{
  frame.addEventListener("load", done, {{ once: true }});
  frame.src = address;
}});
async function look(address) {{
  await shown(address);
  const page = frame.contentDocument;
  const root = page.documentElement;
  for (const image of page.images) image.loading = "eager";
  await Promise.all([...page.images].map(image => image.decode().catch(() => 0)));
  const screens = root.scrollHeight / 800;
  for (const folded of page.querySelectorAll("details:not(.live)")) folded.open = true;
  const wide = [...page.querySelectorAll("body *")].filter(element => {{
    const box = element.getBoundingClientRect();
    return box.right > root.clientWidth + 1 && !element.closest(".scroll, .picture, pre, thead");
  }});
  return {{
    page: address.split("/").pop(), screens, width: root.clientWidth, needed: root.scrollWidth, pictures: page.images.length,
    broken: [...page.images].filter(i => !i.complete || i.naturalWidth === 0).map(i => i.src),
    wide: wide.slice(0, 5).map(e => e.tagName + "." + e.className + ": " + e.textContent.slice(0, 60))}};
}}
(async () => {{
  const answers = [];
  for (const address of {pages}) answers.push(await look(address));
  document.getElementById("answer").textContent = JSON.stringify(answers);
}})();
</script></body></html>
"""
MOST_SCREENS = 20


def find_browser():
    wanted = os.environ.get("KAIROS_BROWSER")
    for name in ([wanted] if wanted else []) + list(BROWSERS):
        found = shutil.which(name)
        if found:
            return found
    return None


def look(browser, pages, width):
    """What the browser says of the pages at this width, and its console."""
    with tempfile.TemporaryDirectory(prefix="kairos-browser-") as scratch:
        glass = pathlib.Path(scratch) / "glass.html"
        glass.write_text(LOOKING_GLASS.format(
            pages=json.dumps([page.as_uri() for page in pages]), width=width), encoding="utf-8")
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


def dead_links(pages):
    """Links that lead nowhere, or away from the folder."""
    read = {}
    for page in pages:
        read[page.name] = Links()
        read[page.name].feed(page.read_text(encoding="utf-8"))
    dead = []
    for page in pages:
        for target in read[page.name].targets:
            path, _, place = target.partition("#")
            if target.startswith("data:"):
                continue
            if ":" in target.split("/")[0] or target.startswith("//"):
                dead.append(f"{page.name}: {target} (not in this folder)")
            elif path and not (page.parent / urllib.parse.unquote(path)).is_file():
                dead.append(f"{page.name}: {target}")
            elif place and (path or page.name) in read and place not in read[path or page.name].names:
                dead.append(f"{page.name}: {target}")
    return dead


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    pages = sorted(pathlib.Path(arguments[0]).resolve().glob("*.html"))
    if not pages:
        sys.exit(f"{arguments[0]} holds no page")
    problems = [f"dead link: {link}" for link in dead_links(pages)]
    browser = find_browser()
    if browser is None:
        if problems:
            sys.exit("\n".join(problems))
        print(f"skipped: none of {', '.join(BROWSERS)} is on the path; links lead somewhere")
        sys.exit(SKIPPED)
    for width in WIDTHS:
        answers, console = look(browser, pages, width)
        problems += [f"{width} px: console: {line}" for line in console]
        for seen in answers:
            name = f"{width} px: {seen['page']}"
            problems += [f"{name}: not loaded: {picture}" for picture in seen["broken"]]
            if seen["needed"] > seen["width"]:
                problems.append(f"{name}: scrolls sideways, {seen['needed']} px wide: {seen['wide']}")
            if seen["screens"] > MOST_SCREENS:
                problems.append(f"{name}: {seen['screens']:.1f} screens")
        longest = max(answers, key=lambda seen: seen["screens"])
        print(f"{width} px: {len(answers)} pages, {sum(seen['pictures'] for seen in answers)} pictures, the longest "
              f"{longest['page']} with {longest['screens']:.1f} screens, {len(console)} lines on the console")
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main(sys.argv[1:])
