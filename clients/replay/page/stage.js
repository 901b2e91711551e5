/* The scene of the chosen query, drawn on a canvas: frames at a moment of the window in the colours
 * of their verdicts, dashed where they are at its end, arrows on the way, the boxes of the contacts.
 * 2D as it lies in the plane, 3D turned as the mouse turns it. */

/* Lit and dark, for each verdict; frames of no pair are grey. */
const COLOURS = {
    [-1]: [[214, 219, 226], [122, 130, 141]], 0: [[214, 219, 226], [122, 130, 141]],
    1: [[173, 203, 236], [58, 106, 160]], 2: [[255, 216, 130], [184, 124, 12]],
    3: [[255, 168, 158], [190, 48, 44]],
};

const LABELS_MAX = 80;  /* more bodies cannot be labelled: their ids show when pointed at */
const BOXES_MAX = 2000;
const RING_BELOW = 7;   /* pixels: a smaller box gets a ring, to be found */
const ARROW_MIN = 5;
const FIT = 0.88;       /* part of the canvas that is filled */

const stage = {
    width: 600, height: 400,
    azimuth: OBLIQUE.azimuth, elevation: OBLIQUE.elevation,
    event: null, frames: [], units: null, bounds: null, pairs: [],
    moment: 0,              /* of the window, 0 to 1 */
    camera: null,           /* {target, zoom, pan}; one for each group of bodies */
    facets: [], pointed: -1,
    theme: {},
};

/* Queries of the same bodies are taken for steps of time, and seen from the same point. */
const cameras = new Map();

function readTheme() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["card", "ink", "dim", "grid", "box", "diff", "rule"])
        stage.theme[name] = style.getPropertyValue(`--${name}`).trim();
    stage.theme.dark = matchMedia("(prefers-color-scheme: dark)").matches;
}

/* ---- Taking an event in ---- */

/* What can be drawn in one picture: of one dimension. */
function drawableFrames(event) {
    const frames = framesOf(event), first = frames.find((frame) => frame.shape);
    for (const frame of frames) {
        if (frame.shape && frame.shape.dim !== first.shape.dim) {
            frame.why = `it is of ${frame.shape.dim}D, and others are not`;
            frame.shape = null;
        }
    }
    return frames;
}

function worstOfFrames(event, pairs) {
    const worst = event.frames.map(() => NO_VERDICT);
    for (const pair of pairs)
        for (const index of [pair.a, pair.b])
            worst[index] = Math.max(worst[index] ?? NO_VERDICT, verdictOf(pair.now ?? pair.then));
    const answer = answerOf(event);
    const isWhole = answer && event.kind >= KIND_ALL && event.first === 0 && answer.end >= event.total && !event.more;
    const others = isWhole ? SEPARATED : NO_VERDICT;
    return worst.map((verdict) => Math.max(verdict, others));
}

function groupOf(event, drawable) {
    return `${drawable[0].shape.dim}:${event.frames.map((frame) => frame[0]).join(" ")}`;
}

/* What was seen so far is good for this event too, if it lies within and is not lost in it. */
function fits(camera, bounds) {
    const all = camera.bounds, step = extent(all) * 0.02;
    return extent(bounds) > extent(all) / 8
        && [0, 1, 2].every((axis) => bounds.low[axis] >= all.low[axis] - step
            && bounds.high[axis] <= all.high[axis] + step);
}

function setScene(event) {
    stage.event = event;
    stage.pairs = pairsOf(event);
    stage.frames = drawableFrames(event);
    stage.worst = worstOfFrames(event, stage.pairs);
    stage.drawable = stage.frames.filter((frame) => frame.shape);
    stage.moment = 0;
    stage.pointed = -1;
    stage.camera = null;
    measureStage();
    if (stage.drawable.length > 0)
        setCamera(event);
    drawBands();
    redrawStage();
}

