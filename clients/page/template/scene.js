/* The scene, drawn by three.js. World coordinates are relative to the origin of the page, in units of
 * 2^exponent, a power of two near the extent of what is shown; so numbers of any size are drawn. */

let renderer = null;
try {
    renderer = new THREE.WebGLRenderer({ canvas: one("scene"), antialias: true, alpha: true });
} catch (error) {
    one("no-scene").textContent = "This browser has no WebGL, so the scene is not drawn. The table and the timeline are complete.";
}
one("stage").hidden = one("camera").hidden = !renderer;
one("no-scene").hidden = Boolean(renderer);

const world = new THREE.Scene(), camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 200);
camera.up.set(0, 0, 1); /* the controls turn about it */
const controls = renderer && new THREE.OrbitControls(camera, one("scene"));
const light = new THREE.DirectionalLight(0xffffff, 0.5);
light.position.set(0.4, 0.7, 1);
camera.add(light);
world.add(camera, new THREE.AmbientLight(0xffffff, 0.6));

const stage = {
    exponent: 0, dim: 3, step: -1, streams: [], dirty: true, moved: true, turning: false, items: [], row: null,
    centre: new THREE.Vector3(), radius: 1, half: [1, 1], size: { width: 0, height: 0 }, corners: [], solids: new Map(), colours: {},
};
const bodyColours = ["#4e79a7", "#f28e2b", "#59a14f", "#b07aa1", "#76b7b2", "#edc948", "#9c755f", "#ff9da7", "#86bcb6", "#8cd17d"];

/* ---- Poses ---- */

/* Quaternions of scenes may have any length. */
function orientationOf(step, k) {
    const given = step.poses[k].orientation ?? [1, 0, 0, 0], [w, x, y, z] = given.length === 2 ? [given[0], 0, 0, given[1]] : given;
    const largest = Math.max(...given.map(Math.abs));
    return new THREE.Quaternion(x / largest, y / largest, z / largest, w / largest).normalize();
}

/* How far a body moves over the window; one that leaves the range of the doubles stops at its end. */
const shiftOf = (step, k) => [0, 1, 2].map((axis) =>
    Math.max(-(2 ** 1023), Math.min(step.T * (step.poses[k].velocity?.[axis] ?? 0), 2 ** 1023)));

/* A world point in units of 2^exponent. */
function pointOf(point) {
    return new THREE.Vector3(...[0, 1, 2].map((axis) => axis < point.length
        ? scaled(point[axis], -stage.exponent) - scaled(data.origin[axis] ?? 0, -stage.exponent) : 0));
}

/* The position of body k after a part of the window, in these units. */
function positionOf(step, k, part) {
    const at = pointOf(step.poses[k].position);
    return step.moves ? sum(at, vectorOf(shiftOf(step, k), stage.exponent), part) : at;
}

/* ---- Bodies ---- */

/* The faces of all bodies are one object of three.js, and their edges another: without a GPU an object takes
 * longer than hundreds of triangles. Their coordinates are relative to stage.centre. */
const faces = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshPhongMaterial({
    side: THREE.DoubleSide, flatShading: true, specular: 0, vertexColors: THREE.VertexColors,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
}));
const edges = new THREE.LineSegments(), ends = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineDashedMaterial());
const bodies = new THREE.Group().add(faces, edges, ends);
edges.userData.colour = "edge";
ends.userData.colour = "dim";
bodies.children.forEach((object) => { object.frustumCulled = false; });
world.add(bodies);

const isDrawn = (body) => typeof body[1] === "number";

/* The solid of shape `index`, its centre, and corners of its extent. */
function surfaceOf(index) {
    if (!stage.solids.has(index)) {
        const solid = solidOf(data.shapes[index], stage.exponent), { corners } = solid, box = new THREE.Box3().setFromPoints(corners);
        const extent = corners.length <= 100 ? corners : boxOf(box.min, box.getSize(new THREE.Vector3())).corners;
        stage.solids.set(index, { ...solid, centre: box.getCenter(new THREE.Vector3()), extent });
    }
    return stage.solids.get(index);
}

/* Points of body k of a step after a part of the window. */
function placed(points, step, k, part) {
    const turn = orientationOf(step, k), at = positionOf(step, k, part);
    return points.map((point) => point.clone().applyQuaternion(turn).add(at));
}

