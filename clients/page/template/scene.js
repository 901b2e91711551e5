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
const controls = renderer && new THREE.OrbitControls(camera, one("scene"));
const light = new THREE.DirectionalLight(0xffffff, 0.5);
light.position.set(0.4, 0.7, 1);
camera.add(light);
world.add(camera, new THREE.AmbientLight(0xffffff, 0.6));

const stage = {
    exponent: 0, dim: 3, step: -1, streams: [], dirty: true, items: [], row: null,
    centre: [0, 0, 0], radius: 1, half: [1, 1], size: { width: 0, height: 0 }, corners: [], solids: new Map(), colours: {},
};
const bodyColours = ["#4e79a7", "#f28e2b", "#59a14f", "#b07aa1", "#76b7b2", "#edc948", "#9c755f", "#ff9da7", "#86bcb6", "#8cd17d"];

/* ---- Poses ---- */

function orientationOf(step, k) {
    const [w, x, y, z] = step.turns ? numbers.subarray(step.turn + 4 * k, step.turn + 4 * k + 4) : [1, 0, 0, 0];
    return new THREE.Quaternion(x, y, z, w).normalize();
}

/* The position of body k after a part of the window, in units of 2^exponent. */
function positionOf(step, k, part, exponent) {
    const factor = scaled(1, step.at - 24 - exponent);
    return [0, 1, 2].map((axis) => factor * (numbers[step.first + 3 * k + axis] + (step.moves ? part * numbers[step.shift + 3 * k + axis] : 0)));
}

/* A world point in these units. */
function pointOf(point) {
    return [0, 1, 2].map((axis) => axis < point.length
        ? scaled(point[axis], -stage.exponent) - scaled(data.origin[axis], -stage.exponent) : 0);
}

/* ---- Surfaces ---- */

const isDrawn = (body) => typeof body[1] === "number";

/* The solid of shape `index`, about its own centre: {centre, corners, faces, edges}, the last two for
 * three.js. */
function surfaceOf(index) {
    let found = stage.solids.get(index);
    if (found)
        return found;
    const solid = solidOf(data.shapes[index], stage.exponent), { corners } = solid;
    const ends = [Math.min, Math.max].map((end) => [0, 1, 2].map((axis) => corners.reduce((most, p) => end(most, p[axis]), corners[0]?.[axis] ?? 0)));
    const centre = plus(ends[0], plus(ends[1], ends[0], -1), 0.5);
    const numbers = (lists) => {
        const out = new Float32Array(9 * lists.length);
        let used = 0;
        for (const list of lists)
            for (const k of list)
                for (let axis = 0; axis < 3; axis++)
                    out[used++] = corners[k][axis] - centre[axis];
        return new THREE.BufferAttribute(out.subarray(0, used), 3);
    };
    const faces = new THREE.BufferGeometry(), edges = new THREE.BufferGeometry();
    faces.setAttribute("position", numbers(solid.triangles));
    faces.computeVertexNormals();
    edges.setAttribute("position", numbers(solid.edges));
    found = {
        centre, faces, edges, triangles: solid.triangles, verdicts: solid.verdicts, all: corners,
        corners: corners.length > 100 ? [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [0, 1, 2].map((axis) => ends[k >> axis & 1][axis])) : corners,
    };
    stage.solids.set(index, found);
    return found;
}

function colourMesh(surface, first) {
    const colours = [first ? "#5b7fb4" : stage.colours.none, stage.colours.separated, stage.colours.touching, stage.colours.overlapping].map((text) => new THREE.Color(text));
    const values = new Float32Array(9 * surface.verdicts.length);
    surface.verdicts.forEach((verdict, i) => {
        for (let k = 0; k < 3; k++)
            colours[verdict].toArray(values, 9 * i + 3 * k);
    });
    surface.faces.setAttribute("color", new THREE.BufferAttribute(values, 3));
}

/* ---- Objects ---- */

function lines(colour, on = {}) {
    const object = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: colour, ...on }));
    object.frustumCulled = false;
    return object;
}

function setLines(object, points) {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry();
    object.geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(points.flat()), 3));
    object.visible = points.length > 0;
}