/* The camera of the group, with the event's frames added to what it sees where that is enough. */
function setCamera(event) {
    const group = groupOf(event, stage.drawable), old = cameras.get(group);
    if (old) {
        const bounds = boundsOf(old.units, stage.drawable, event.T);
        stage.bounds = bounds;
        if (fits(old, bounds)) {
            stage.units = old.units;
            stage.camera = old;
            return;
        }
    }
    const { dim } = stage.drawable[0].shape;
    stage.units = makeUnits(dim, stage.drawable, event.T);
    stage.bounds = boundsOf(stage.units, stage.drawable, event.T);
    stage.camera = { units: stage.units, bounds: widened(event, stage.units, stage.bounds) };
    cameras.set(group, stage.camera);
    fit(stage.camera.bounds);
}

/* Bounds that hold the next queries of the same bodies too, as far as these are of the same size. */
const AHEAD = 300;

function widened(event, units, bounds) {
    const group = groupOf(event, stage.drawable), size = extent(bounds);
    let all = bounds;
    for (const other of events.slice(Math.max(event.at - AHEAD, 0), event.at + AHEAD)) {
        if (other === event || other.frames.length !== event.frames.length || stage.drawable.length > 200)
            continue;
        const frames = drawableFrames(other).filter((frame) => frame.shape);
        if (frames.length === 0 || groupOf(other, frames) !== group)
            continue;
        const joined = boundsOfPoints([...all.points, ...boundsOf(units, frames, other.T).points]);
        if (extent(joined) < 4 * size)
            all = joined;
    }
    return all;
}

/* ---- The camera ---- */

function projection() {
    const rotate = turn(stage.units.dim, stage.azimuth, stage.elevation);
    const { target, zoom, pan } = stage.camera;
    return (p) => {
        const [right, up, depth] = rotate(minus(p, target));
        return [stage.width / 2 + pan[0] + zoom * right, stage.height / 2 + pan[1] - zoom * up, depth];
    };
}

/* Room for the numbers of the axes in 2D. */
function inner() {
    return stage.units.dim === 2 ? { left: 56, bottom: 24 } : { left: 0, bottom: 0 };
}

/* Turns nothing; sees the bounds. */
function fit(bounds) {
    const { camera } = stage, rotate = turn(stage.units.dim, stage.azimuth, stage.elevation);
    camera.target = bounds.low.map((low, axis) => (low + bounds.high[axis]) / 2);
    const points = bounds.points.map((point) => rotate(minus(point, camera.target)));
    const ends = [0, 1].map((axis) => points.map((point) => point[axis]))
        .map((along) => [Math.min(...along), Math.max(...along)]);
    const { left, bottom } = inner(), room = [stage.width - left, stage.height - bottom];
    const wanted = ends.map(([low, high], axis) => room[axis] / Math.max(high - low, 1e-300));
    /* A point is seen at some size. */
    camera.zoom = extent(bounds) > 0 ? Math.min(FIT * wanted[0], FIT * wanted[1], 1e13) : 200;
    camera.fitted = camera.zoom;
    const [right, up] = ends.map(([low, high]) => (low + high) / 2 * camera.zoom);
    camera.pan = [left / 2 - right, up - bottom / 2];
}

function zoomStage(factor, x, y) {
    const { camera } = stage;
    const zoom = clamp(camera.zoom * factor, camera.fitted / 50, camera.fitted * 1e9);
    const by = zoom / camera.zoom, from = [x - stage.width / 2, y - stage.height / 2];
    camera.pan = camera.pan.map((pan, axis) => from[axis] + (pan - from[axis]) * by);
    camera.zoom = zoom;
    redrawStage();
}

function fitAll() {
    if (!stage.camera)
        return;
    stage.camera.bounds = stage.bounds;
    fit(stage.bounds);
    redrawStage();
}

/* The frames of the chosen pair, at the moment that is shown; and its boxes. */
function fitPair() {
    const pair = chosenPair();
    if (!stage.camera || !pair)
        return;
    const frames = [pair.a, pair.b].map((index) => stage.frames[index]).filter((frame) => frame?.shape);
    if (frames.length === 0)
        return;
    fit(boundsOf(stage.units, frames, stage.event.T));
    redrawStage();
}

/* ---- Drawing: tools ---- */

function colourOf(verdict, light, alpha) {
    const [lit, dark] = COLOURS[verdict];
    const mixed = lit.map((value, i) => Math.round(light * value + (1 - light) * dark[i]));
    return `rgba(${mixed.join(",")},${alpha})`;
}

