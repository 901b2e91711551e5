/* Opens pages of replays in turn, and operates them as a reader does (tools.js). */
"use strict";

/* ---- What the page shows ---- */

/* The texts shown while the pointer crosses the scene. */
async function point() {
    const box = one("#stage").getBoundingClientRect(), said = new Set();
    for (let k = 0; k < 1600; k++) {
        one("#stage").dispatchEvent(new view.PointerEvent("pointermove", {
            bubbles: true, clientX: box.left + box.width * (k % 40) / 40,
            clientY: box.top + box.height * Math.floor(k / 40) / 40,
        }));
        if (!one("#pointed").hidden)
            said.add(text("#pointed"));
    }
    await drawn();
    return [...said].sort();
}

/* Counts of pixels: all that are drawn, and those close to a colour; and a checksum. */
function picture() {
    const data = pixels(), count = { drawn: 0, sum: 0, violet: 0, red: 0, pink: 0, blue: 0 };
    const isNear = (i, red, green, blue) => data[i + 3] > 60 && Math.abs(data[i] - red) < 60
        && Math.abs(data[i + 1] - green) < 60 && Math.abs(data[i + 2] - blue) < 60;
    for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] === 0)
            continue;
        count.drawn++;
        count.sum = (count.sum * 31 + data[i] + 2 * data[i + 1] + 3 * data[i + 2] + i) % 1000000007;
        count.violet += isNear(i, 106, 22, 196) ? 1 : 0;
        count.red += isNear(i, 228, 120, 112) ? 1 : 0;
        count.pink += isNear(i, 196, 0, 111) ? 1 : 0;
        count.blue += isNear(i, 11, 87, 208) ? 1 : 0;
    }
    return count;
}

/* The texts about the chosen query. */
function chosen() {
    return {
        query: text("#event-head h2"), outcome: text("#event-head .outcome"),
        pair: texts("#event-pairs .pair"),
        verdict: texts("#event-pairs tbody tr:first-child .verdict"),
        scene: text("#scene-title"), hash: view.location.hash,
    };
}

