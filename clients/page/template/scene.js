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

/* The orientation of body k after a part of the window, as fmb_pose_at() computes it: by linear interpolation
 * from the quaternion at the start to the quaternion at the end, or to its negative if that is nearer.
 * Quaternions of scenes may have any length. */
function orientationOf(step, k, part) {
    const { orientation = [1, 0, 0, 0], end } = step.poses[k], ends = [orientation, end?.orientation ?? orientation];
    const largest = Math.max(...ends.flat().map(Math.abs));
    const [from, to] = ends.map((q) => q.map((x) => x / largest)), sign = from.reduce((dot, x, i) => dot + x * to[i], 0) < 0 ? -1 : 1;
    const given = from.map((x, i) => (1 - part) * x + part * sign * to[i]), [w, x, y, z] = given.length === 2 ? [given[0], 0, 0, given[1]] : given;
    return new THREE.Quaternion(x, y, z, w).normalize();
}

/* How far a body moves over the window; one that leaves the range of the doubles stops at its end. */
const shiftOf = (step, k) => [0, 1, 2].map((axis) => {
    const { position, velocity, end } = step.poses[k], shift = end ? end.position[axis] - position[axis] : step.T * (velocity?.[axis] ?? 0);
    return Math.max(-(2 ** 1023), Math.min(shift || 0, 2 ** 1023));
});

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
const faces = new THREE.Mesh(new THREE.BufferGeometry(), [true, false].map((flatShading) => new THREE.MeshPhongMaterial({
    side: THREE.DoubleSide, flatShading, specular: 0, vertexColors: THREE.VertexColors,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
})));
const edges = new THREE.LineSegments(), ends = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineDashedMaterial());
const bodies = new THREE.Group().add(faces, edges, ends);
edges.userData.colour = "edge";
ends.userData.colour = "dim";
bodies.children.forEach((object) => { object.frustumCulled = false; });
world.add(bodies);

const isDrawn = (body) => typeof body[1] === "number";

/* The solid of shape `index`, its centre, corners of its extent, its size, and further positions for its name. */
function surfaceOf(index) {
    if (!stage.solids.has(index)) {
        const solid = solidOf(data.shapes[index], stage.exponent), { corners } = solid, box = new THREE.Box3().setFromPoints(corners);
        const size = box.getSize(new THREE.Vector3()), extent = corners.length <= 100 ? corners : boxOf(box.min, size).corners;
        const middles = solid.starts.slice(0, 8).map((start, k, { [k + 1]: end }) =>
            corners.slice(start, end).reduce((mean, corner, _, all) => sum(mean, corner, 1 / all.length), new THREE.Vector3()));
        const places = [...middles, ...extent.slice(0, 8).map((corner) => corner.clone().lerp(middles[0], 0.4))];
        stage.solids.set(index, { ...solid, centre: box.getCenter(new THREE.Vector3()), extent, size: size.length(), places });
    }
    return stage.solids.get(index);
}

/* Points of body k of a step after a part of the window. */
function placed(points, step, k, part) {
    const turn = orientationOf(step, k, part), at = positionOf(step, k, part);
    return points.map((point) => point.clone().applyQuaternion(turn).add(at));
}

/* Makes the objects for the corners of all items. */
function buildBodies() {
    let count = 0;
    for (const item of stage.items) {
        item.first = count;
        count += item.surface.corners.length;
    }
    const [position, color, normal] = [0, 1, 2].map(() => new THREE.BufferAttribute(new Float32Array(3 * count), 3));
    const indices = (list, accepts) => stage.items.flatMap(({ surface, first }) =>
        surface[list].filter(([k]) => accepts(surface.normals[k])).flat().map((k) => first + k));
    const flat = indices("triangles", (round) => !round), round = indices("triangles", Boolean);
    for (const [object, index] of [[faces, flat.concat(round)], [edges, indices("edges", () => true)]]) {
        object.geometry.dispose();
        object.geometry = new THREE.BufferGeometry().setAttribute("position", position).setAttribute("color", color).setAttribute("normal", normal);
        object.geometry.setIndex(index);
    }
    faces.geometry.addGroup(0, flat.length, 0);
    faces.geometry.addGroup(flat.length, round.length, 1);
    stage.owners = new Uint32Array(count); /* [corner]: the index of its item */
    stage.items.forEach(({ first, surface }, n) => stage.owners.fill(n, first, first + surface.corners.length));
}

