/* Opens pages in turn, and operates them as a reader does (tools.js). */
"use strict";

/* ---- What a page shows ---- */

/* Counts pixels of the scene, in the frame that drew it, or of a rectangle of an image: all drawn pixels, those of
 * each colour, and a checksum. */
const copy = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
function pixels(image = one("#scene"), { x, y, width, height } = { x: 0, y: 0, width: image.width, height: image.height }) {
    Object.assign(copy.canvas, { width, height });
    copy.drawImage(image, -x, -y);
    const { data } = copy.getImageData(0, 0, width, height), count = { drawn: 0, dark: 0, red: 0, yellow: 0, blue: 0, violet: 0, sum: 0 }, shades = new Set();
    for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] < 60)
            continue;
        const r = data[i], g = data[i + 1], b = data[i + 2];
        count.drawn++;
        count.dark += Math.max(r, g, b) < 80 ? 1 : 0;
        shades.add(`${r} ${g} ${b}`);
        count.red += r > g + 90 && r > b + 90 && r > 120 ? 1 : 0;
        count.yellow += r > 140 && g > 90 && b < g - 70 && r > g + 20 ? 1 : 0;
        count.blue += b > r + 40 && b > g + 20 && r < 100 ? 1 : 0;
        count.violet += b > g + 80 && r > g + 40 && b > r + 30 ? 1 : 0;
        count.sum = (count.sum * 31 + r + 2 * g + 3 * b + i) % 1000000007;
    }
    return { ...count, shades: shades.size };
}

/* Draws, and counts. */
function picture() {
    view.fmb.stage.dirty = true;
    view.fmb.drawScene();
    return pixels();
}

/* The table: each row as a text of its cells. */
function table() {
    return all("#pairs tr").map((tr) => [...tr.cells].map((td) => td.textContent).filter(Boolean).join(" | "));
}

function facts() {
    return Object.fromEntries(all("#detail dt").map((dt) => [dt.textContent, dt.nextElementSibling.textContent]));
}

function moment() {
    return { text: text("#moment"), hash: view.location.hash, chosen: texts("tr.chosen td:first-child"), facts: facts() };
}

/* Where bodies are, by name: rounded, in units of the page. */
function places() {
    const { stage } = view.fmb;
    return stage.items.map((item) => item.centre.toArray().map((x) => Math.round(x * 2 ** stage.exponent * 1e4) / 1e4));
}

/* The direction of the x axis of body k, seen from above. */
function axisOf(k) {
    const { source: { stream: { step, part } }, surface: { corners: [corner] } } = view.fmb.stage.items[k];
    const [from, to] = view.fmb.placed([corner.clone().set(0, 0, 0), corner.clone().set(1, 0, 0)], step, k, part);
    return to.sub(from).toArray().slice(0, 2).map((x) => Math.round(x * 1e3) / 1e3);
}

/* Of each body: the area of its triangles, the length of its edges, and the ends of its corners on each axis, in
 * units of the page. */
function surfaces() {
    const { stage } = view.fmb, rounded = (x) => Math.round(x * 2 ** stage.exponent * 1e3) / 1e3;
    return stage.items.map(({ surface: { corners, triangles, edges } }) => {
        const side = (a, b) => corners[b].clone().sub(corners[a]);
        const area = triangles.reduce((sum, [a, b, c]) => sum + side(a, b).cross(side(a, c)).length() / 2, 0);
        const ends = ["x", "y", "z"].map((axis) => [Math.min, Math.max].map((end) => rounded(end(...corners.map((corner) => corner[axis])))));
        return [rounded(area * 2 ** stage.exponent), rounded(edges.reduce((sum, [a, b]) => sum + side(a, b).length(), 0)), ...ends];
    });
}

/* The middle of body n in the window of the page. */
function middleOf(n) {
    const { stage, camera } = view.fmb, box = one("#scene").getBoundingClientRect(), at = stage.items[n].centre.clone().project(camera);
    return { x: box.left + (at.x + 1) / 2 * box.width, y: box.top + (1 - at.y) / 2 * box.height };
}

