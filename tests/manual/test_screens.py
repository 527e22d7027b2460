"""On a phone and on a wide screen no equation of the manual is cut and no page is too wide.

A browser measures the pages that have equations, each in a frame of the width of a screen.
"""

import http.server
import json
import os
import subprocess
import threading
from functools import partial
from pathlib import Path
from shutil import which

import pytest

ROOT = Path(__file__).resolve().parents[2]
SITE = Path(os.environ.get("ROCKFRAME_SITE", ROOT / "docs" / "_build" / "html"))
BROWSER = which("chromium") or which("google-chrome")
PHONE, DESKTOP = 400, 1280
LARGEST_SHARE = 0.02
"""Largest share of displayed equations that scroll on a wide screen; measured 1 of 270."""
pytestmark = [
    pytest.mark.skipif(
        not (SITE / "index.html").is_file(), reason=f"the manual has not been built in {SITE}"
    ),
    pytest.mark.skipif(BROWSER is None, reason="neither chromium nor google-chrome is installed"),
]

MEASURING = """<!doctype html><body><script>
const pause = (time) => new Promise((done) => setTimeout(done, time));
async function measured(page, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `width: ${width}px; height: 900px; border: 0`;
  frame.src = page;
  document.body.appendChild(frame);
  await new Promise((done) => { frame.onload = done; });
  const inside = frame.contentWindow, root = frame.contentDocument.documentElement;
  for (let k = 0; k < 250 && root.dataset.equations !== "set"; k++) await pause(20);
  const seen = root.clientWidth, found = { page, width, equations: 0, scrolling: 0, cut: [] };
  for (const box of root.querySelectorAll("div.math > mjx-container")) {
    found.equations += 1;
    const wider = box.scrollWidth > box.clientWidth + 1;
    const scrolls = inside.getComputedStyle(box).overflowX === "auto";
    found.scrolling += wider;
    if ((wider && !scrolls) || box.getBoundingClientRect().right > seen + 1) {
      found.cut.push(box.textContent.slice(0, 60));
    }
  }
  found.beyond = Math.max(0, root.scrollWidth - seen);
  frame.remove();
  return found;
}
(async () => {
  const all = [];
  for (const width of WIDTHS) for (const page of PAGES) all.push(await measured(page, width));
  await fetch("/measured", { method: "POST", body: JSON.stringify(all) });
})();
</script></body>"""


class Site(http.server.SimpleHTTPRequestHandler):
    """Serves the manual, with a page that measures the others and posts the results."""

    page, found, done = "", None, None

    def do_GET(self):
        if self.path != "/measure.html":
            super().do_GET()
            return
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(type(self).page.encode())

    def do_POST(self):
        type(self).found = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.send_response(200)
        self.end_headers()
        type(self).done.set()

    def log_message(self, *words):
        pass


@pytest.fixture(scope="module")
def screens(tmp_path_factory):
    pages = [
        f"/{one.relative_to(SITE).as_posix()}"
        for one in sorted(SITE.rglob("*.html"))
        if 'class="math notranslate' in one.read_text(encoding="utf-8")
    ]
    Site.done = threading.Event()
    Site.page = MEASURING.replace("WIDTHS", f"[{PHONE}, {DESKTOP}]").replace(
        "PAGES", json.dumps(pages)
    )
    handler = partial(Site, directory=str(SITE))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        profile = tmp_path_factory.mktemp("profile")
        browser = subprocess.Popen(
            [BROWSER, "--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000",
             "--remote-debugging-port=0", f"--user-data-dir={profile}",
             f"http://127.0.0.1:{server.server_port}/measure.html"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            assert Site.done.wait(240), "the browser has not measured the pages in 240 s"
        finally:
            browser.terminate()
            browser.wait()
            server.shutdown()
    return Site.found


def test_equations_and_pages_fit_the_screen(screens):
    assert sum(one["equations"] for one in screens) > 400
    for one in screens:
        assert one["cut"] == [], (one["page"], one["width"])
        assert one["beyond"] == 0, (one["page"], one["width"])


def test_few_equations_scroll_on_wide_screen(screens):
    wide = [one for one in screens if one["width"] == DESKTOP]
    scrolling = sum(one["scrolling"] for one in wide)
    assert scrolling <= LARGEST_SHARE * sum(one["equations"] for one in wide)
