/* Common to the drivers, which open pages in turn in an iframe, operate them as a reader does, and
 * send their findings to browser.py. The page is a document of its own, with its own policy. */
"use strict";

const frame = document.getElementById("page");
const found = {};
let page, view;

function drawn() {
    return new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
}

async function load(name) {
    await new Promise((done) => {
        frame.onload = done;
        frame.src = name;
    });
    page = frame.contentDocument;
    view = frame.contentWindow;
    await drawn();
}

/* Loads a page, and waits until it has unpacked its data and shows them. */
async function open(name) {
    await load(name);
    for (const from = performance.now(); !view.fmb && performance.now() - from < 60000;)
        await drawn();
    await drawn();
}

function one(selector) {
    const element = page.querySelector(selector);
    if (!element)
        throw new Error(`there is no ${selector}`);
    return element;
}

function all(selector) {
    return [...page.querySelectorAll(selector)];
}

function text(selector) {
    return one(selector).textContent;
}

function texts(selector) {
    return all(selector).map((element) => element.textContent);
}

/* Presses, moves by `move` pixels where given, and releases; x and y: fractions of the element's
 * size. */
async function mouse(element, x = 0.5, y = 0.5, move = null) {
    const box = element.getBoundingClientRect();
    const at = { x: box.left + box.width * x, y: box.top + box.height * y };
    const send = (type, Kind) => element.dispatchEvent(new Kind(type,
        { bubbles: true, cancelable: true, clientX: at.x, clientY: at.y, button: 0, buttons: 1 }));
    send("pointerdown", view.PointerEvent);
    if (move) {
        at.x += move[0];
        at.y += move[1];
        send("pointermove", view.PointerEvent);
    }
    send("pointerup", view.PointerEvent);
    send("click", view.MouseEvent);
    await drawn();
}

/* Presses a key. The document changes at once, the picture with the next frame. */
function key(key, shiftKey = false) {
    page.body.dispatchEvent(new view.KeyboardEvent("keydown",
        { key, shiftKey, bubbles: true, cancelable: true }));
}

async function press(...keys) {
    key(...keys);
    await drawn();
}

async function type(selector, value, event = "input") {
    one(selector).value = value;
    one(selector).dispatchEvent(new view.Event(event, { bubbles: true }));
    await drawn();
}

/* ---- The browser, by browser.py ---- */

let answered;

/* A command of the DevTools protocol, to this page; "messages": those of its console since the last time. */
function command(method, params = {}) {
    return new Promise((done) => {
        answered = done;
        toBrowser(JSON.stringify({ method, params }));
    });
}

/* Opens pages in light or dark colours from now on. */
const setColours = (value) => command("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value }] });

/* Calls work() while each page that is opened begins with a script. */
async function beginningWith(source, work) {
    const { identifier } = await command("Page.addScriptToEvaluateOnNewDocument", { source });
    await work();
    await command("Page.removeScriptToEvaluateOnNewDocument", { identifier });
}

/* Executes all parts, and sends their findings. */
async function drive(parts) {
    Object.assign(found, { errors: [], console: {} });
    for (const part of parts) {
        await part().catch((error) => found.errors.push(`${part.name}: ${error.stack ?? error}`));
        found.console[part.name] = await command("messages");
    }
    toBrowser(JSON.stringify({ found }));
}