/* The visible labels that are more than 4 pixels off their bodies, or cover a body in front of their own. */
function misplaced() {
    picture();
    const { stage, hitAt } = view.fmb;
    return stage.labels.filter(({ label, n }) => {
        const box = label.getBoundingClientRect(), ownerOf = (hit) => stage.owners[hit.face.a];
        const hit = (x, y, right = 0, down = 0) => hitAt({ clientX: box.left + x * box.width + right, clientY: box.top + y * box.height + down });
        const middle = [[0, 0], [4, 0], [0, 4], [-4, 0], [0, -4]].map((offset) => hit(0.5, 0.5, ...offset)).find((each) => each && ownerOf(each) === n);
        const isCovered = (other) => other && ownerOf(other) !== n && other.distance < middle.distance - 0.01 * stage.radius;
        return label.style.visibility === "visible" && (!middle
            || [0.1, 0.3, 0.7, 0.9].some((x) => [0.2, 0.8].some((y) => isCovered(hit(x, y)))));
    }).map(({ label }) => label.textContent);
}

/* Counts the pixels, and those of each colour, around a point of the scene in units of the page. */
function around(point, size = 12) {
    const { stage, camera } = view.fmb, { width, height } = one("#scene");
    const at = camera.position.clone().fromArray(point).multiplyScalar(2 ** -stage.exponent).project(camera);
    const box = { x: Math.round((at.x + 1) / 2 * width - size / 2), y: Math.round((1 - at.y) / 2 * height - size / 2), width: size, height: size };
    return pixels(one("#scene"), box);
}

/* The stated and the drawn length of the scale, and the length of a unit on the screen. */
function scale() {
    const { stage, camera } = view.fmb, canvas = one("#axes"), ratio = canvas.width / canvas.clientWidth;
    const bar = pixels(canvas, { x: 0, y: Math.round(canvas.height - 9 * ratio), width: canvas.width, height: 1 }).drawn / ratio;
    const right = camera.position.clone().set(1, 0, 0).transformDirection(camera.matrixWorld).multiplyScalar(2 ** -stage.exponent);
    const unit = right.add(stage.centre).project(camera).x - stage.centre.clone().project(camera).x;
    return { said: Number(canvas.ariaLabel.replace("length of the scale: ", "")), bar, unit: unit / 2 * one("#stage").clientWidth, drawn: pixels(canvas).drawn };
}

/* What is said of a point of the window. */
function pointed({ x, y }) {
    one("#scene").dispatchEvent(new view.PointerEvent("pointermove", { clientX: x, clientY: y }));
    return one("#pointed").hidden ? "" : text("#pointed");
}

/* The names of the pairs, sorted by each column, up and down. */
async function sorted() {
    const out = [];
    for (let k = 0; k < 2 * all("#heads th").length; k++) {
        await mouse(all("#heads th")[k >> 1]);
        out.push(texts("#pairs td:first-child").join());
    }
    return out;
}

/* Where the camera looks. */
function direction() {
    const { camera } = view.fmb;
    return camera.getWorldDirection(camera.position.clone()).toArray();
}

/* Pixels of the drawing for each of the page, and the scale of the page's state. */
function resolution() {
    return { scale: view.fmb.pace.scale, drawn: one("#scene").width / one("#stage").clientWidth / view.devicePixelRatio };
}

function labels() {
    return all("#labels span").filter((span) => span.style.visibility === "visible");
}

/* Pairs of visible texts that overprint each other. */
function overprints() {
    picture();
    const boxes = labels().map((span) => span.getBoundingClientRect());
    return boxes.flatMap((a, i) => boxes.slice(i + 1).filter((b) => a.left < b.right && b.left < a.right
        && a.top < b.bottom && b.top < a.bottom)).length;
}