/* Makes the objects for the corners of all items. */
function buildBodies() {
    let count = 0;
    for (const item of stage.items) {
        item.first = count;
        count += item.surface.corners.length;
    }
    const [position, color] = [0, 1].map(() => new THREE.BufferAttribute(new Float32Array(3 * count), 3));
    for (const [object, list] of [[faces, "triangles"], [edges, "edges"]]) {
        object.geometry.dispose();
        object.geometry = new THREE.BufferGeometry().setAttribute("position", position).setAttribute("color", color);
        object.geometry.setIndex(stage.items.flatMap(({ surface, first }) => surface[list].flat().map((k) => first + k)));
    }
}

/* Sets corners and colours for this moment. */
function placeBodies() {
    const { position, color } = faces.geometry.attributes, point = new THREE.Vector3();
    for (const item of stage.items) {
        const { surface: { corners, centre }, source: { stream: { step, part }, k }, first } = item;
        const turn = orientationOf(step, k), at = positionOf(step, k, part).sub(stage.centre), colour = colourOf(item);
        [item.centre] = placed([centre], step, k, part);
        corners.forEach((corner, i) => {
            point.copy(corner).applyQuaternion(turn).add(at).toArray(position.array, 3 * (first + i));
            colour.toArray(color.array, 3 * (first + i));
        });
    }
    position.needsUpdate = color.needsUpdate = true;
    faces.geometry.boundingSphere = null;
    bodies.position.copy(stage.centre);
}

/* In a page of one step, dashed edges where moving bodies end. */
function drawEnds() {
    const { step } = stage.streams[0];
    const moving = stage.items.filter(({ source: { k } }) => step.moves && step.poses[k].velocity);
    setLines(ends, moving.flatMap(({ surface: { corners, edges: lines }, source: { k } }) =>
        placed(lines.flat().map((corner) => corners[corner]), step, k, 1).map((point) => point.sub(stage.centre))));
    Object.assign(ends.material, { dashSize: stage.radius / 30, gapSize: stage.radius / 45 });
    ends.computeLineDistances();
}

/* ---- Answers ---- */

/* An object that shows answers, on top of the bodies and in a colour of the page. */
function onTop(colour, object) {
    Object.assign(object.material, { depthTest: false, transparent: true });
    world.add(Object.assign(object, { frustumCulled: false, renderOrder: 2, userData: { colour } }));
    return object;
}

const [boxes, boxesThen, gapLine] = ["box", "diff", "gap"].map((colour) => onTop(colour, new THREE.LineSegments()));
const [marks, marksThen, gapEnds] = ["box", "diff", "gap"].map((colour) =>
    onTop(colour, new THREE.Points(undefined, new THREE.PointsMaterial({ size: 7, sizeAttenuation: false }))));

function setLines(object, points) {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry().setFromPoints(points);
    object.visible = points.length > 0;
}

/* ---- Extent ---- */

/* The corners of all bodies of a step, at the begin and the end of its window. */
function cornersOf(step, only = null) {
    const out = [];
    step.bodies.forEach((body, k) => {
        if (!isDrawn(body) || (only && !only.includes(k)))
            return;
        for (const part of step.moves ? [0, 1] : [0])
            out.push(...placed(surfaceOf(body[1]).extent, step, k, part));
    });
    return out;
}

/* Sets centre and radius. */
function setExtent(corners) {
    const box = new THREE.Box3().setFromPoints(corners);
    stage.corners = corners;
    box.getCenter(stage.centre);
    stage.moved = true;
    stage.radius = box.getSize(new THREE.Vector3()).length() / 2 || 1;
}

function exponentOfStep(step) {
    step.exponent ??= Math.max(1 + exponentOfAll(step.poses.flatMap(({ position }, k) =>
        position ? [...position.map((x, axis) => x / 2 - (data.origin[axis] ?? 0) / 2), ...shiftOf(step, k).map((x) => x / 2)] : [])),
        ...step.bodies.filter(isDrawn).map((body) => exponentOf(data.shapes[body[1]])));
    return step.exponent;
}