function strokeOf(verdict, alpha) {
    return colourOf(verdict, stage.theme.dark ? 0.65 : 0, alpha);
}

function tracePolygon(context, points) {
    const kept = clipPolygon(points, stage.width, stage.height);
    context.beginPath();
    kept.forEach(([x, y], i) => i ? context.lineTo(x, y) : context.moveTo(x, y));
    context.closePath();
    return kept.length > 0;
}

function drawLine(context, a, b) {
    tracePolygon(context, [a, b]);
    context.stroke();
}

/* Each edge once, though two faces share it: the dashes of both would make a line. */
function drawEdges(context, points, faces) {
    const drawn = new Set();
    context.beginPath();
    for (const face of faces) {
        face.forEach((corner, i) => {
            const next = face[(i + 1) % face.length], name = Math.min(corner, next) * 8 + Math.max(corner, next);
            const kept = drawn.has(name) ? [] : clipPolygon([points[corner], points[next]], stage.width, stage.height);
            drawn.add(name);
            kept.forEach(([x, y], k) => k ? context.lineTo(x, y) : context.moveTo(x, y));
        });
    }
    context.stroke();
}

function drawText(context, text, x, y, colour, align) {
    context.textAlign = align;
    context.fillStyle = colour;
    context.fillText(text, x, y);
}

/* ---- Grid and axes ---- */

/* Can lines be told apart in doubles, and be written as numbers? */
function gridStep(range) {
    const size = unscaled(stage.units, range);
    return Number.isFinite(size) && size > 1e-300 ? niceStep(size) : 0;
}

/* Multiples of the step between two unit coordinates: {place, text}. Far from the origin, where
 * the digits would all be the same, they are counted from the first frame's. */
function gridLines(axis, low, high, step) {
    const origin = stage.units.origin[axis], far = Math.abs(origin) > 1e6 * step;
    const from = far ? 0 : origin, unit = scaled(stage.units, step), lines = [];
    const first = Math.ceil((from + unscaled(stage.units, low)) / step - 1e-9);
    for (let k = first; k < first + 60; k++) {
        const place = far ? k * unit : placed(stage.units, k * step, axis);
        if (!(place <= high + unit * 1e-9))
            break;
        const text = tickText(k * step, step);
        lines.push({ place, text: far && k >= 0 ? `+${text}` : text });
    }
    return lines;
}

function drawGrid2D(context, project) {
    const { camera, theme, width, height } = stage, { left, bottom } = inner();
    const step = gridStep(90 / camera.zoom);
    if (step === 0)
        return;
    const zero = project([0, 0, 0]);
    context.font = "11px system-ui, sans-serif";
    context.strokeStyle = theme.grid;
    context.lineWidth = 1;
    for (const { place, text } of gridLines(0, (left - zero[0]) / camera.zoom, (width - zero[0]) / camera.zoom, step)) {
        const x = Math.round(zero[0] + place * camera.zoom) + 0.5;
        drawLine(context, [x, 0], [x, height - bottom]);
        drawText(context, text, x, height - 8, theme.dim, "center");
    }
    for (const { place, text } of gridLines(1, (zero[1] - height + bottom) / camera.zoom, zero[1] / camera.zoom, step)) {
        const y = Math.round(zero[1] - place * camera.zoom) + 0.5;
        drawLine(context, [left, y], [width, y]);
        drawText(context, text, left - 6, y + 4, theme.dim, "right");
    }
    drawAxes2D(context, step);
}

function drawAxes2D(context, step) {
    const { units, theme, width, height } = stage, { left, bottom } = inner();
    context.strokeStyle = theme.rule;
    drawLine(context, [left + 0.5, 0], [left + 0.5, height - bottom]);
    drawLine(context, [left, height - bottom - 0.5], [width, height - bottom - 0.5]);
    const names = ["x", "y"].map((name, axis) => Math.abs(units.origin[axis]) > 1e6 * step
        ? `${name} from ${digits(units.origin[axis], 17)}` : name);
    context.font = "600 11px system-ui, sans-serif";
    drawText(context, names[0], width - 8, height - bottom - 6, theme.dim, "right");
    drawText(context, names[1], left + 6, 14, theme.dim, "left");
}