/* Texts that stand for a missing or invalid value. */
function badTexts() {
    return (page.body.innerText.match(/NaN|Infinity|undefined|null|\[object/g) ?? []).length;
}

/* The colours along the middle of a lane. */
function lane(row) {
    const canvas = all("#pairs canvas")[row], { width, height } = canvas, seen = [];
    const { data } = canvas.getContext("2d").getImageData(0, height / 2, width, 1);
    for (let x = 0; x < width; x++) {
        const [r, g, b, a] = data.subarray(4 * x, 4 * x + 4);
        const name = a < 60 ? "none" : r > g + 90 && b > g + 60 ? "difference" : r > g + 90 ? "overlapping" : r > b + 90 ? "touching" : "separated";
        if (seen[seen.length - 1] !== name)
            seen.push(name);
    }
    return seen;
}

/* Waits for an event, for a minute at most. */
async function until(holds) {
    for (const from = performance.now(); !holds() && performance.now() - from < 60000;)
        await drawn();
}

/* ---- A scene ---- */

async function scene() {
    await open("table.html");
    found.opened = {
        ...moment(), ...picture(), title: page.title, counts: text("#counts"), table: table(), labels: labels().map((span) => span.textContent),
        scripts: page.scripts.length, resources: view.performance.getEntriesByType("resource").length, places: places(),
        misplaced: misplaced(), over: [0, 1, 2].map((n) => pointed(middleOf(n))), lanes: [lane(0), lane(1), lane(2)], widths: all("#heads th").map((th) => th.offsetWidth), boxes: view.fmb.stage.items.length, camera: view.fmb.camera.zoom,
    };
    await mouse(all("#pairs tr")[2].cells[0]);
    found.gap = { ...picture(), ...moment() };
    await press("n");
    await until(() => view.location.hash === "#t=1.9"); /* written ten times a second at most */
    found.contact = { ...picture(), ...moment() };
    await press("n");
    found.nextContact = { ...picture(), ...moment(), places: places() };
    await press("Home");
    await press("+");
    const pressed = press(" ");
    found.playing = text("#play"); /* at once: a slow machine draws when it has ended */
    await pressed;
    await until(() => !view.fmb.player.playing);
    found.played = { ...picture(), ...moment(), places: places(), button: text("#play") };
    one("#loop").checked = true;
    view.fmb.seek(1.9);
    await press(" ");
    await until(() => view.fmb.player.s < 1.9);
    found.looped = view.fmb.player.playing;
    await press(" ");
    await type("#scrub", "1");
    found.scrubbed = { ...moment(), places: places() };
    view.location.hash = "#t=0.5";
    await until(() => view.fmb.player.s === 0.5);
    found.linked = text("#moment");
    await type("#colour", "body", "change");
    found.byBody = picture();
    await press("2");
    found.top = picture();
    await mouse(all("#pairs tr")[0].cells[0]);
    await press("c");
    found.pair = picture();
    await mouse(one("#scene"), 0.5, 0.5);
    const box = one("#scene").getBoundingClientRect();
    for (const [kind, target, x] of [["mousedown", one("#scene"), 300], ["mousemove", page, 340], ["mouseup", page, 340]])
        target.dispatchEvent(new view.MouseEvent(kind, { bubbles: true, clientX: box.left + x, clientY: box.top + 300, button: 0 }));
    found.turned = picture();
    found.pointed = pointed({ x: box.left + box.width / 2, y: box.top + box.height / 2 });
    await press("1");
    const before = direction();
    for (const [kind, target, x] of [["mousedown", one("#scene"), 300], ["mousemove", page, 340], ["mouseup", page, 340]])
        target.dispatchEvent(new view.MouseEvent(kind, { bubbles: true, clientX: box.left + x, clientY: box.top + 300, button: 0 }));
    found.orbit = { before, after: direction() };
    found.sorts = await sorted();
    await open("pointless.html");
    found.pointless = { ...picture(), ...moment() };
    await open("reversed.html");
    found.reversed = table();
}

/* Two scenes of a hand with two fingers. */
async function frames() {
    await open("frames.html");
    const { stage } = view.fmb;
    found.frames = { table: table(), lane: lane(0), radius: stage.radius * 2 ** stage.exponent, times: [], scale: scale() };
    for (const s of [0, 1.25, 2, 3.25]) {
        view.fmb.seek(s);
        found.frames.times.push({ ...picture(), moment: moment(), table: table(), fingers: [0, 3].map((x) => around([x, 0, 0])), misplaced: misplaced() });
    }
    await press("n");
    await press("n");
    found.frames.next = moment();
}

async function shapes() {
    await open("shapes.html");
    found.shapes = { ...picture(), surfaces: surfaces(), table: table(), kinds: view.fmb.stage.items.map((item) => item.surface.triangles.length), bad: badTexts() };
    await open("hulls.html");
    found.hulls = { ...picture(), surfaces: surfaces(), kinds: view.fmb.stage.items.map((item) => [item.surface.triangles.length, item.surface.edges.length]) };
    await open("round.html");
    found.round = { ...picture(), surfaces: surfaces(), bad: badTexts(), facing: around([0.54, -0.72, 0.43], 16), scale: scale() };
    await open("disc.html");
    found.disc = { ...picture(), surfaces: surfaces(), bad: badTexts() };
    await open("plane.html");
    await press("n");
    found.plane = { ...picture(), surfaces: surfaces(), direction: direction().map(Math.round), kinds: view.fmb.stage.items.map((item) => item.surface.triangles.length) };
    await open("ends.html");
    found.ends = [];
    for (const s of [0, 1, 2]) {
        view.fmb.seek(s);
        await drawn();
        found.ends.push({ ...moment(), places: places(), turn: axisOf(0) });
    }
    await open("hostile.html");
    found.hostile = { title: page.title, table: table(), bold: all("#pairs b, #labels b").length, labels: texts("#labels span") };
    await open("empty.html");
    found.empty = { counts: text("#counts"), rows: table().length, bad: badTexts() };
}

/* ---- Sizes of the window ---- */

function setSize(width, height) {
    Object.assign(frame.style, { width: `${width}px`, height: `${height}px` });
}

/* Resizes the page, which must change the size of its stage. Returns the pixels of the scene as that frame paints
 * them: this observer follows the page's own, after which nothing comes but painting. */
function resize(width, height) {
    return new Promise((done) => {
        const before = [one("#stage").clientWidth, one("#stage").clientHeight].join();
        const observer = new view.ResizeObserver(([{ contentRect }]) => {
            if (before === [contentRect.width, contentRect.height].join())
                return;
            observer.disconnect();
            done(pixels());
        });
        observer.observe(one("#stage"));
        setSize(width, height);
    });
}

/* Resizes a page, as "chromium --screenshot" does first, and counts the pixels of the scene in a screenshot. */
async function screenshot(scheme, width, height) {
    await setColours(scheme);
    setSize(width, height - 90);
    await open("table.html");
    const painted = await resize(width, height);
    const at = frame.getBoundingClientRect(), box = one("#stage").getBoundingClientRect(), image = new Image();
    const clip = { x: at.left + box.left, y: at.top + box.top, width: box.width, height: box.height, scale: 1 };
    image.src = `data:image/png;base64,${(await command("Page.captureScreenshot", { clip })).data}`;
    await image.decode();
    return { scheme, size: [width, height], painted, seen: pixels(image) };
}

/* Screenshots of pages that draw no frame but their first. */
async function screenshots() {
    found.screenshots = [];
    const script = "let frames = 0; const next = requestAnimationFrame; requestAnimationFrame = (draw) => frames++ ? 0 : next(draw);";
    await beginningWith(script, async () => {
        for (const scheme of ["dark", "light"])
            for (const [width, height] of [[1400, 900], [1100, 620], [390, 800]])
                found.screenshots.push(await screenshot(scheme, width, height));
    });
    setSize(1400, 900);
}

/* The GPU loses all its contents, as after a reset of its driver. */
async function restored() {
    await open("table.html");
    const scene = one("#scene"), gpu = scene.getContext("webgl2") ?? scene.getContext("webgl"), loses = gpu.getExtension("WEBGL_lose_context");
    const comes = (event) => new Promise((done) => scene.addEventListener(event, done, { once: true }));
    const lost = comes("webglcontextlost"), back = comes("webglcontextrestored");
    loses.loseContext();
    await lost;
    await drawn();
    loses.restoreContext();
    await back;
    found.restored = await new Promise((done) => view.requestAnimationFrame(() => done(pixels())));
}

/* ---- Scenes, and recordings ---- */

async function arm() {
    await open("arm.html");
    const widths = () => all("#heads th").map((th) => th.offsetWidth).join();
    found.arm = { ...moment(), rows: table(), overprints: [], misplaced: [], counts: text("#counts"), lane: lane(0), widths: [widths()] };
    for (let i = 0; i < 5; i++) {
        await press("ArrowRight");
        found.arm.overprints.push(overprints());
        found.arm.misplaced.push(...misplaced());
        found.arm.widths.push(widths());
    }
    found.arm.last = moment();
    await type("#filter", "GRIP lid");
    found.filtered = { rows: table().length, said: text("#rows-said"), first: table()[0] };
    await type("#filter", "");
    one("#contacts").click();
    found.contacts = { rows: table().length, said: text("#rows-said") };
    one("#contacts").click();
    await mouse(all("#heads th")[0]);
    const names = texts("#pairs td:first-child");
    await mouse(all("#heads th")[0]);
    found.sorted = { first: names[0], last: names[names.length - 1], down: texts("#pairs td:first-child")[0] };
    await resize(390, 900);
    found.narrow = { width: page.scrollingElement.scrollWidth, stage: one("#stage").clientWidth, overprints: overprints(), misplaced: misplaced() };
    await resize(1400, 900);
    found.wide = ["#stage", "#rows", "#play", "#overview", "#scrub"].map((selector) => one(selector).getBoundingClientRect().bottom);
    found.scrolls = page.scrollingElement.scrollHeight;
}

/* Frames that take long lower the resolution of what moves. */
async function slow() {
    await open("arm.html");
    const { pace, followPace } = view.fmb, scales = [];
    for (const [frames, ms] of [[1000, 16], [1, 500], [20, 16], [12, 50], [12, 50], [20, 50], [1000, 25], [100, 10], [20, 50], [100, 10], [100, 10]]) {
        for (let i = 0; i < frames; i++)
            followPace(true, ms);
        scales.push(pace.scale);
    }
    followPace(false, 50);
    found.pace = [...scales, pace.scale];
    const delay = () => {
        for (const from = performance.now(); performance.now() - from < 50;);
        view.requestAnimationFrame(delay);
    };
    view.requestAnimationFrame(delay);
    one("#loop").checked = true;
    await press(" ");
    await until(() => pace.scale === 0.5);
    found.slow = resolution();
    await press(" ");
    found.rested = resolution();
    one("#scene").dispatchEvent(new view.MouseEvent("mousedown", { bubbles: true, button: 0 }));
    await until(() => pace.scale === 0.5);
    found.turning = resolution();
    page.dispatchEvent(new view.MouseEvent("mouseup", { button: 0 }));
    await drawn();
    found.turnedSlow = resolution();
}

async function recording() {
    await open("many.html");
    found.many = { misplaced: misplaced(), labels: labels().length };
    await open("stack.html");
    found.stack = { ...moment(), bodies: [], lane: lane(0), gap: !one("#gap").hidden, gapSaid: text("#gap-said"), plot: pixels(one("#gap-plot")) };
    for (let i = 0; i < 8; i++) {
        found.stack.bodies.push(view.fmb.stage.items.length);
        await press("ArrowRight");
    }
    await open("paused.html");
    found.paused = { span: view.fmb.begins[view.fmb.begins.length - 1], end: (await press("End"), text("#moment")) };
    await open("crowd.html");
    found.crowd = { ...picture(), overprints: overprints(), counts: text("#counts"), notes: text("#notes"), rows: table().length, different: all("td.different").length };
    await mouse(one("#more"));
    found.crowd.more = table().length;
    await press("d");
    found.difference = { ...moment(), ...picture(), lane: lane(0) };
    await open("golden.html");
    await press("d");
    found.golden = { title: page.title, ...moment() };
    await open("nudged.html");
    await press("d");
    found.nudged = moment();
    await open("refused.html");
    found.refused = { bad: 0, missing: 0, outcomes: [] };
    for (let i = 0; i < view.fmb.steps.length; i++) {
        found.refused.bad += badTexts();
        found.refused.missing += facts()["not drawn"] ? 1 : 0;
        found.refused.outcomes.push(facts().query.split(": ").pop());
        key("ArrowRight");
    }
}

/* Each query of hard pairs, with numbers of all sizes. */
async function sizes() {
    found.sizes = [];
    for (const name of ["hard-3d.html", "hard-2d.html"]) {
        await open(name);
        for (let i = 0; i < view.fmb.steps.length; i += 3) {
            view.fmb.seek(view.fmb.begins[i]);
            key("c"); /* all bodies may be far apart for their sizes */
            found.sizes.push({ step: i, drawn: picture().drawn, bad: badTexts(), labels: labels().length });
        }
    }
}

async function meshes() {
    await open("mesh.html");
    found.mesh = { ...picture(), title: page.title, rows: table(), counts: text("#counts") };
    await mouse(all("#pairs tr")[1].cells[0]);
    await press("c");
    found.face = { ...picture(), ...moment() };
    await press("f");
    await press("n");
    found.mesh.moving = picture();
    await press("End");
    found.moved = { ...picture(), ...moment() };
    await open("apart.html");
    found.apart = { ...picture(), rows: table().length };
}

/* ---- Protection ---- */

/* Attempts to fetch, from within the page, are refused. */
async function network() {
    await open("arm.html");
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
    await until(() => refused.length === 3);
    found.foreign = { directives: refused.sort(), title: page.title };
}

async function broken() {
    await load("changed.html");
    await load("cut.html");
}

async function dark() {
    await setColours("dark");
    await open("table.html");
    found.dark = { ...picture(), ground: view.getComputedStyle(page.body).backgroundColor };
    await setColours("light");
}

/* In a browser that has no WebGL, such a context is null. */
async function noScene() {
    const script = "const { getContext } = HTMLCanvasElement.prototype; HTMLCanvasElement.prototype.getContext = function (kind, how) {"
        + " return kind.includes('webgl') ? null : getContext.call(this, kind, how); };";
    await beginningWith(script, async () => {
        await open("arm.html");
        found.none = { stage: one("#stage").hidden, said: text("#no-scene"), rows: table(), lane: lane(0) };
        await press("n");
        found.none.next = moment();
    });
}

drive([screenshots, restored, scene, frames, shapes, arm, slow, recording, sizes, meshes, network, broken, dark, noScene]);
