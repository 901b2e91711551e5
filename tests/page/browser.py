#!/usr/bin/env python3
"""Opens a page in Chromium, and prints as JSON what the page's script has found (tools.js).

Use: browser.py PAGE WIDTH HEIGHT [OPTION OF CHROMIUM...]

The script sends commands of the DevTools protocol, to change colours, to take screenshots, and to read the
console of the page. Chromium has no GPU, and resolves no host name, so that nothing leaves the machine.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile

LIMIT_S = 500  # of a machine that does much else


class Browser:
    def __init__(self, profile, options):
        reads, self.commands = os.pipe()
        self.answers, writes = os.pipe()
        self.said = open(f"{profile}.said", "w+", errors="replace")
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec chromium "$@" 3<&{reads} 4>&{writes}', "chromium", "--remote-debugging-pipe",
             "--headless", "--no-sandbox", "--no-first-run", "--disable-sync", "--disable-background-networking",
             "--disable-component-update", "--disable-extensions", "--host-resolver-rules=MAP * ~NOTFOUND",
             f"--user-data-dir={profile}", "--allow-file-access-from-files", "--enable-unsafe-swiftshader", *options],
            pass_fds=(reads, writes), stdin=subprocess.DEVNULL, stdout=self.said, stderr=self.said)
        os.close(reads)
        os.close(writes)
        self.bytes, self.events, self.count = b"", [], 0

    def read(self):
        while b"\0" not in self.bytes:
            some = os.read(self.answers, 1 << 20)
            if not some:
                raise EOFError("the browser has ended")
            self.bytes += some
        text, self.bytes = self.bytes.split(b"\0", 1)
        return json.loads(text)

    def event(self):
        return self.events.pop(0) if self.events else self.read()

    def call(self, method, session=None, **params):
        self.count += 1
        command = {"id": self.count, "method": method, "params": params}
        if session:
            command["sessionId"] = session
        text = json.dumps(command).encode() + b"\0"
        while text:
            text = text[os.write(self.commands, text):]
        while (answer := self.read()).get("id") != self.count:
            self.events.append(answer)
        if "error" in answer:
            raise ValueError(f"{method}: {answer['error']}")
        return answer["result"]


def message(method, params):
    """A message of a page to its console, as one line; None: caused by the driver, which reads pixels."""
    if method == "Runtime.exceptionThrown":
        detail = params["exceptionDetails"]
        said, url = detail.get("exception", {}).get("description", detail["text"]), detail.get("url")
    elif method == "Log.entryAdded":
        said, url = params["entry"]["text"], params["entry"].get("url")
    else:
        frames = params.get("stackTrace", {}).get("callFrames", [])
        said = " ".join(str(part.get("value", part.get("description"))) for part in params["args"])
        url = frames[0]["url"] if frames else None
    return None if "GPU stall due to ReadPixels" in said else f"{url}: {said}".replace("\n", " ")


def follow(browser, page, width, height):
    """Serves the page until it sends what it has found."""
    target = browser.call("Target.createTarget", url="about:blank", newWindow=True, width=width, height=height)
    session = browser.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
    for domain in "Page", "Runtime", "Log":
        browser.call(f"{domain}.enable", session)
    browser.call("Runtime.addBinding", session, name="toBrowser")
    browser.call("Page.navigate", session, url=f"file://{os.path.realpath(page)}")
    messages = []
    while True:
        event = browser.event()
        method, params = event["method"], event["params"]
        if method == "Runtime.bindingCalled":
            asked = json.loads(params["payload"])
            if "found" in asked:
                return asked["found"]
            if asked["method"] == "messages":
                result, messages = list(filter(None, messages)), []
            else:
                result = browser.call(asked["method"], session, **asked["params"])
            browser.call("Runtime.evaluate", session, expression=f"answered({json.dumps(result)})")
        elif method in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"):
            messages.append(message(method, params))
        elif method == "Inspector.targetCrashed":
            raise EOFError("the page has crashed")


def late(*_):
    raise TimeoutError(f"the page has found nothing in {LIMIT_S} s")


signal.signal(signal.SIGALRM, late)
signal.alarm(LIMIT_S)
with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
    browser = Browser(f"{folder}/profile", sys.argv[4:])
    try:
        json.dump(follow(browser, sys.argv[1], int(sys.argv[2]), int(sys.argv[3])), sys.stdout)
    except (EOFError, TimeoutError) as error:
        browser.said.seek(0)
        sys.exit(f"{browser.said.read()}{error}")
    finally:
        browser.process.terminate()
        browser.process.wait()