/* Sets corners and colours for this moment. */
function placeBodies() {
    const { position, color, normal } = faces.geometry.attributes, point = new THREE.Vector3();
    for (const item of stage.items) {
        const { surface: { corners, normals, starts, centre }, source: { stream: { step, part }, k }, first } = item;
        const turn = orientationOf(step, k, part), at = positionOf(step, k, part).sub(stage.centre);
        [item.centre] = placed([centre], step, k, part);
        corners.forEach((corner, i) => {
            point.copy(corner).applyQuaternion(turn).add(at).toArray(position.array, 3 * (first + i));
        });
        normals.forEach((each, i) => point.copy(each).applyQuaternion(turn).toArray(normal.array, 3 * (first + i)));
        const { whole, frames } = item.state, usual = colourOf(item, whole);
        starts.forEach((start, frame) => {
            const state = stronger(frames[frame], whole), colour = state === whole ? usual : colourOf(item, state);
            for (let i = start; i < (starts[frame + 1] ?? corners.length); i++)
                colour.toArray(color.array, 3 * (first + i));
        });
    }
    position.needsUpdate = color.needsUpdate = normal.needsUpdate = true;
    faces.geometry.boundingSphere = null;
    bodies.position.copy(stage.centre);
}

/* In a page of one step, dashed edges where moving bodies end. */
function drawEnds() {
    const { step } = stage.streams[0];
    const moving = stage.items.filter(({ source: { k } }) => step.moves && doesMove(step.poses[k]));
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

/* The corners of all bodies of a step, at the start, the middle and the end of its window. */
function cornersOf(step, only = null, huge = Infinity) {
    const out = [];
    step.bodies.forEach((body, k) => {
        if (!isDrawn(body) || (only && !only.includes(k)) || surfaceOf(body[1]).size >= huge)
            return;
        for (const part of step.moves ? [0, 0.5, 1] : [0])
            out.push(...placed(surfaceOf(body[1]).extent, step, k, part));
    });
    return out;
}

/* The size of the smallest body of a step that is more than ten times larger than all smaller bodies together, if
 * these have at least half of the frames; Infinity: there is none. */
function hugeSizeOf(step) {
    const box = new THREE.Box3(), sized = step.bodies.flatMap((body, k) => isDrawn(body) ? { k, ...surfaceOf(body[1]) } : []).sort((a, b) => a.size - b.size);
    let frames = -sized.reduce((count, { starts }) => count + starts.length, 0) / 2;
    return sized.find(({ k, size, starts }) => {
        const extent = frames < 0 ? 0 : box.getSize(new THREE.Vector3()).length(), isHuge = extent > 0 && size > 10 * extent;
        frames += starts.length;
        cornersOf(step, [k]).forEach((corner) => box.expandByPoint(corner));
        return isHuge;
    })?.size ?? Infinity;
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
    const pair = row && pairAt(row, stage.step), huge = hugeSizeOf(steps[stage.step]);
    const to = direction ?? camera.position.clone().sub(controls.target).toArray();
    if (pair && pair[0] >= 0)
        setExtent(cornersOf(steps[stage.step], pair.slice(0, 2)));
    else
        setExtent(likeSteps(stage.step).flatMap((step) => cornersOf(step, null, huge)));
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

/* A verdict, and whether the contact is at this moment of the window, up to rounding. */
function stateOf(verdict, [first, last], offset) {
    const small = 1e-9 * wholeSpan;
    return { verdict, now: verdict >= TOUCHING && first - small <= offset && offset <= last + small };
}

/* The stronger of two states; one of them may be undefined. */
const stronger = (a, b) => (a && (!b || a.now > b.now || (a.now === b.now && a.verdict > b.verdict)) ? a : b);

/* Names show the strongest state of each body. Colours show the strongest state of the pairs whose frames in contact
 * are not known (whole), and the state of each frame in contact (frames). */
function statesOf(step, offset) {
    const none = { verdict: 0, now: false }, states = step.bodies.map(() => ({ ...none, whole: none, frames: [] }));
    for (const pair of step.pairs) {
        const answer = nowOf(pair), state = stateOf(verdictOf(answer), answer.contact ?? [0, Infinity], offset);
        pair.slice(0, 2).forEach((k, side) => {
            const body = states[k], { frames } = body;
            Object.assign(body, stronger(state, body));
            if (!answer.frames?.length)
                body.whole = stronger(state, body.whole);
            for (const [a, b, verdict, ...contact] of answer.frames ?? [])
                frames[side ? b : a] = stronger(stateOf(verdict, contact, offset), frames[side ? b : a]);
        });
    }
    return states;
}

/* The colour of frames of an item in a state. */
function colourOf({ source: { stream: { step }, k } }, state) {
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
    stage.labels.forEach((label, n) => Object.assign(label, { n, item: stage.items[n] }));
}

/* For each cell of CELL x CELL pixels: the index of the item in front, or -1, and its depth. */
const CELL = 4;
function findFront() {
    const columns = Math.ceil(stage.size.width / CELL), rows = Math.ceil(stage.size.height / CELL), { position } = faces.geometry.attributes;
    const items = new Int32Array(columns * rows).fill(-1), depths = new Float32Array(columns * rows).fill(Infinity), index = faces.geometry.index.array;
    const toCells = new THREE.Matrix4().makeScale(stage.size.width / CELL / 2, -stage.size.height / CELL / 2, 1)
        .multiply(new THREE.Matrix4().makeTranslation(1, -1, 0)).multiply(camera.projectionMatrix).multiply(camera.matrixWorldInverse);
    const { array: at } = toCells.multiply(bodies.matrixWorld).applyToBufferAttribute(position.clone());
    for (let k = 0; k < index.length; k += 3) {
        const [a, b, c] = [3 * index[k], 3 * index[k + 1], 3 * index[k + 2]], owner = stage.owners[index[k]];
        const ux = at[b] - at[a], uy = at[b + 1] - at[a + 1], vx = at[c] - at[a], vy = at[c + 1] - at[a + 1], area = ux * vy - uy * vx;
        const [left, right] = [Math.max(Math.floor(Math.min(at[a], at[b], at[c])), 0), Math.min(Math.max(at[a], at[b], at[c]), columns)];
        const [top, bottom] = [Math.max(Math.floor(Math.min(at[a + 1], at[b + 1], at[c + 1])), 0), Math.min(Math.max(at[a + 1], at[b + 1], at[c + 1]), rows)];
        for (let y = top; y < bottom && area !== 0; y++)
            for (let x = left; x < right; x++) {
                const px = x + 0.5 - at[a], py = y + 0.5 - at[a + 1], u = (px * vy - py * vx) / area, v = (ux * py - uy * px) / area;
                const depth = at[a + 2] + u * (at[b + 2] - at[a + 2]) + v * (at[c + 2] - at[a + 2]), cell = y * columns + x;
                if (u >= 0 && v >= 0 && u + v <= 1 && depth > -1 && depth < depths[cell])
                    [items[cell], depths[cell]] = [owner, depth];
            }
    }
    return { columns, items, depths };
}

/* Whether the name of item n, in this rectangle, covers nothing in front of the item. isSeen: the item also has to be
 * visible in the middle of the rectangle. */
function isInFront({ columns, items, depths }, n, { x, y, w, h }, depth, isSeen) {
    const middle = Math.floor((y + h / 2) / CELL) * columns + Math.floor((x + w / 2) / CELL), own = items[middle] === n ? depths[middle] : depth;
    if (isSeen && items[middle] !== n)
        return false;
    for (let row = Math.floor(y / CELL); row * CELL < y + h; row++)
        for (let cell = row * columns + Math.floor(x / CELL); cell * CELL < row * columns * CELL + x + w; cell++)
            if (items[cell] !== n && depths[cell] < own - 4e-5) /* a thousandth of the radius */
                return false;
    return true;
}

/* Places each name in the middle of its body, or else of a frame, or else towards a corner. Bodies in contact come
 * first. A name that would cover another name, or something in front of its body, is not shown. */
function drawLabels() {
    const { width, height } = stage.size, taken = [];
    const order = [...stage.labels ?? []].sort((a, b) => b.item.state.verdict - a.item.state.verdict);
    let front = null;
    for (const { label, item, n, width: w, height: h } of order) {
        const isWanted = one("names").checked && (pace.scale >= 1 || item.state.now), { surface, source: { stream: { step, part }, k } } = item;
        const freeAt = (point, isSeen) => {
            const at = point.clone().project(camera), x = Math.round((at.x + 1) / 2 * width - w / 2), y = Math.round((1 - at.y) / 2 * height - h / 2);
            const isFree = x >= 0 && y >= 0 && x + w <= width && y + h <= height
                && taken.every((p) => x >= p.x + p.w || p.x >= x + w || y >= p.y + p.h || p.y >= y + h);
            return isFree && isInFront(front ??= findFront(), n, { x, y, w, h }, at.z, isSeen) && { x, y, w, h };
        };
        const points = isWanted ? [item.centre, ...placed(surface.places, step, k, part)] : [];
        const place = points.reduce((found, point) => found || freeAt(point, true), null) || (isWanted && freeAt(points[1], false));
        Object.assign(label.style, place ? { visibility: "visible", transform: `translate(${place.x}px, ${place.y}px)` } : { visibility: "hidden" });
        taken.push(...place ? [place] : []);
    }
}

/* ---- Axes and scale ---- */

/* Draws the directions of the axes, and a scale of a round length in the scene's unit. */
function drawAxes() {
    const perPixel = scaled((camera.right - camera.left) / camera.zoom / stage.size.width, stage.exponent), length = roundUp(40 * perPixel);
    const key = [...camera.matrixWorldInverse.elements, perPixel, stage.colours.ink].join();
    one("axes").hidden = !(perPixel > 1e-300 && perPixel < 1e300);
    const fitted = key !== stage.axes && fitCanvas(one("axes"));
    if (!fitted)
        return;
    stage.axes = key;
    const { to, height } = fitted, across = length / perPixel;
    Object.assign(to, { font: "12px system-ui, sans-serif", strokeStyle: stage.colours.ink, fillStyle: stage.colours.ink });
    for (const [axis, unit] of units.slice(0, stage.dim).entries()) {
        const { x, y } = unit.clone().transformDirection(camera.matrixWorldInverse);
        to.moveTo(45, height - 70);
        to.lineTo(45 + 30 * x, height - 70 - 30 * y);
        if (Math.hypot(x, y) > 0.2)
            to.fillText("xyz"[axis], 42 + 38 * x, height - 66 - 38 * y);
    }
    to.stroke();
    to.strokeRect(8.5, height - 8.5, across, 0);
    [0, across].forEach((x) => to.strokeRect(8.5 + x, height - 12.5, 0, 8));
    to.fillText(short(length), 12, height - 13);
    one("axes").ariaLabel = `length of the scale: ${short(length)}`;
}

/* ---- The pointer ---- */

/* The nearest point of the faces below the pointer. */
function hitAt({ clientX, clientY }) {
    const box = one("scene").getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera({ x: (clientX - box.left) / box.width * 2 - 1, y: 1 - (clientY - box.top) / box.height * 2 }, camera);
    return ray.intersectObject(faces)[0];
}

/* Names the body below the pointer. */
function drawPointed(event) {
    const hit = hitAt(event);
    one("pointed").hidden = !hit;
    if (!hit)
        return;
    const { state: { verdict }, source: { stream, k } } = stage.items[stage.owners[hit.face.a]];
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
    drawAxes();
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
