#!/usr/bin/python3
"""What an operator does with the page, done by Chromium on a live run. Called by browser_test.sh."""

import argparse
import json
import pathlib
import subprocess
import time
import urllib.error
import urllib.request

from page_driver import Page, check, wait_for


def post(url, body, headers):
    request = urllib.request.Request(url, json.dumps(body).encode(), {"Content-Type": "application/json", **headers})
    try:
        return urllib.request.urlopen(request, timeout=5).status
    except urllib.error.HTTPError as error:
        return error.code


def kill_service(run, name):
    subprocess.run(["s6-svc", "-k", str(run / "services" / name)], check=True)


def drive(page, second, url, run, pictures):
    wait_for("the rover drives", lambda: page.text("state") == "DRIVING")
    wait_for("the rover moves on the map", lambda: page.number("driven") > 2.0)
    check("a second page sees the same", second.text("state") == page.text("state") and second.number("driven") > 1.5)
    wait_for("both pages are counted", lambda: "2 pages" in page.text("link"))
    wait_for("the camera's picture and the limits are shown", lambda: "old" in page.text("camera-age") and
             "°" in page.script("return document.querySelector('#gauges').textContent"))

    check("no panel covers another at 1440x900", page.overlaps() == [] or print(page.overlaps()))
    page.picture(pictures / "page.png")
    second.resize(390, 844)
    time.sleep(1.0)
    check("nor at phone width", second.overlaps() == [] or print(second.overlaps()))
    second.picture(pictures / "page_phone.png")

    page.click("[data-level=efficient]")
    wait_for("a forced level is answered", lambda: "force level efficient: accepted" in page.text("answer"))
    wait_for("and shown", lambda: "forced" in page.text("level") and "forced" in second.text("level"))
    wait_for("with its place in the events", lambda: any("force level efficient accepted" in e for e in page.events()))
    page.click("[data-level=full]")
    wait_for("a level that is not to be had is refused with the reason",
             lambda: "refused" in page.text("answer") or "FULL" in page.text("level"))
    page.click("[data-level=auto]")
    wait_for("the level is the rover's own again", lambda: "forced" not in page.text("level"))

    page.click("tr[data-service=stereo] td.inject button")
    wait_for("a killed service is red", lambda: page.service("stereo") == "lost")
    wait_for("and green again", lambda: page.service("stereo") == "ok")
    wait_for("and it is noted", lambda: any("stereo restarted" in e for e in page.events()))

    driven = page.number("driven")
    kill_service(run, "mission_control")
    wait_for("the page outlives its own server", lambda: page.text("link").startswith("live") and
             page.number("driven") > driven + 0.5)
    check("which has kept the events", any("go accepted" in e for e in page.events()))
    check("and does not begin the drive anew", page.number("togo") < 86.0 - driven + 3.0)

    subprocess.run(["s6-svc", "-p", str(run / "services" / "mission_control")], check=True)
    wait_for("a server that hangs is not shown as live", lambda: page.text("link") == "no connection")
    subprocess.run(["s6-svc", "-c", str(run / "services" / "mission_control")], check=True)
    wait_for("and the page goes on when it does", lambda: page.text("link").startswith("live"))

    page.click(".stop")
    wait_for("stop stops", lambda: page.text("state") == "STANDBY" and page.text("permit") == "no permit")
    wait_for("and the rover is stationary", lambda: abs(page.number("speed")) < 0.01)
    wait_for("the second page sees it", lambda: second.text("state") == "STANDBY")
    stopped_at = page.number("driven")

    page.click("#draw")
    for x, y in [(.60, .50), (.68, .52), (.76, .50)]:
        page.click_map(x, y)
    wait_for("a drawn path is checked against the slope", lambda: "slope up to" in page.text("path-info"))
    page.picture(pictures / "page_drawing.png")
    wait_for("and may be sent", lambda: page.script("return !document.getElementById('send').disabled"))
    page.click("#send")
    wait_for("it is accepted", lambda: "path: accepted" in page.text("answer"))
    wait_for("and is the way to go now", lambda: page.number("togo") < 30.0)
    check("but does not move the rover by itself", page.text("state") == "STANDBY")
    page.click("#zone-out")
    for x, y in [(.62, .30), (.74, .30), (.68, .40)]:
        page.click_map(x, y)
    wait_for("a zone of three corners may be sent", lambda: page.script("return !document.getElementById('zone-send').disabled"))
    page.click("#zone-send")
    wait_for("it is accepted", lambda: "zones: accepted" in page.text("answer"))
    wait_for("and listed with its name", lambda: "keep out 1" in page.text("zones"))
    page.picture(pictures / "page_zone.png")
    wait_for("the second page has it", lambda: "keep out 1" in second.text("zones"))
    page.click("#zones button")
    wait_for("it can be deleted", lambda: page.text("zones") == "")
    page.click("[data-command=go]")
    wait_for("it is driven", lambda: page.number("driven") > stopped_at + 2.0)

    moving = page.number("driven")
    headers = {"Origin": "http://evil.example", "Sec-Fetch-Site": "cross-site"}
    check("another site's command is refused", post(f"{url}api/command", {"command": "stop"}, headers) == 403)
    wait_for("and changes nothing", lambda: page.number("driven") > moving + 0.3)

    page.click("#emergency")
    wait_for("the emergency stop leads to SAFE", lambda: page.text("state") == "SAFE")
    check("out of which GO is refused", page.click("[data-command=go]") or wait_for(
        "with the reason", lambda: "go: refused, not possible in SAFE" in page.text("answer")))
    page.click("#clear-safe")
    wait_for("until the ground has cleared it", lambda: page.text("state") == "STANDBY")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--run", type=pathlib.Path, required=True)
    parser.add_argument("--pictures", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    url = f"http://127.0.0.1:{arguments.port}/"
    pages = []
    try:
        pages = [Page(url, 1440, 900), Page(url, 1440, 900)]
        drive(*pages, url, arguments.run, arguments.pictures)
        loud = [c for c in pages[0].complaints() if "api/command" not in c and "ERR_" not in c]
        check("the browser has nothing to complain about", loud == [] or print(loud))
    finally:
        for page in pages:
            page.driver.quit()


main()