const onTop = { depthTest: false, transparent: true };
const boxes = lines(0, onTop), boxesThen = lines(0, onTop), gapLine = lines(0, onTop), picked = lines(0, onTop);
const bodies = new THREE.Group();
const gapEnds = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ size: 7, sizeAttenuation: false, ...onTop }));
gapEnds.frustumCulled = false;
world.add(bodies, boxes, boxesThen, gapLine, gapEnds, picked);
[boxes, boxesThen, gapLine, gapEnds, picked].forEach((object) => { object.renderOrder = 2; });

/* Few materials for all bodies: three.js prepares each one. */
const faceMaterials = new Map(), edgeMaterial = new THREE.LineBasicMaterial();

/* The material of faces of a colour; null: of a mesh, whose faces have colours of their own. */
function faceMaterial(colour) {
    if (!faceMaterials.has(colour))
        faceMaterials.set(colour, new THREE.MeshLambertMaterial({
            side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
            color: colour ?? 0xffffff, vertexColors: colour === null ? THREE.VertexColors : THREE.NoColors,
        }));
    return faceMaterials.get(colour);
}

/* An item draws a body: faces, edges, and in a page of one step dashed edges where it ends. */
function makeItem(key, shape, source) {
    const surface = surfaceOf(shape), mesh = Boolean(surface.verdicts);
    if (mesh)
        colourMesh(surface, source.k === 1);
    const item = {
        key, shape, surface, source, faces: new THREE.Mesh(surface.faces, faceMaterial(mesh ? null : stage.colours.none)),
        edges: new THREE.LineSegments(surface.edges, edgeMaterial),
    };
    item.faces.userData.item = item;
    item.objects = [item.faces, item.edges];
    return item;
}

function placeObject(object, item, part) {
    const { stream, k } = item.source;
    object.quaternion.copy(orientationOf(stream.step, k));
    const offset = new THREE.Vector3(...item.surface.centre).applyQuaternion(object.quaternion);
    object.position.set(...positionOf(stream.step, k, part, stage.exponent)).add(offset);
}

function addGhost(item) {
    const { stream: { step }, k } = item.source;
    if (!step.moves || ![0, 1, 2].some((axis) => numbers[step.shift + 3 * k + axis] !== 0))
        return;
    const ghost = new THREE.LineSegments(item.surface.edges, new THREE.LineDashedMaterial({
        color: stage.colours.dim, dashSize: stage.radius / 30, gapSize: stage.radius / 45,
    }));
    placeObject(ghost, item, 1);
    ghost.computeLineDistances();
    bodies.add(ghost);
}

/* ---- Extent ---- */

/* The corners of all bodies of a step, at the begin and the end of its window. */
function cornersOf(step, only = null) {
    const out = [];
    step.bodies.forEach((body, k) => {
        if (!isDrawn(body) || (only && !only.includes(k)))
            return;
        const turn = orientationOf(step, k), { corners } = surfaceOf(body[1]);
        for (const part of step.moves ? [0, 1] : [0]) {
            const at = positionOf(step, k, part, stage.exponent);
            corners.forEach((p) => out.push(plus(new THREE.Vector3(...p).applyQuaternion(turn).toArray(), at)));
        }
    });
    return out;
}

/* Sets centre and radius. */
function setExtent(corners) {
    stage.corners = corners;
    const ends = [Math.min, Math.max].map((end) => [0, 1, 2].map((axis) => corners.reduce((most, p) => end(most, p[axis]), corners[0]?.[axis] ?? 0)));
    stage.centre = plus(ends[0], plus(ends[1], ends[0], -1), 0.5);
    stage.radius = Math.sqrt(dot(plus(ends[1], stage.centre, -1), plus(ends[1], stage.centre, -1))) || 1;
}