/* The floor below all. */
function drawGrid3D(context, project) {
    const { low, high } = stage.camera.bounds, { theme } = stage;
    const size = Math.max(high[0] - low[0], high[1] - low[1]), step = gridStep(Math.max(size, 1e-9) / 5);
    if (step === 0 || size === 0)
        return;
    const unit = scaled(stage.units, step);
    const ends = [0, 1].map((axis) => [low[axis] - unit / 2, high[axis] + unit / 2]);
    context.strokeStyle = theme.grid;
    context.lineWidth = 1;
    for (const axis of [0, 1]) {
        const other = ends[1 - axis];
        for (const { place } of gridLines(axis, ends[axis][0], ends[axis][1], step)) {
            const points = other.map((end) => axis === 0 ? [place, end, low[2]] : [end, place, low[2]]);
            drawLine(context, project(points[0]), project(points[1]));
        }
    }
    context.font = "11px system-ui, sans-serif";
    drawText(context, `grid ${short(step)}`, stage.width - 10, stage.height - 10, theme.dim, "right");
}

/* The directions of the axes, in the lower left corner. */
function drawTriad(context) {
    const rotate = turn(3, stage.azimuth, stage.elevation), at = [40, stage.height - 38];
    context.strokeStyle = stage.theme.dim;
    context.lineWidth = 1.4;
    context.font = "11px system-ui, sans-serif";
    ["x", "y", "z"].forEach((name, axis) => {
        const [right, up] = rotate([0, 1, 2].map((i) => i === axis ? 24 : 0));
        drawLine(context, at, [at[0] + right, at[1] - up]);
        drawText(context, name, at[0] + 1.35 * right, at[1] - 1.35 * up + 4, stage.theme.dim, "center");
    });
}

/* ---- Frames ---- */

/* Frames that do not belong to the chosen pair step back. */
function isBack(index) {
    const pair = chosenPair();
    return pair && index !== pair.a && index !== pair.b;
}

/* A face of a solid is turned to the viewer where its normal, pointed away from the middle of the
 * body, is. */
function isFront(points, middle, solid) {
    if (!solid)
        return true;
    const normal = cross(minus(points[1], points[0]), minus(points[2], points[0]));
    const out = dot(normal, minus(middleOf(points), middle));
    return out >= 0 ? normal[2] >= 0 : normal[2] <= 0;
}

/* Right, up, depth, for the sake of isFront: y grows downwards on the canvas. */
function upright(point) {
    return [point[0], -point[1], point[2] * stage.camera.zoom];
}

/* Faces, and how near they are. */
function facetsOf(project, frame, outline) {
    const points = outline.corners.map(project), middle = upright(project(outline.middle));
    const solid = outline.faces.length > 1;
    return outline.faces.map((face) => {
        const corners = face.map((k) => points[k]), world = face.map((k) => outline.corners[k]);
        return {
            index: frame.index, face, points: corners, flat: stage.units.dim === 2,
            depth: corners.reduce((sum, p) => sum + p[2], 0) / corners.length,
            light: stage.units.dim === 2 ? 0.8 : lightOf(world[0], world[1], world[2]),
            front: isFront(corners.map(upright), middle, solid),
        };
    });
}

/* How far back, 0 to 1, on the way through all that is drawn. */
function depthCue(facets) {
    let near = -Infinity, far = Infinity;
    for (const { depth } of facets) {
        near = Math.max(near, depth);
        far = Math.min(far, depth);
    }
    return (depth) => near > far ? (near - depth) / (near - far) : 0;
}

function drawFacet(context, facet, behind) {
    const verdict = stage.worst[facet.index], back = isBack(facet.index);
    const pointed = facet.index === stage.pointed;
    const strength = (back ? 0.45 : 1) * (1 - 0.45 * behind);
    if (!tracePolygon(context, facet.points))
        return;
    if (!facet.front) {
        context.lineWidth = 0.7;
        context.strokeStyle = strokeOf(verdict, 0.45 * strength);
        context.stroke();
        return;
    }
    context.fillStyle = colourOf(verdict, facet.light, (facet.flat ? 0.5 : 0.66) * (back ? 0.4 : 1 - 0.3 * behind));
    context.fill();
    context.lineWidth = pointed ? 2.4 : facet.flat ? 1.5 : 1.2;
    context.strokeStyle = strokeOf(verdict, pointed ? 1 : strength);
    context.stroke();
}

