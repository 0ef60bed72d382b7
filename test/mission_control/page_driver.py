"""A page in Chromium, and what a test asks of it."""

import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

PATIENCE_S = 600.0  # of wall time: a run on a loaded machine may be slower than real time


def wait_for(what, condition, patience_s=PATIENCE_S):
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        value = condition()
        if value:
            print(f"ok: {what}", flush=True)
            return value
        time.sleep(0.1)
    sys.exit(f"FAIL: {what}: not within {patience_s:.0f} s")


def check(what, holds):
    if not holds:
        sys.exit(f"FAIL: {what}")
    print(f"ok: {what}", flush=True)


class Page:
    def __init__(self, url, width, height):
        options = Options()
        for argument in ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage"]:
            options.add_argument(argument)
        # Nothing but this machine is there: a page that needs more would show it.
        options.add_argument("--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.resize(width, height)
        self.driver.get(url)

    def resize(self, width, height):
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def text(self, element_id):
        return self.script("return document.getElementById(arguments[0]).textContent", element_id)

    def click(self, selector):
        self.driver.find_element(By.CSS_SELECTOR, selector).click()

    def number(self, element_id):
        try:
            return float(self.text(element_id).split()[0])
        except (ValueError, IndexError):
            return float("nan")

    def service(self, name):
        return self.script("const r = document.querySelector(`tr[data-service=${arguments[0]}]`); return r && r.className",
                           name)

    def events(self):
        return self.script("return [...document.querySelectorAll('#events li span')].map((e) => e.textContent)")

    def click_map(self, x, y):
        """At these shares of the map's width and height."""
        self.script("""
            const map = document.getElementById("map"), box = map.getBoundingClientRect();
            const at = { clientX: box.left + arguments[0] * box.width, clientY: box.top + arguments[1] * box.height,
                         bubbles: true, view: window };
            for (const type of ["mousedown", "mouseup", "click"]) map.dispatchEvent(new MouseEvent(type, at));
        """, x, y)

    def picture(self, path):
        time.sleep(1.0)
        self.driver.save_screenshot(str(path))

    def overlaps(self):
        """Panels that cover each other or reach beyond the page, and texts cut off."""
        return self.script("""
            const found = [], panels = [...document.querySelectorAll(".panel, header")].filter((p) => p.offsetParent !== null);
            const boxes = panels.map((p) => p.getBoundingClientRect());
            boxes.forEach((a, i) => {
              const name = panels[i].className || "header";
              if (a.left < -1 || a.right > innerWidth + 1) found.push(`${name} beyond the page`);
              if (a.width < 60 || a.height < 30) found.push(`${name} too small`);
              boxes.forEach((b, k) => {
                if (k > i && a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1)
                  found.push(`${name} over ${panels[k].className || "header"}`);
              });
            });
            for (const e of document.querySelectorAll("button, .chip, dd, dt, h2, .gauge .name, .gauge .value"))
              if (e.offsetParent !== null && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0)
                found.push(`cut off: ${e.textContent}`);
            return found;
        """)

    def complaints(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