function exponentOfStep(step) {
    return step.bodies.reduce((most, body) => isDrawn(body) ? Math.max(most, exponentOf(data.shapes[body[1]])) : most, step.at);
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
    const [x, y, z] = stage.dim === 2 ? directions.top : direction;
    camera.up.set(0, stage.dim === 2 || z === 1 ? 1 : 0, stage.dim === 2 || z === 1 ? 0 : 1);
    controls.target.set(...stage.centre);
    camera.position.copy(controls.target).addScaledVector(new THREE.Vector3(x, y, z === 1 ? 1 : z).normalize(), 8 * stage.radius);
    if (stage.dim === 3 && z === 1) { /* the controls turn about z */
        camera.up.set(0, 0, 1);
        camera.position.y -= 1e-4 * stage.radius;
    }
    controls.update();
    camera.updateMatrixWorld();
    stage.half = [0, 1].map((axis) => {
        const across = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, axis).toArray(), middle = dot(stage.centre, across);
        return stage.corners.reduce((most, p) => Math.max(most, Math.abs(dot(p, across) - middle)), 1e-3 * stage.radius);
    });
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
    if (isMesh && pair)
        setExtent(pairTriangles(pair, 0).flat());
    else if (pair && pair[0] >= 0)
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
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height, false);
    stage.dirty = true;
}

/* ---- Drawing a moment ---- */

/* Colours and names follow the strongest verdict of each body: {verdict, now}, now: in contact at this
 * moment of the window. */
function statesOf(step, offset) {
    const states = step.bodies.map(() => ({ verdict: 0, now: false }));
    if (isMesh)
        return states;
    for (const pair of step.pairs) {
        const answer = nowOf(pair), verdict = verdictOf(answer);
        const [first, last] = Array.isArray(answer) && answer[1] !== null ? answer.slice(1, 3) : [0, Infinity];
        const isNow = verdict >= TOUCHING && first <= offset && offset <= last;
        for (const k of pair.slice(0, 2)) {
            const state = states[k];
            if (state && (isNow > state.now || (isNow === state.now && verdict > state.verdict)))
                Object.assign(state, { verdict, now: isNow });
        }
    }
    return states;
}

function colourOf(k, step, state) {
    if (one("colour").value === "body")
        return bodyColours[(Number(step.bodies[k][0]) || k) % bodyColours.length];
    const { none, touching, overlapping } = stage.colours;
    if (state.verdict < TOUCHING)
        return none;
    const full = state.verdict === OVERLAPPING ? overlapping : touching;
    return state.now ? full : `#${new THREE.Color(none).lerp(new THREE.Color(full), 0.3).getHexString()}`;
}

const boxEdges = cuboidOf([0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]).edges;

function boxPoints(box) {
    const dim = box.length / 2;
    const end = (side) => Array.from({ length: dim }, (_, axis) => box[side * dim + axis]);
    const ends = [0, 1].map((side) => pointOf(end(side).map((x) => x ?? 0)).map((x, axis) => axis < dim && end(side)[axis] === null
        ? stage.centre[axis] + (side ? 9 : -9) * stage.radius : x));
    return boxEdges.filter(([a, b]) => dim === 3 || (a < 4 && b < 4)).flat().map((k) => [0, 1, 2].map((axis) => ends[k >> axis & 1][axis]));
}

/* The two triangles of a pair of faces, at a part of the window. */
function pairTriangles(pair, part) {
    return pair.slice(0, 2).map((face, side) => {
        const { surface, source: { stream, k } } = stage.items[Math.min(side, stage.items.length - 1)];
        const at = positionOf(stream.step, k, part, stage.exponent);
        return (surface.triangles[face] ?? []).map((corner) => plus(surface.all[corner], at));
    });
}

function drawAnswers() {
    const box = (raw) => answerOf(raw)?.box;
    const shown = stage.streams.flatMap(({ step }) => step.pairs).slice(0, 300);
    setLines(boxes, shown.map((pair) => box(nowOf(pair))).filter(Boolean).flatMap(boxPoints));
    setLines(boxesThen, shown.filter(isDifferent).map((pair) => box(pair[2])).filter(Boolean).flatMap(boxPoints));
    const pair = stage.row && pairNow(stage.row, stage.step);
    const [, , , ...points] = (pair && !isMesh && answerOf(nowOf(pair))?.gap) || [];
    const ends = points.length > 0 ? [points.slice(0, points.length / 2), points.slice(points.length / 2)].map(pointOf) : [];
    setLines(gapLine, ends);
    setLines(gapEnds, ends);
    setLines(picked, isMesh && pair ? pairTriangles(pair, stage.streams[0].part).flatMap(([a, b, c]) => [a, b, b, c, c, a]) : []);
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
    for (const item of stage.items) {
        const { stream, k } = item.source;
        item.state = stream.states[k];
        item.objects.forEach((object) => placeObject(object, item, stream.part));
        if (!item.surface.verdicts)
            item.faces.material = faceMaterial(colourOf(k, stream.step, item.state));
    }
    drawAnswers();
    stage.dirty = true;
}