function drawFrames(context, project, time) {
    stage.outlines = stage.drawable.map((frame) => outlineOf(stage.units, frame, time));
    const facets = stage.drawable.flatMap((frame, i) => facetsOf(project, frame, stage.outlines[i]));
    facets.sort((a, b) => a.depth - b.depth);
    const cue = depthCue(facets);
    facets.forEach((facet) => drawFacet(context, facet, cue(facet.depth)));
    stage.facets = facets.filter((facet) => facet.front);
}

/* ---- Motion ---- */

function moves(frame) {
    return frame.velocity !== null && frame.velocity.some((value) => value !== 0);
}

function drawHead(context, from, to) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const [x, y] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    tracePolygon(context, [to, [to[0] - 9 * x - 4 * y, to[1] - 9 * y + 4 * x],
        [to[0] - 9 * x + 4 * y, to[1] - 9 * y - 4 * x]]);
    context.fill();
}

/* Where the window has no length there is a direction only. */
function arrowEnd(project, frame, from, middle) {
    if (stage.event.T > 0)
        return project(outlineOf(stage.units, frame, stage.event.T).middle);
    const largest = Math.max(...frame.velocity.map(Math.abs));
    const direction = [0, 1, 2].map((axis) => middle[axis] + (frame.velocity[axis] ?? 0) / largest);
    const to = project(direction), length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    return length < 1e-9 ? to : from.map((value, i) => value + (to[i] - value) * 36 / length);
}

function drawMotion(context, project, frame, outline) {
    const verdict = stage.worst[frame.index], alpha = isBack(frame.index) ? 0.25 : 0.85;
    if (stage.event.T > 0) {
        const end = outlineOf(stage.units, frame, stage.event.T);
        context.setLineDash([4, 4]);
        context.lineWidth = 1.1;
        context.strokeStyle = strokeOf(verdict, alpha);
        drawEdges(context, end.corners.map(project), facetsOf(project, frame, end)
            .filter((facet) => facet.front).map((facet) => facet.face));
        context.setLineDash([]);
    }
    const from = project(outline.middle), to = arrowEnd(project, frame, from, outline.middle);
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!(length >= ARROW_MIN))
        return;
    context.globalAlpha = isBack(frame.index) ? 0.25 : 1;
    context.strokeStyle = context.fillStyle = stage.theme.ink;
    context.lineWidth = 1.6;
    drawLine(context, from, to);
    drawHead(context, from, to);
    context.globalAlpha = 1;
}

/* ---- Boxes ---- */