/* Steps at most 4 times as large as step i, or as small, spread over the page. */
function likeSteps(i) {
    const every = Math.ceil(steps.length / 60), exponent = exponentOfStep(steps[i]);
    return steps.filter((step, k) => (k === i || k % every === 0) && dimOf(step) === dimOf(steps[i])
        && Math.abs(exponentOfStep(step) - exponent) <= 2);
}

function dimOf(step) {
    const body = step.bodies.find(isDrawn);
    return body ? data.shapes[body[1]].dim : 3;
}

/* ---- The camera ---- */

const directions = { iso: [0.75, -1, 0.6], top: [0, 0, 1], front: [0, -1, 0], side: [1, 0, 0] };

function look(direction) {
    const from = new THREE.Vector3(...stage.dim === 2 ? directions.top : direction).normalize();
    controls.target.copy(stage.centre);
    camera.position.copy(sum(stage.centre, from, 8 * stage.radius));
    controls.update();
    camera.updateMatrixWorld();
    const seen = new THREE.Box3().setFromPoints(stage.corners.map((corner) => corner.clone().applyMatrix4(camera.matrixWorldInverse)));
    stage.half = ["x", "y"].map((axis) => Math.max(-seen.min[axis], seen.max[axis], 1e-3 * stage.radius));
    camera.near = stage.radius / 100;
    camera.far = 50 * stage.radius;
    camera.zoom = 1;
    controls.enableRotate = stage.dim === 3;
    controls.mouseButtons.LEFT = stage.dim === 3 ? THREE.MOUSE.ROTATE : THREE.MOUSE.PAN;
    resize();
}

/* Fits all that is like the step, or the pair of the chosen row; keeps the direction. */
function fit(row = null, direction = null) {
    if (!renderer || stage.step < 0)
        return;
    const pair = row && pairAt(row, stage.step);
    const to = direction ?? camera.position.clone().sub(controls.target).toArray();
    if (pair && pair[0] >= 0)
        setExtent(cornersOf(steps[stage.step], pair.slice(0, 2)));
    else
        setExtent(likeSteps(stage.step).flatMap((step) => cornersOf(step)));
    look(to);
}

function resize() {
    const { width, height } = stage.size = sizeOf(one("stage"));
    if (!renderer || width === 0 || height === 0)
        return;
    const up = 1.08 * Math.max(stage.half[1], stage.half[0] * height / width), across = up * width / height;
    Object.assign(camera, { left: -across, right: across, top: up, bottom: -up });
    camera.updateProjectionMatrix();
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2) * pace.scale);
    renderer.setSize(width, height, false);
    stage.dirty = true;
}

/* ---- Resolution: a browser that paints slowly gets less to paint while something moves ---- */

/* Pixels in each direction, by level. Below 1 only bodies in contact have names, and the table follows less often. */
const scales = [1, 0.75, 0.5];
const pace = { level: 0, scale: 1, mean: 0, frames: 0, patience: 60 };

/* Sets the scale for the next frame. In: moves: whether something moves; ms: how long the last frame took, the
 * page's scripts not counted. The mean of some frames must be above 30 ms to lower the resolution, and below 20
 * ms for `patience` frames to raise it. Each rise doubles the patience, so that it does not alternate. */
function followPace(moves, ms) {
    pace.mean = moves && pace.frames > 0 ? pace.mean + (Math.min(ms, 100) - pace.mean) / 8 : 25;
    pace.frames = moves ? pace.frames + 1 : 0;
    const isSlow = pace.frames > 8 && pace.mean > 30 && pace.level < scales.length - 1;
    const isFast = pace.frames > pace.patience && pace.mean < 20 && pace.level > 0;
    if (isSlow || isFast) {
        pace.level += isSlow ? 1 : -1;
        pace.patience *= isFast ? 2 : 1;
        pace.frames = 0;
    }
    const scale = moves ? scales[pace.level] : 1;
    if (scale !== pace.scale) {
        pace.scale = scale;
        resize();
    }
}

/* ---- Drawing a moment ---- */

/* Colours and names follow the strongest verdict of each body: {verdict, now}, now: in contact at this
 * moment of the window. */