function beginStep(i) {
    const step = steps[i], exponent = exponentOfStep(step), old = new Map(stage.items.map((item) => [item.key, item]));
    const fresh = stage.step < 0 || dimOf(step) !== stage.dim || Math.abs(exponent - stage.exponent) > 6;
    stage.step = i;
    if (fresh) {
        stage.exponent = exponent;
        stage.dim = dimOf(step);
        stage.solids.clear();
        old.clear();
    }
    /* what is of another size by far is not drawn beside it */
    stage.streams = streamsOf(i).filter((j) => Math.abs(exponentOfStep(steps[j]) - exponent) <= 16).map((j) => ({ i: j, step: steps[j] }));
    const sources = new Map();
    for (const stream of stage.streams)
        stream.step.bodies.forEach((body, k) => {
            const key = isMesh ? String(k) : bodyKey(stream.step, k);
            if (isDrawn(body) && data.shapes[body[1]].dim === stage.dim && !sources.has(key))
                sources.set(key, { stream, k });
        });
    stage.items = [...sources].map(([key, source]) => {
        const shape = source.stream.step.bodies[source.k][1], item = old.get(key);
        return item?.shape === shape ? Object.assign(item, { source }) : makeItem(key, shape, source);
    });
    const objects = new Set(stage.items.flatMap((item) => item.objects));
    bodies.children.filter((child) => !objects.has(child)).forEach((child) => bodies.remove(child));
    objects.forEach((object) => object.parent || bodies.add(object));
    if (fresh)
        fit(null, directions.iso);
    if (steps.length === 1)
        stage.items.forEach(addGhost);
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
        const at = item.faces.position.clone().project(camera);
        const x = Math.round((at.x + 1) / 2 * width - w / 2), y = Math.round((1 - at.y) / 2 * height - h / 2);
        const isFree = one("names").checked && x >= 0 && y >= 0 && x + w <= width && y + h <= height
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
    const [hit] = ray.intersectObjects(stage.items.map((item) => item.faces));
    one("pointed").hidden = !hit;
    if (!hit)
        return;
    const { surface, state, source: { stream, k } } = hit.object.userData.item;
    const verdict = isMesh ? surface.verdicts[hit.faceIndex] : state.verdict;
    one("pointed").textContent = `${isMesh ? `${k ? "B" : "A"} ${hit.faceIndex}` : bodyName(stream.step, k)}${verdict ? `: ${verdictNames[verdict]}` : ""}`;
}

/* ---- Colours, and the loop ---- */

function readColours() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["separated", "touching", "overlapping", "none", "edge", "dim", "box", "diff", "gap", "ink", "rule"])
        stage.colours[name] = style.getPropertyValue(`--${name}`).trim();
    boxes.material.color.set(stage.colours.box);
    boxesThen.material.color.set(stage.colours.diff);
    for (const object of [gapLine, gapEnds])
        object.material.color.set(stage.colours.gap);
    picked.material.color.set(stage.colours.box);
    edgeMaterial.color.set(stage.colours.edge);
    stage.items.filter((item) => item.surface.verdicts).forEach((item) => colourMesh(item.surface, item.source.k === 1));
}

/* Draws if something has changed. */
function drawScene() {
    if (!renderer || !stage.dirty)
        return;
    stage.dirty = false;
    renderer.render(world, camera);
    drawLabels();
}

if (renderer) {
    controls.enableKeys = false;
    controls.screenSpacePanning = true;
    controls.addEventListener("change", () => { stage.dirty = true; });
    new ResizeObserver(resize).observe(one("stage"));
    one("scene").addEventListener("pointermove", drawPointed);
    one("scene").addEventListener("pointerleave", () => { one("pointed").hidden = true; });
}