function drawRing(context, points) {
    const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
    const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
    if (Math.max(high[0] - low[0], high[1] - low[1]) >= RING_BELOW)
        return;
    context.beginPath();
    context.arc((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, RING_BELOW, 0, 2 * Math.PI);
    context.stroke();
}

/* Many boxes are drawn lightly. */
const CROWD = 150;

function drawBox(context, project, box, then) {
    const outline = outlineOfBox(stage.units, box), points = outline.corners.map(project);
    context.strokeStyle = then ? stage.theme.diff : stage.theme.box;
    context.fillStyle = stage.theme.box;
    context.lineWidth = then ? 2 : stage.pairs.length > CROWD ? 0.8 : 1.7;
    context.setLineDash(then ? [7, 4] : []);
    const alpha = context.globalAlpha;
    context.globalAlpha = alpha * (stage.units.dim === 3 ? 0.09 : 0.18);
    for (const face of then ? [] : outline.faces)
        if (tracePolygon(context, face.map((k) => points[k])))
            context.fill();
    context.globalAlpha = alpha;
    drawEdges(context, points, outline.faces);
    if (stage.pairs.length <= CROWD || context.globalAlpha === 1)
        drawRing(context, points);
    context.setLineDash([]);
}

/* As it is now; as it was then where it differs, or where there is none now. */
function boxesOf(pair) {
    const then = boxOf(pair.then), now = boxOf(pair.now);
    const differs = pair.differs && then && JSON.stringify(then) !== JSON.stringify(now);
    return { now: now ?? (pair.differs ? null : then), then: differs ? then : null };
}

function drawBoxes(context, project) {
    let count = 0;
    for (const pair of stage.pairs) {
        const boxes = boxesOf(pair), chosenOne = chosenPair();
        const isDrawn = (box) => box && box[0].length === stage.units.dim && count++ < BOXES_MAX;
        context.globalAlpha = chosenOne && chosenOne.index !== pair.index ? 0.2
            : chosenOne || stage.pairs.length <= CROWD ? 1 : 0.45;
        if (isDrawn(boxes.now))
            drawBox(context, project, boxes.now, false);
        if (isDrawn(boxes.then))
            drawBox(context, project, boxes.then, true);
    }
    context.globalAlpha = 1;
}

/* ---- Labels ---- */

const LABEL_PLACES = [[0, 0], [0, -14], [0, 14], [16, 0], [-16, 0], [16, -14], [-16, 14], [16, 14],
    [-16, -14], [0, -28], [0, 28]];

function collides(a, b) {
    return Math.abs(a.x - b.x) < a.half + b.half + 2 && Math.abs(a.y - b.y) < 13;
}

/* The first place near the wanted one where no label stands yet; else the wanted one. */
function placeLabel(wanted, labels) {
    for (const [x, y] of LABEL_PLACES) {
        const label = { ...wanted, x: wanted.x + x, y: wanted.y + y };
        if (!labels.some((other) => collides(label, other)))
            return label;
    }
    return wanted;
}

function isLabelled(frame) {
    const pair = chosenPair();
    if (frame.index === stage.pointed)
        return true;
    if (pair && (stage.drawable.length > 12 || stage.drawable.length > LABELS_MAX))
        return frame.index === pair.a || frame.index === pair.b;
    return stage.drawable.length <= LABELS_MAX;
}

function drawLabels(context, project) {
    const labels = [];
    context.font = "700 12px system-ui, sans-serif";
    context.lineJoin = "round";
    stage.drawable.forEach((frame, i) => {
        if (!isLabelled(frame))
            return;
        const [x, y] = project(stage.outlines[i].middle), text = bodyName(frame.id);
        const half = context.measureText(text).width / 2;
        labels.push(placeLabel({ x, y, half, text, index: frame.index }, labels));
    });
    for (const { x, y, text, index } of labels) {
        context.globalAlpha = isBack(index) && index !== stage.pointed ? 0.4 : 1;
        context.textAlign = "center";
        context.strokeStyle = stage.theme.card;
        context.lineWidth = 3.5;
        context.strokeText(text, x, y + 4);
        drawText(context, text, x, y + 4, stage.theme.ink, "center");
    }
    context.globalAlpha = 1;
}

/* ---- The picture ---- */

function measureStage() {
    const canvas = find("stage");
    stage.width = canvas.clientWidth || 600;
    stage.height = canvas.clientHeight || 400;
}

/* The canvas as large as it is on the screen, in its pixels, and empty. */
function clearStage() {
    const canvas = find("stage"), ratio = window.devicePixelRatio || 1;
    measureStage();
    const wanted = [Math.round(stage.width * ratio), Math.round(stage.height * ratio)];
    if (canvas.width !== wanted[0] || canvas.height !== wanted[1])
        [canvas.width, canvas.height] = wanted;
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, stage.width, stage.height);
    return context;
}

function drawStage() {
    const context = clearStage();
    stage.facets = [];
    if (!stage.camera)
        return;
    const project = projection(), time = stage.moment * stage.event.T;
    if (stage.units.dim === 2) {
        drawGrid2D(context, project);
    } else {
        drawGrid3D(context, project);
        drawTriad(context);
    }
    context.save();
    if (stage.units.dim === 2) {
        context.beginPath();
        context.rect(inner().left, 0, stage.width, stage.height - inner().bottom);
        context.clip();
    }
    context.lineJoin = "round";
    drawFrames(context, project, time);
    drawBoxes(context, project);
    stage.drawable.forEach((frame, i) => {
        if (moves(frame))
            drawMotion(context, project, frame, stage.outlines[i]);
    });
    drawLabels(context, project);
    context.restore();
}

const redrawStage = onceAFrame(drawStage);