function statesOf(step, offset) {
    const states = step.bodies.map(() => ({ verdict: 0, now: false }));
    for (const pair of step.pairs) {
        const answer = nowOf(pair), verdict = verdictOf(answer);
        const [first, last] = answer.contact ?? [0, Infinity];
        const isNow = verdict >= TOUCHING && first <= offset && offset <= last;
        for (const k of pair.slice(0, 2)) {
            const state = states[k];
            if (state && (isNow > state.now || (isNow === state.now && verdict > state.verdict)))
                Object.assign(state, { verdict, now: isNow });
        }
    }
    return states;
}

/* The colour of an item. */
function colourOf({ state, source: { stream: { step }, k } }) {
    const { none, touching, overlapping } = stage.colours, at = new THREE.Color(none), full = state.verdict === OVERLAPPING ? overlapping : touching;
    if (one("colour").value === "body")
        at.set(bodyColours[(Number(step.bodies[k][0]) || k) % bodyColours.length]);
    else if (state.verdict >= TOUCHING)
        at.lerp(new THREE.Color(full), state.now ? 1 : 0.3);
    return at;
}

/* The edges of a box of an answer, as pairs of points; infinite ends are out of view. */
function boxPoints(box) {
    const dim = box.length / 2;
    const [low, high] = [box.slice(0, dim), box.slice(dim)].map((end, side) => {
        const point = pointOf(end.map((x) => x ?? 0));
        end.forEach((x, axis) => x === null && point.setComponent(axis, stage.centre.getComponent(axis) + (side ? 9 : -9) * stage.radius));
        return point;
    });
    const { corners, edges } = boxOf(low, sum(high, low, -1), dim);
    return edges.flat().map((k) => corners[k]);
}

/* New buffers take a browser without a GPU long: so not in each frame. */
function drawAnswers() {
    const key = `${stage.step} ${stage.row?.index}`;
    if (key === stage.answers)
        return;
    stage.answers = key;
    const shown = stage.streams.flatMap(({ step }) => step.pairs).slice(0, 300);
    setLines(boxes, shown.map((pair) => nowOf(pair).box).filter(Boolean).flatMap(boxPoints));
    setLines(boxesThen, shown.filter(isDifferent).map((pair) => pair[2].box).filter(Boolean).flatMap(boxPoints));
    const marksOf = (answers) => answers.map(({ point }) => point?.slice(1)).filter((at) => at && !at.includes(null)).map(pointOf);
    setLines(marks, marksOf(shown.map(nowOf)));
    setLines(marksThen, marksOf(shown.filter(isDifferent).map((pair) => pair[2])));
    const pair = stage.row && pairNow(stage.row, stage.step);
    const [, , , ...points] = (pair && nowOf(pair).gap) || [];
    const ends = points.length > 0 ? [points.slice(0, points.length / 2), points.slice(points.length / 2)].map(pointOf) : [];
    setLines(gapLine, ends);
    setLines(gapEnds, ends);
}

/* Shows the moment s, which is in step i. */
function drawMoment(i, s) {
    if (!renderer || !steps[i])
        return;
    if (i !== stage.step)
        beginStep(i);
    for (const stream of stage.streams) {
        const offset = offsetAt(s, stream.i);
        stream.part = stream.step.T > 0 ? offset / stream.step.T : 0;
        stream.states = statesOf(stream.step, offset);
    }
    stage.items.forEach((item) => { item.state = item.source.stream.states[item.source.k]; });
    drawAnswers();
    stage.dirty = stage.moved = true;
}

function beginStep(i) {
    const step = steps[i], exponent = exponentOfStep(step);
    const fresh = stage.step < 0 || dimOf(step) !== stage.dim || Math.abs(exponent - stage.exponent) > 6;
    stage.step = i;
    if (fresh) {
        stage.exponent = exponent;
        stage.dim = dimOf(step);
        stage.solids.clear();
    }
    /* what is of another size by far is not drawn beside it */
    stage.streams = streamsOf(i).filter((j) => Math.abs(exponentOfStep(steps[j]) - exponent) <= 16).map((j) => ({ i: j, step: steps[j] }));
    const sources = new Map();
    for (const stream of stage.streams)
        stream.step.bodies.forEach((body, k) => {
            const key = bodyKey(stream.step, k);
            if (isDrawn(body) && data.shapes[body[1]].dim === stage.dim && !sources.has(key))
                sources.set(key, { stream, k });
        });
    /* sorted, so that steps of the same bodies have the same order */
    const old = stage.items;
    stage.items = [...sources.keys()].sort().map((key, n) => {
        const source = sources.get(key), surface = surfaceOf(source.stream.step.bodies[source.k][1]);
        return { source, surface, first: old[n]?.first };
    });
    if (old.length !== stage.items.length || stage.items.some(({ surface }, n) => surface !== old[n].surface))
        buildBodies();
    if (fresh)
        fit(null, directions.iso);
    if (steps.length === 1)
        drawEnds();
    beginLabels();
}

