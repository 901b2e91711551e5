/* Opens pages of meshes in turn, and operates them as a reader does (tools.js). */
"use strict";

/* ---- What the page shows ---- */

/* Waits until the picture is drawn finely: while it moves it is coarse. */
async function rested() {
    await new Promise((done) => setTimeout(done, 400));
    await drawn();
}

/* Counts of pixels: all that are covered; those close to the colour of overlapping faces, touching
 * faces and mesh B; the mean column of grey ones; and a checksum. */
function picture() {
    const data = pixels(), { width } = one("#stage");
    const count = { drawn: 0, red: 0, yellow: 0, blue: 0, grey: 0, sum: 0 };
    let grey = 0;
    for (let i = 0; i < data.length; i += 4) {
        const [red, green, blue, cover] = data.subarray(i, i + 4);
        if (cover < 60)
            continue;
        count.drawn++;
        count.red += red > green + 90 && red > blue + 90 ? 1 : 0;
        count.yellow += red > 150 && green > 120 && blue < 100 ? 1 : 0;
        count.blue += blue > red + 25 ? 1 : 0;
        const isGrey = Math.max(red, green, blue) - Math.min(red, green, blue) < 20;
        grey += isGrey ? 1 : 0;
        count.grey += isGrey ? (i / 4) % width : 0;
        count.sum = (count.sum * 31 + red + 2 * green + 3 * blue + i) % 1000000007;
    }
    count.grey /= grey;
    return count;
}

function said() {
    return {
        title: text("#title"), counts: texts(".count b"), facts: text("#facts"),
        notes: texts("#notes p"), list: text("#list-said"),
        rows: all("#list tr").length, first: all("#list tr:first-child td").map((td) => td.textContent),
    };
}

function chosen() {
    return {
        row: texts("#list tr.chosen .pair"), said: text("#announce"),
        moment: one("#window").hidden ? null : text("#moment-said"),
    };
}

async function click(selector) {
    await mouse(one(selector));
    await rested();
}

/* ---- Actions ---- */

async function small() {
    await open("small.html");
    await rested();
    found.opened = {
        ...said(), ...picture(), scripts: page.scripts.length,
        resources: view.performance.getEntriesByType("resource").length,
    };
    await click('#list tr[data-pair="2"] .pair');
    found.clicked = { ...chosen(), ...picture() };
    await press("n");
    found.next = chosen();
    await press("Escape");
    found.none = chosen();
    await press("0");
    await rested();
    found.back = picture();
}

/* A chosen pair is in the middle of the canvas. */
async function pointed() {
    await click('#list tr[data-pair="2"] .pair');
    const box = one("#stage").getBoundingClientRect(), names = new Set();
    for (let k = 0; k < 400; k++) {
        one("#stage").dispatchEvent(new view.PointerEvent("pointermove", {
            bubbles: true, clientX: box.left + box.width * (0.35 + 0.3 * (k % 20) / 20),
            clientY: box.top + box.height * (0.35 + 0.3 * Math.floor(k / 20) / 20),
        }));
        if (!one("#pointed").hidden)
            names.add(text("#pointed"));
    }
    found.pointed = [...names];
    await press("0");
}

async function turned() {
    await mouse(one("#stage"), 0.5, 0.5, [120, 40]);
    await rested();
    found.turned = picture();
    await wheel(one("#stage"), -300);
    await rested();
    found.zoomed = picture();
    await press("ArrowLeft");
    await rested();
    found.keys = picture();
    await click("#up-y");
    found.up = picture();
}

async function filter() {
    const names = () => texts("#list .pair");
    await type("#filter", "3");
    found.filtered = { names: names(), said: text("#list-said") };
    await type("#filter", "");
    await type("#verdict", "2", "change");
    found.touching = names().length;
    await type("#verdict", "0", "change");
    found.all = names().length;
}

async function touching() {
    await open("touching.html");
    await rested();
    found.touch = { ...said(), ...picture() };
}

/* In turn: before contact, in contact, at the time of the pair. */
async function moving() {
    await open("moving.html");
    await rested();
    found.moving = { ...said(), ...chosen(), bands: all("#bands .band").length };
    await type("#moment", "0");
    await rested();
    found.before = { ...chosen(), ...picture() };
    await type("#moment", "1000");
    await rested();
    found.after = { ...chosen(), ...picture() };
    await click("#list tr:first-child .pair");
    found.movingPair = { ...chosen(), times: text("#list tr:first-child td:last-child") };
    await mouse(one("#play"));
    found.playing = text("#play");
    await mouse(one("#play"));
}

async function others() {
    await open("self.html");
    await rested();
    found.self = { ...said(), ...picture() };
    await open("empty.html");
    await rested();
    found.empty = said();
    await open("large.html");
    await rested();
    found.large = { ...said(), ...picture(), more: text("#more") };
    await mouse(one("#more"));
    found.large.then = all("#list tr").length;
    for (const size of ["huge", "tiny"]) {
        await open(`${size}.html`);
        await rested();
        found[size] = { ...said(), ...picture() };
    }
}

drive([small, pointed, turned, filter, touching, moving, others]);
