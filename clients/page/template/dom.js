/* Creates elements. Data are inserted as text, never as HTML. */

const SVG = "http://www.w3.org/2000/svg";

function find(id) {
    return document.getElementById(id);
}

function fill(element, properties, children) {
    for (const [name, value] of Object.entries(properties)) {
        if (name.startsWith("on"))
            element.addEventListener(name.slice(2), value);
        else if (value !== null && value !== undefined && value !== false)
            element.setAttribute(name, value === true ? "" : value);
    }
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
}

/* make("p", {class: "dim", onclick: function}, "text", element, ...) */
function make(name, properties = {}, ...children) {
    return fill(document.createElement(name), properties, children);
}

function draw(name, properties = {}, ...children) {
    return fill(document.createElementNS(SVG, name), properties, children);
}

function show(element, ...children) {
    element.replaceChildren(...children.filter((child) => child !== null && child !== undefined));
}

/* ---- Elements of both pages ---- */

function makeCount(kind, count, one, many = one) {
    return make("div", { class: `count ${kind}${count === 0 ? " zero" : ""}` },
        make("b", {}, grouped(count)), make("span", {}, count === 1 ? one : many));
}

function warning(...children) {
    return make("p", { class: "warn" }, ...children);
}

/* An entry of a legend. */
function swatch(kind, text) {
    return make("span", { class: "key" }, make("i", { class: `swatch ${kind}` }), text);
}

/* An entry of a <dl>. */
function fact(name, ...value) {
    return [make("dt", {}, name), make("dd", {}, ...value)];
}

/* A coloured mark with the verdict's name. */
function verdictChip(verdict) {
    const kind = verdict < SEPARATED ? "none" : VERDICTS[verdict];
    return make("span", { class: `verdict ${kind}` }, verdictName(verdict));
}

/* "then -> now" as chips; a single chip if they are equal. */
function verdictChips(then, now) {
    if (then === now)
        return [verdictChip(now)];
    return [verdictChip(then), make("span", { class: "arrow", "aria-label": "then, now" }, "→"),
        verdictChip(now)];
}

/* ---- Events ---- */

/* The position of the pointer in an element. */
function pointIn(id, mouse) {
    const box = find(id).getBoundingClientRect();
    return { x: mouse.clientX - box.left, y: mouse.clientY - box.top };
}

/* Calls begin(event) when a drag begins, and the function that it returns for each move until the
 * drag ends, even outside the element. begin() may return nothing. */
function listenToDrags(element, begin) {
    element.addEventListener("pointerdown", (first) => {
        const go = begin(first);
        if (!go)
            return;
        const end = () => {
            removeEventListener("pointermove", go);
            removeEventListener("pointerup", end);
            removeEventListener("pointercancel", end);
        };
        addEventListener("pointermove", go);
        addEventListener("pointerup", end);
        addEventListener("pointercancel", end);
    });
}

const WHEEL_ZOOM = 0.0015; /* a notch of 100 pixels: some 15 % */

/* Greater than 1 if the wheel turns towards the reader. */
function wheelFactor(wheel) {
    return Math.exp(clamp(wheel.deltaY, -400, 400) * WHEEL_ZOOM);
}

/* Limits work to one call before the next animation frame, however often it is requested. */
function onceAFrame(work) {
    let waiting = false;
    return () => {
        if (waiting)
            return;
        waiting = true;
        requestAnimationFrame(() => {
            waiting = false;
            work();
        });
    };
}