/* Counts texts that stand for a missing or invalid value. */
function badNumbers() {
    const shown = all("header, #notes, #top, #bottom").map((element) => element.outerHTML).join("");
    return (shown.match(/NaN|Infinity|undefined|null|\[object/g) ?? []).length;
}

function marks(row, kind) {
    return all(`.row[data-row="${row}"] ${kind}`);
}

/* ---- Actions ---- */

async function mixed() {
    await open("mixed.html");
    found.opened = {
        title: page.title, counts: texts(".count b"), scripts: page.scripts.length,
        bold: all("dd b, .line b b").length, chosen: chosen(), labels: texts(".label .name"),
        flags: marks("3 4", ".flag").length, listed: all(".difference").length,
        resources: view.performance.getEntriesByType("resource").length,
    };
    await mouse(marks("1 2", ".run.overlapping")[0], 0.5);
    found.clicked = {
        ...chosen(), ...picture(), lane: all(".row.chosen").map((row) => row.dataset.row),
    };
    found.pointed = await point();
    await mouse(marks("1 2", ".run.separated")[0], 0.1);
    found.gap = { ...chosen(), ...picture(), texts: texts("#event-pairs th, #event-pairs td.number") };
    await mouse(marks("1 2", ".run.overlapping")[0], 0.5);
    await mouse(one("#stage"), 0.5, 0.5, [40, 30]);
    found.moved = picture();
    await wheel(one("#stage"), -300);
    found.zoomed = picture();
    await press("ArrowRight");
    found.right = chosen();
    await press("ArrowLeft");
    found.left = chosen();
}

async function difference() {
    await press("d");
    found.next = {
        ...chosen(), changes: text("#event-differences"), words: text(".difference.chosen"),
    };
    await press("D");
    found.around = chosen();
    await mouse(marks("3 4", ".flag")[0], 0.4, 0.2);
    found.flag = { ...chosen(), ...picture() };
    await mouse(all(".difference")[1]);
    found.listed = chosen();
}

async function space() {
    await mouse(all(".difference")[0]);
    found.space = picture();
    await mouse(one("#stage"), 0.5, 0.5, [120, -50]);
    found.turned = picture();
    await mouse(one('#views [data-view="z"]'));
    found.above = picture();
    await mouse(one("#fit-all"));
    await type("#moment", "1000");
    found.slid = {
        ...picture(), said: text("#moment-said"), bands: all(".band").length,
        then: all(".band.then").length,
    };
}

/* The queries with numbers of all sizes, and those after them. */
async function sizes() {
    found.sizes = [];
    await new Promise((done) => {
        view.addEventListener("hashchange", done, { once: true });
        view.location.hash = "#0:73";
    });
    await drawn();
    for (let i = 0; i < 100; i++) {
        found.sizes.push({
            ...chosen(), drawn: picture().drawn, missing: texts("#not-drawn li"), bad: badNumbers(),
        });
        const before = view.location.hash;
        await press("ArrowRight");
        if (view.location.hash === before)
            break;
    }
}

async function filter() {
    await type("#filter", "3");
    found.filtered = { rows: texts(".label .name"), said: text("#rows-said") };
    await type("#filter", "4 3");
    found.filteredPair = texts(".label .name");
    await type("#filter", "77777");
    found.filteredNone = { rows: all(".label").length, said: text("#rows-said") };
    await type("#filter", "");
    const before = all(".label").length;
    await mouse(one("#more-rows"));
    found.more = [before, all(".label").length];
}

async function zoom() {
    const runs = () => marks("all", ".run").map((run) => run.getAttribute("x")).join();
    const before = runs();
    await wheel(one("#plot"), -400);
    const near = runs();
    await mouse(one('.row[data-row="all"] .lane'), 0.5, 0.5, [-90, 0]);
    const dragged = runs();
    await press("0");
    found.zoom = { near: near !== before, dragged: dragged !== near, back: runs() === before };
}

async function scene() {
    await open("arm.html#75");
    found.scene = { ...chosen(), ...picture(), notes: text("#event-pairs") };
    await mouse(all("#event-pairs .pair")[2]);
    found.other = { ...picture(), pressed: texts('.pair[aria-pressed="true"]') };
    await mouse(one("#fit-pair"));
    found.near = picture();
    await mouse(one("#play"));
    found.playing = text("#play");
    await mouse(one("#play"));
    /* A pair that no result names is separated: its row has more queries than name it. */
    found.filled = marks("12 21", ".run").map((run) => run.classList[1]);
}

async function large() {
    await open("many.html");
    found.many = {
        counts: texts(".count b"), note: text("#notes"), folds: texts(".fold title"),
        leftOut: all(".left-out").length, rows: all(".label").length, more: text("#more-rows"),
        bad: badNumbers(),
    };
    await open("crowd.html");
    found.crowd = {
        ...picture(), rows: all("#event-pairs tbody tr").length, notes: text("#event-pairs"),
        missing: texts("#not-drawn li"), bad: badNumbers(),
    };
    await mouse(all("#event-pairs button").pop());
    found.crowdMore = all("#event-pairs tbody tr").length;
    await open("empty.html");
    found.empty = { said: text("#said"), hidden: one("#timeline").hidden };
}

/* Pairs of texts on the axis that overprint each other. */
function overprints() {
    const boxes = all("#plot .tick text, #plot .fold text, #plot .cursor text")
        .map((element) => element.getBoundingClientRect());
    return boxes.flatMap((a, i) => boxes.slice(i + 1).filter((b) => a.left < b.right
        && b.left < a.right)).length;
}

/* A log of uneven steps, of pauses; after each step of a wheel over the axis. */
async function uneven() {
    await open("uneven.html");
    const titles = marks("1 2", ".run").map((run) => run.textContent);
    found.uneven = { titles, texts: texts("#plot .fold text").length, overprints: [overprints()] };
    for (let i = 0; i < 40; i++) {
        await press(i < 25 ? "ArrowRight" : i < 32 ? "+" : "-");
        found.uneven.overprints.push(overprints());
    }
}

/* All that plays the window is in view, where the page is as large as a laptop's. */
async function fold() {
    frame.style.width = "1400px";
    frame.style.height = "900px";
    await open("arm.html");
    found.fold = ["#play", "#moment", "#stage"].map((selector) =>
        one(selector).getBoundingClientRect().bottom);
    found.foldHidden = one("#window").hidden;
}

/* Attempts to fetch, from within the page, are refused. */
async function network() {
    await open("mixed.html");
    const refused = [];
    page.addEventListener("securitypolicyviolation", (event) => {
        refused.push(event.effectiveDirective);
    });
    await view.fetch("drive.js").then(() => refused.push("fetched"), () => {});
    const image = page.createElement("img");
    image.src = "drive.js";
    image.setAttribute("onclick", "document.title = 'ran'");
    page.body.append(image);
    image.click();
    await new Promise((done) => setTimeout(done, 100));
    found.refused = { directives: refused.sort(), title: page.title };
}

async function dark() {
    await mouse(all(".difference")[0]);
    found.dark = { ...picture(), ground: view.getComputedStyle(page.body).backgroundColor };
}

/* Pages that the test has damaged. */
async function broken() {
    await open("changed.html");
    await open("cut.html");
}

const light = [mixed, difference, space, sizes, filter, zoom, scene, large, uneven, fold];
drive(location.hash === "#dark" ? [network, dark, broken] : light);