/* ---- Names ---- */

function beginLabels() {
    const names = stage.items.slice(0, 200).map((item) => bodyName(item.source.stream.step, item.source.k));
    if (names.join("\n") !== stage.names) {
        stage.names = names.join("\n");
        one("labels").replaceChildren(...names.map((name) => Object.assign(document.createElement("span"), { textContent: name })));
        stage.labels = [...one("labels").children].map((label) => {
            const { width, height } = label.getBoundingClientRect();
            return { label, width: Math.ceil(width), height: Math.ceil(height) };
        });
    }
    stage.labels.forEach((label, n) => { label.item = stage.items[n]; });
}

/* Places the names beside the middles of their bodies, those in contact first; one that would
 * overprint another is not shown. */
function drawLabels() {
    const { width, height } = stage.size, placed = [];
    const order = [...stage.labels ?? []].sort((a, b) => b.item.state.verdict - a.item.state.verdict);
    for (const { label, item, width: w, height: h } of order) {
        const at = item.centre.clone().project(camera);
        const x = Math.round((at.x + 1) / 2 * width - w / 2), y = Math.round((1 - at.y) / 2 * height - h / 2);
        const isFree = one("names").checked && (pace.scale >= 1 || item.state.now) && x >= 0 && y >= 0 && x + w <= width && y + h <= height
            && placed.every((p) => x >= p.x + p.w || p.x >= x + w || y >= p.y + p.h || p.y >= y + h);
        label.style.visibility = isFree ? "visible" : "hidden";
        if (isFree) {
            label.style.transform = `translate(${x}px, ${y}px)`;
            placed.push({ x, y, w, h });
        }
    }
}

/* ---- The pointer ---- */

/* Names the body below the pointer. */
function drawPointed(event) {
    const box = one("scene").getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera({ x: (event.clientX - box.left) / box.width * 2 - 1, y: 1 - (event.clientY - box.top) / box.height * 2 }, camera);
    const [hit] = ray.intersectObject(faces);
    one("pointed").hidden = !hit;
    if (!hit)
        return;
    const { state: { verdict }, source: { stream, k } } = stage.items[lastUpTo(stage.items.map((item) => item.first), hit.face.a)];
    one("pointed").textContent = `${bodyName(stream.step, k)}${verdict ? `: ${verdictNames[verdict]}` : ""}`;
}

/* ---- Colours, and the loop ---- */

function readColours() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["separated", "touching", "overlapping", "none", "edge", "dim", "box", "diff", "gap", "ink", "rule"])
        stage.colours[name] = style.getPropertyValue(`--${name}`).trim();
    world.traverse(({ material, userData: { colour } }) => colour && material.color.set(stage.colours[colour]));
    stage.moved = true;
}

/* Draws if something has changed. */
function drawScene() {
    if (!renderer || !stage.dirty)
        return;
    if (stage.moved && stage.items.length > 0)
        placeBodies();
    stage.dirty = stage.moved = false;
    renderer.render(world, camera);
    drawLabels();
}

if (renderer) {
    controls.enableKeys = false;
    controls.screenSpacePanning = true;
    controls.addEventListener("change", () => { stage.dirty = true; });
    controls.addEventListener("start", () => { stage.turning = true; });
    controls.addEventListener("end", () => { stage.turning = false; });
    /* A new size clears the canvas, and this frame's drawing is already done: it is drawn again before it is painted. */
    new ResizeObserver(() => {
        resize();
        drawScene();
    }).observe(one("stage"));
    one("scene").addEventListener("webglcontextrestored", () => { stage.dirty = true; });
    one("scene").addEventListener("pointermove", drawPointed);
    one("scene").addEventListener("pointerleave", () => { one("pointed").hidden = true; });
}
